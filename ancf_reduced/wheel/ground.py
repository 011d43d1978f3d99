"""Contact of an ANCF wheel's rim and of its grousers' tips with rigid ground of any shape.

The ground is a terrain (`contracts.terrain`) in a frame of its own, whose pieces press each for themselves. It rises
along its own z axis from where it first touches the wheel. A grouser's flanks do not touch.
Verified by tests/unit/test_ancf_wheel_ground.py.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.spatial.transform import Rotation

from ancf_reduced.compiled import compiled
from ancf_reduced.contact.terrain_kernels import is_outside, piece_gap
from ancf_reduced.wheel.closest import Moved
from ancf_reduced.wheel.contacts import Near, Points, Surface
from ancf_reduced.wheel.mesh import AncfWheel
from contracts.errors import InputError
from contracts.frames import ground_direction_h
from contracts.hub_travel import HubTravel
from contracts.terrain import PieceKind, Plane, Terrain

__all__ = ["GroundContact", "Pose", "ground_frame"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Pose = tuple[Array, Array]
"""Where the ground is: rows (3, 3) of its axes in the wheel's frame, its origin (3,) in these axes [m]."""
_REACH = 10e-3
"""Gap up to which a point may touch the ground within one step [m]."""
_SKIN = 4e-3
"""Movement of wheel and ground together for which a search of what is near looks ahead [m]."""
_HALVINGS = 60
_SHALLOWEST = 1e-5
"""Depth up to which soil presses in proportion to it [m]."""
_PLANE, _FIELD = int(PieceKind.PLANE), int(PieceKind.HEIGHT_FIELD)


def ground_frame(orientation: float, camber: float = 0.0) -> Array:
    """Rows (3, 3): forward, left and normal of the ground in the wheel's frame.

    orientation : circumferential position that faces the ground [rad]
    camber : of the ground about the forward direction; positive lifts its left side [rad]
    """
    up, left = -ground_direction_h(orientation), np.array([0.0, 1.0, 0.0])
    normal = np.cos(camber) * up - np.sin(camber) * left
    return np.stack([np.cross(left, up), np.cos(camber) * left + np.sin(camber) * up, normal])


