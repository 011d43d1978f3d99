"""The rover set down on soil that is not level, its pivots turned so that all wheels stand equally deep.

Soil remembers a fall: a rover that starts level above a slope would leave its mark and dig itself in.
Verified by tests/unit/test_rover_set_down.py and tests/verification/test_rover_on_soil.py.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from rover_dynamics.multibody.body import RigidBody
from rover_dynamics.multibody.compiled import quaternion_of
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.soil.field import SoilBed
from rover_dynamics.soil.lie import footprint_plane

__all__ = ["set_down"]

FloatArray = NDArray[np.float64]


def set_down(model: MultibodyModel, design: RoverDesign, soil: SoilBed) -> MultibodyModel:
    """The model with its first body leant and its pivots turned: each wheel as deep as at rest, or none deeper.

    Parameters
    ----------
    model : on level soil at z = 0, over the origin towards x, as `rover_dynamics.rover.rover.build_rover` makes it
    design, soil : what stands on what
    """
    standing = soil.standing()[0]
    hubs = np.array([leg.drive for leg in design.legs]) + np.array([0.0, 0.0, standing])

    def lacks(x: FloatArray) -> FloatArray:
        """Height each hub lacks over the ground [m]."""
        moved = _moved(model, design, x)
        at = [moved[f"wheel_{leg.name}"] @ [*hub, 1.0] for leg, hub in zip(design.legs, hubs, strict=True)]
        x_, y, z, _ = np.array(at).T
        ground, normals = footprint_plane(soil.terrain, x_, y, design.wheel_radius)
        return np.asarray(standing / normals[:, 2] - (z - ground))

    found = least_squares(lacks, np.zeros(3 + len(design.pivots)), x_scale="jac").x
    found[2] += max(float(lacks(found).max()), 0.0)
    moved = _moved(model, design, found)
    return replace(model, bodies=tuple(_placed(body, moved[body.name]) for body in model.bodies))


def _moved(model: MultibodyModel, design: RoverDesign, x: FloatArray) -> dict[str, FloatArray]:
    """Each body's motion from its start, (4, 4), by roll and pitch [rad], height [m] and the pivots' angles [rad]."""
    base = np.eye(4)
    base[:3, :3] = Rotation.from_euler("xy", x[:2]).as_matrix()
    base[2, 3] = x[2]
    angles = {pivot.name: angle for pivot, angle in zip(design.pivots, x[3:], strict=True)}
    found = {model.bodies[0].name: base}
    starts = {body.name: body for body in model.bodies}
    waiting = list(model.joints)
    while waiting:  # from the first body outwards
        joint = next(one for one in waiting if one.first in found)
        waiting.remove(joint)
        found[joint.second] = found[joint.first]
        if joint.name in angles:
            first, turn = starts[joint.first], np.eye(4)
            at = first.position + first.rotation @ joint.first_frame.position
            axis = first.rotation @ joint.first_frame.rotation[:, 2]
            turn[:3, :3] = Rotation.from_rotvec(angles[joint.name] * axis).as_matrix()
            turn[:3, 3] = at - turn[:3, :3] @ at
            found[joint.second] = found[joint.first] @ turn
    return found


def _placed(body: RigidBody, moved: FloatArray) -> RigidBody:
    return replace(
        body,
        position=moved[:3, :3] @ body.position + moved[:3, 3],
        orientation=quaternion_of(moved[:3, :3] @ body.rotation),
    )
