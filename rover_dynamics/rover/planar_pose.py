"""A rover's side view: how its legs and pivots stand when its wheels' centres are at given places along level ground.

Left and right do the same, so that what turns about x or z stands still. With w = x + i z a turn by a about y takes w
to w exp(-i a); the centre of the wheel of axle k lies at

    w_k = c + i h + sum_j d_kj exp(-i (a_1 + ... + a_j)),

with c the first body's centre, h how far it has risen, and along the chain from it the links d and the turns a: the
body's pitch, those of the passive pivots, that of the deployment joint. All w_k are given: two equations for each axle
and as many unknowns, h, the pitch, the pivots and the legs, if the rover stands as it should. Newton's method solves
them, for all times at once. Verified by tests/unit/test_walking.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from rover_dynamics.rover.rover_design import SIDES, Leg, PivotRow, RoverDesign

__all__ = ["PlanarPose", "SideView", "side_view"]

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Chain = tuple[tuple[str, complex], ...]
"""From the first body's centre to the wheel's: name of what turns, and the link behind it [m]."""
_ITERATIONS, _CLOSE = 30, 1e-12
"""Of Newton's method; change at which it ends [m, rad]."""
_BODY = "body"


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanarPose:
    """How the rover stands at n times.

    Attributes
    ----------
    rise : (n,) float, of the first body's centre over its height at the start [m]
    pitch : (n,) float, of the first body about y [rad]
    deployment : (n, n_a) float, of each axle's deployment joints [rad]
    arms : (n, n_a) float, of each axle's arms about y against the ground [rad]
    """

    rise: FloatArray
    pitch: FloatArray
    deployment: FloatArray
    arms: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class SideView:
    """Chains of a rover's axles.

    Attributes
    ----------
    axles : rows of legs by name without their side, from the front to the rear
    chains : of each axle
    turns : names of what turns in them
    """

    axles: tuple[str, ...]
    chains: tuple[Chain, ...]
    turns: tuple[str, ...]

    def pose(self, places: FloatArray) -> PlanarPose:
        """Stand with the wheels' centres moved by ``places`` (n, n_a) [m] along the ground against the first body.

        Raises
        ------
        InputError
            For places that the legs do not reach.
        """
        x = np.zeros((len(places), 1 + len(self.turns)))
        start, _ = self._centres(x[:1])
        for _ in range(_ITERATIONS):
            centres, slopes = self._centres(x)
            missing = start + places - centres
            rows = np.concatenate([slopes.real, slopes.imag], axis=1)
            try:
                change = np.linalg.solve(rows, np.concatenate([missing.real, missing.imag], axis=1)[..., None])[..., 0]
            except np.linalg.LinAlgError:
                break
            x += change
            if not np.abs(x).max() < np.pi:
                break
            if np.abs(change).max() < _CLOSE:
                return self._found(x)
        value, rule = f"{np.abs(places).max():.4g} m to a side", "is further than the legs reach"
        raise InputError("places of the wheels under a walking rover", value, rule, "walk with a shorter stride")

    def _found(self, x: FloatArray) -> PlanarPose:
        column = {name: k for k, name in enumerate(self.turns, start=1)}
        arms = [sum((x[:, column[name]] for name, _ in chain), np.zeros(len(x))) for chain in self.chains]
        return PlanarPose(
            rise=x[:, 0],
            pitch=x[:, column[_BODY]],
            deployment=np.stack([x[:, column[chain[-1][0]]] for chain in self.chains], axis=1),
            arms=np.stack(arms, axis=1),
        )

    def _centres(self, x: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """Wheels' centres (n, n_a) [m] and their derivatives (n, n_a, n_x) by rise and turns (n, n_x)."""
        centres = np.zeros((len(x), len(self.chains)), dtype=complex)
        slopes = np.zeros((*centres.shape, x.shape[1]), dtype=complex)
        slopes[:, :, 0] = 1j
        for k, chain in enumerate(self.chains):
            columns = [1 + self.turns.index(name) for name, _ in chain]
            centres[:, k] = 1j * x[:, 0]
            for j, (_, link) in enumerate(chain, start=1):
                turned = link * np.exp(-1j * x[:, columns[:j]].sum(axis=1))
                centres[:, k] += turned
                slopes[:, k, columns[:j]] += -1j * turned[:, None]
        return centres, slopes


def side_view(design: RoverDesign) -> SideView:
    """Of a rover that is the same on both sides.

    Raises
    ------
    InputError
        For a rover that is not, whose pivots turn about other axes than x, y and z, or that does not stand on all of
        its wheels or has more pivots than they hold.
    """
    left, right = ({_row(leg): leg for leg in design.legs if leg.name.endswith(f"_{side}")} for side in SIDES)
    axles = sorted(left, key=lambda row: -left[row].drive[0])
    chains = tuple(_chain(design, left[row]) for row in axles)
    if chains != tuple(_chain(design, right[row]) for row in axles):
        rule = "has legs that differ from left to right"
        raise InputError("walking rover", repr(design.name), rule, "make its rows mirrored ones")
    turns = tuple(dict.fromkeys(name for chain in chains for name, _ in chain))
    if 1 + len(turns) != 2 * len(axles):
        value = f"{len(axles)} axles, {len(turns) - 1 - len(axles)} pivots about y"
        rule = "do not hold it as a leg for each axle can: axles must be two more than pivots on a side"
        raise InputError("walking rover", value, rule, "drive it")
    return SideView(axles=tuple(axles), chains=chains, turns=turns)


def _row(leg: Leg) -> str:
    return leg.name.rpartition("_")[0]


def _flat(point: Sequence[float]) -> complex:
    return complex(point[0], point[2])


def _chain(design: RoverDesign, leg: Leg) -> Chain:
    """Its joints about y, the deployment joint last; names without the side."""
    carried, body = {pivot.second: pivot for pivot in design.pivots}, leg.carrier
    pivots: list[PivotRow] = []
    while body in carried and carried[body] not in pivots:
        pivots.insert(0, carried[body])
        body = carried[body].first
    for pivot in pivots:
        if sum(part != 0.0 for part in pivot.axis) > 1:
            rule = f"of pivot {pivot.name} is none of x, y and z"
            raise InputError("axis", list(pivot.axis), rule, "drive this rover, it cannot be planned to walk")
    turning = [pivot for pivot in pivots if pivot.axis[1] != 0.0]
    names = [_BODY, *[_sideless(pivot.name) for pivot in turning], f"deploy_{_row(leg)}"]
    places = [design.bodies[0].position, *[pivot.position for pivot in turning], leg.deployment, leg.drive]
    links = [_flat(b) - _flat(a) for a, b in pairwise(places)]
    return tuple(zip(names, links, strict=True))


def _sideless(name: str) -> str:
    for side in SIDES:
        name = name.removesuffix(f"_{side}")
    return name