class GroundContact:
    """Rim and grousers on a terrain.

    Parameters
    ----------
    terrain : in the ground's frame
    frame : rows (3, 3) forward, left, normal of the ground, from `ground_frame`
    penalty : [N/m^3]
    travel : what follows the rise, or None
    soil : modulus k [N/m^(n+2)] and exponent n of soil in place of rigid ground, or None. What lies z deep is pressed
        by k z^n on its level area: a penalty at each contact, the secant k z^(n-1) times how level its face is

    Raises
    ------
    InputError
        For half a wheel on ground that is not symmetric about its middle plane, or moved otherwise than along it; for a
        travel over ground that is not plane.
    """

    def __init__(
        self,
        wheel: AncfWheel,
        terrain: Terrain,
        frame: Array,
        penalty: float,
        travel: HubTravel | None = None,
        soil: tuple[float, float] | None = None,
    ) -> None:
        self._soil = soil
        if soil is not None and (travel is not None or not isinstance(terrain, Plane)):
            rule = "presses as a plane, by its depth alone"
            raise InputError("soil", "with an obstacle or a travel", rule, "leave them out")
        self._points, self._frame, self._penalty = Points(wheel, wheel.ground), frame, penalty
        self._travel = travel
        if travel is not None and not isinstance(terrain, Plane):
            rule = "must be a plane if the wheel is moved over it"
            raise InputError("ground", type(terrain).__name__, rule, "leave out the travel")
        askew = [] if travel is None else [way for way in travel.ways if not way.mirrored]
        if askew and wheel.sides > 1.0:
            rule = "is not symmetric about the wheel's middle plane"
            raise InputError("travel", askew[0].value, rule, "build the full width (half_width = false)")
        self._rows, self._knots, _ = terrain.pieces()
        if wheel.sides > 1.0:
            _require_symmetric(self._rows, frame)
        self.count = len(wheel.ground.plate) * len(self._rows)
        self._moved = Moved(wheel.plates, float(np.abs(wheel.ground.height).max(initial=0.0)))
        places = self._points.at(wheel.plates.reference)[0]
        self._farthest = float(np.linalg.norm(places, axis=1).max()) + _REACH
        self._searched: Pose | None = None
        self._close = np.arange(len(places))
        self._touch = self._first_touch(places)

    def risen(self, deflection: float) -> Pose:
        """The ground's pose where it has risen by a deflection [m] from first touch; what follows counts on from it."""
        if self._travel is None or deflection <= self._travel.start:
            return self._frame, np.array([0.0, 0.0, self._touch + deflection])
        motion = self._travel.ground(deflection)
        forward, _, up = self._frame
        turns = (motion.leant, forward), (motion.wound, np.array([0.0, 1.0, 0.0])), (motion.turned, up)
        turn = Rotation.from_rotvec(sum((angle * axis for angle, axis in turns), np.zeros(3)))
        return turn.apply(self._frame), np.array([motion.forward, motion.left, self._touch + motion.up])

    def near(self, q: Array, pose: Pose, forces: Array, blocks: Array) -> Near:
        """Points within reach of the ground; adds to blocks what forces add.

        Raises
        ------
        InputError
            For points on the ground beside a height field.
        """
        if self._away(q, pose) > _SKIN:
            places = self._points.at(q)[0]
            self._close = np.unique(self._gaps(places, pose, _REACH + _SKIN)[0] // len(self._rows))
            self._moved.remember(q)
            self._searched = pose
        places = self._points.at(q, self._close)[0]
        numbers, gaps, normals, bends = self._gaps(places, pose)
        near, piece = np.divmod(numbers, len(self._rows))
        which = self._close[near]
        contacts = which * len(self._rows) + piece
        penalty = self._penalty if self._soil is None else self._secant(q, which, gaps, normals)
        found = self._points.rigid(q, (which, contacts), gaps, (normals, bends), (penalty, forces, blocks))
        return replace(found, surface=Surface(normals=normals, bends=bends, places=places[near]))

    def _secant(self, q: Array, which: Index, gaps: Array, normals: Array) -> Array:
        """Penalty of soil at each contact [N/m^3]."""
        assert self._soil is not None
        modulus, exponent = self._soil
        level = np.abs((self._points.at(q, which)[1] * normals).sum(axis=1))
        return np.asarray(modulus * np.maximum(-gaps, _SHALLOWEST) ** (exponent - 1.0) * level)

    def places(self, q: Array, contacts: Index) -> Array:
        """Places of contacts' points (n, 3) [m]."""
        return self._points.at(q, contacts // len(self._rows))[0]

    def slopes(self, q: Array, contacts: Index) -> csr_array:
        """Derivatives (3 n, size) of the places of contacts' points by all coordinates."""
        return self._points.slopes(q, contacts // len(self._rows))

    def _away(self, q: Array, pose: Pose) -> float:
        """How far points and ground may have moved towards each other since the last search [m]."""
        if self._searched is None:
            return np.inf
        (R, at), (R_then, then) = pose, self._searched
        shift = float(np.linalg.norm(R.T @ at - R_then.T @ then) + self._farthest * np.linalg.norm(R - R_then))
        return self._moved(q) + shift

    def _gaps(self, places: Array, pose: Pose, reach: float = _REACH) -> tuple[Index, Array, Array, Array]:
        """Numbers of contacts within reach, their gaps [m], normals (n, 3) and bends (n, 3, 3) [1/m]."""
        many = len(places) * len(self._rows)
        numbers, gaps = np.empty(many, dtype=np.int64), np.empty(many)
        normals, bends = np.empty((many, 3)), np.empty((many, 3, 3))
        terrain = self._rows, self._knots, reach
        n = _terrain_gaps(places, pose, terrain, numbers, gaps, normals, bends)
        if n < 0:
            rule = "touch the ground beside the height field"
            raise InputError("contact points", -1 - n, rule, "give a field that covers the wheel")
        return numbers[:n], gaps[:n], normals[:n], bends[:n]

    def _first_touch(self, places: Array) -> float:
        """Level at which the ground just touches the wheel at rest [m]; by halving."""

        def touches(level: float) -> bool:
            return len(self._gaps(places, (self._frame, np.array([0.0, 0.0, level])), 0.0)[0]) > 0

        height = places @ self._frame[2]
        size = float(np.ptp(height))
        low = high = float(height.min())
        for _ in range(_HALVINGS):
            if not touches(low):
                break
            low -= size
        for _ in range(_HALVINGS):
            if touches(high):
                break
            high += size
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            if touches(middle):
                high = middle
            else:
                low = middle
        return low


def _require_symmetric(rows: Array, frame: Array) -> None:
    """Refuse ground that differs from its mirror image about the wheel's middle plane."""
    plane = rows[:, 0] == _PLANE
    across = np.where(plane, rows[:, 2], rows[:, 2] * (rows[:, 0] != _FIELD))
    if abs(frame[2, 1]) > 1e-12 or (np.abs(across) > 1e-12).any() or (rows[:, 0] == _FIELD).any():
        rule = "is not symmetric about the wheel's middle plane"
        raise InputError("ground", "turned or uneven", rule, "build the full width (half_width = false)")


@compiled
def _terrain_gaps(
    places: Array,
    pose: Pose,
    terrain: tuple[Array, Array, float],
    numbers: Index,
    gaps: Array,
    normals: Array,
    bends: Array,
) -> int:
    """Contacts, point by point and piece by piece, with a gap below the reach: how many; see `GroundContact._gaps`.

    Minus one less than the number of points beside a height field, if there are any.
    """
    R, origin = pose
    rows, knots, reach = terrain
    count, outside, bend = 0, 0, np.empty((3, 3))
    for k in range(places.shape[0]):
        p = places[k]
        x = R[0, 0] * p[0] + R[0, 1] * p[1] + R[0, 2] * p[2] - origin[0]
        y = R[1, 0] * p[0] + R[1, 1] * p[1] + R[1, 2] * p[2] - origin[1]
        z = R[2, 0] * p[0] + R[2, 1] * p[1] + R[2, 2] * p[2] - origin[2]
        for piece in range(rows.shape[0]):
            gap, n, H = piece_gap(rows[piece], knots, x, y, z)
            if gap < reach:
                outside += gap < 0.0 and is_outside(rows[piece], knots, x, y)
                numbers[count], gaps[count] = k * rows.shape[0] + piece, gap
                bend[0, 0], bend[1, 1], bend[2, 2] = H[0], H[1], H[2]
                bend[1, 2] = bend[2, 1] = H[3]
                bend[0, 2] = bend[2, 0] = H[4]
                bend[0, 1] = bend[1, 0] = H[5]
                for i in range(3):
                    normals[count, i] = n[0] * R[0, i] + n[1] * R[1, i] + n[2] * R[2, i]
                bends[count] = R.T @ bend @ R
                count += 1
    return count if outside == 0 else -1 - outside
