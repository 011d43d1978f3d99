"""What drives and efforts prescribe in the joints of a vehicle.

Verified by tests/verification/test_vehicle_step.py.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.vehicle.implicit_method import Known

__all__ = ["JointActions", "JointEffort"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class JointEffort:
    """A torque about a hinge, or a force along a slider, as a function of time.

    Attributes
    ----------
    joint : name of a joint of the tree that no drive moves
    effort : of time [s]; on the joint's second body [N m, N]
    """

    joint: str
    effort: Callable[[float], float]


class JointActions:
    """A tree's joint velocities: those that follow laws, those that are free, and the efforts on these.

    Attributes
    ----------
    coordinates : of the tree
    free, driven : (n_f,), (n_d,) int, velocities that are unknown, and those that follow laws
    driven_q : (n_d,) int, coordinates of the driven velocities

    Raises
    ------
    InputError
        If the bodies form loops; if every joint is driven; for an effort at a joint that is driven, or neither a hinge
        nor a slider.
    """

    def __init__(self, model: MultibodyModel, efforts: Sequence[JointEffort]) -> None:
        self._model = model
        self.coordinates = TreeCoordinates(model)
        if self.coordinates.spanning.cut:
            loops = ", ".join(self.coordinates.spanning.cut)
            raise InputError("joints of the vehicle", loops, "close loops", "integrate it by multibody.motion")
        tree, links = self.coordinates.tree, self.coordinates.spanning.joint_links
        at = {(named.joint, named.coordinate): named.link for named in links}
        moved = np.array([at[drive.joint, drive.coordinate] for drive in model.drives], dtype=np.int64)
        self.driven: IntArray = tree.v_at[moved]
        self.driven_q: IntArray = tree.q_at[moved]
        self.free: IntArray = np.setdiff1d(np.arange(tree.v_at[-1]), self.driven)
        if len(self.free) == 0:
            raise InputError("joints of the vehicle", len(moved), "are all driven", "leave one free to move")
        self._efforts: list[tuple[int, JointEffort]] = []
        for effort in efforts:
            places = [int(tree.v_at[link]) for (joint, _), link in at.items() if joint == effort.joint]
            if len(places) != 1 or places[0] in self.driven:
                rule = "must be a hinge or a slider that no drive moves"
                raise InputError("joint of an effort", repr(effort.joint), rule, "name another, or remove its drive")
            self._efforts.append((places[0], effort))

    def known(self, t: float) -> Known:
        """What is prescribed at a time."""
        laws = np.array([drive.law.at(t) for drive in self._model.drives]).reshape(-1, 3)
        tau = np.zeros(self.coordinates.tree.v_at[-1])
        for place, effort in self._efforts:
            tau[place] += effort.effort(t)
        q, v, a = (np.ascontiguousarray(laws[:, k]) for k in range(3))
        return Known(q, v, a, tau)

    def start(self, t: float) -> tuple[FloatArray, FloatArray]:
        """Coordinates and velocities of the model's start, corrected."""
        n_q = int(self.coordinates.tree.q_at[-1])
        y = self.coordinates.corrected(t, self.coordinates.start())
        return y[:n_q], y[n_q:]
