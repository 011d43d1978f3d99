"""The drive of a wheel's hub: a pure torque about the axle, its power the torque times the spin."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.wheel_rig import HubDrive

SPIN, TURNED = 2.5, 0.8


def test_torque_and_power_of_a_wheel_that_turns_rigidly() -> None:
    tire = build_tire(thesis_preset())
    drive = HubDrive(tire=tire, speed=4.0, gain=3.0)
    R = Rotation.from_rotvec([0.0, TURNED, 0.0]).as_matrix()
    p = tire.mesh.reference_coordinates() @ R.T
    v = np.cross([0.0, SPIN, 0.0], p)
    force = drive.force(p, v, 0.0)
    torque = 3.0 * (4.0 - SPIN)
    assert drive.torque(p, v) == pytest.approx(torque, rel=1e-12)
    np.testing.assert_allclose(force[:, 0].sum(axis=0), 0.0, atol=1e-12)
    np.testing.assert_allclose(np.cross(p, force).sum(axis=(0, 1)), [0.0, torque, 0.0], atol=1e-12)
    assert np.sum(force * v) == pytest.approx(torque * SPIN, rel=1e-12)
    assert not force[tire.tie.free].any()
