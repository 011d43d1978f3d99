"""Frames and the circumferential orientation shared by every wheel model.

Wheel (hub) frame ``_h``: origin at the hub centre, x forward, y along the axle to the left, z up; right-handed.
A circumferential position phi is measured about +y from the wheel's lowest point (-z) towards +x (the front): the point
of the tire at phi has the direction ``(sin phi, 0, -cos phi)``. "Orientation phi" means that the wheel stands on that
point: the ground plane faces it, with its normal pointing to the hub.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["ground_direction_h"]


def ground_direction_h(phi: float) -> NDArray[np.float64]:
    """Unit vector from the hub to the ground for orientation ``phi``.

    Parameters
    ----------
    phi : circumferential position that faces the ground [rad]

    Returns
    -------
    direction_h : (3,) float, ``(sin phi, 0, -cos phi)`` [-]; the plane's outward normal is its negative

    Verified by tests/unit/test_frames.py.
    """
    return np.array([np.sin(phi), 0.0, -np.cos(phi)])
