"""Whether a tire stands at its equilibria, and whether its mesh decides what it carries.

Verified by tests/unit/test_ancf_standing.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.tire.mesh import Tire, build_tire
from ancf_reduced.tire.plane_problem import PlaneProblem
from ancf_reduced.tire.preset import TirePreset, refined_preset
from ancf_reduced.tire.static import TireEquilibria, solve_tire
from contracts.errors import ConvergenceError
from contracts.frames import ground_direction_h

__all__ = ["MeshChange", "Unstable", "first_unstable", "mesh_change"]

FloatArray = NDArray[np.float64]
_ZERO = 1e-9
"""Eigenvalues above minus this share of the largest count as none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Unstable:
    """The first equilibrium of a curve at which the tangent has negative eigenvalues.

    Attributes
    ----------
    deflection, load : of the point [m, N]
    count : of negative eigenvalues
    angle_deg : where the mode of the lowest one moves most, circumferential position [deg]
    radius : the same, distance from the axle [m]
    """

    deflection: float
    load: float
    count: int
    angle_deg: float
    radius: float


def first_unstable(tire: Tire, states: TireEquilibria) -> Unstable | None:
    """Where a tire, held at its hub on a plane at a given deflection, does not stand; None if it does everywhere.

    states : of the same tire, from `solve_tire`
    """
    problem = PlaneProblem(tire=tire, direction=ground_direction_h(states.phi))
    free = tire.tie.free
    unit = np.tile([1.0] * 3 + [1.0 / tire.preset.rim_thickness] * 9, len(free))
    for deflection, load, p in zip(states.deflection.tolist(), states.load.tolist(), states.coordinates, strict=True):
        tangent = problem.tangent(p[free].ravel(), deflection) / unit[:, None]
        scale = 1.0 / np.sqrt(np.maximum(np.abs(np.diag(tangent)), np.finfo(float).tiny))
        values, modes = np.linalg.eigh(0.5 * (tangent + tangent.T) * scale[:, None] * scale)
        count = int((values < -_ZERO * values[-1]).sum())
        if count:
            moved = np.linalg.norm((scale * modes[:, 0]).reshape(-1, 4, 3)[:, 0], axis=1)
            x, _, z = p[free[moved.argmax()], 0]
            angle = float(np.degrees(np.arctan2(x, -z)) % 360.0)
            radius = float(np.hypot(x, z))
            return Unstable(deflection=deflection, load=load, count=count, angle_deg=angle, radius=radius)
    return None


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshChange:
    """What twice as many plates along rim and spokes make of a curve.

    Attributes
    ----------
    largest : load on the doubled mesh over that on the tire's own, minus one, at the point where it is largest [-]
    deflection : of that point [m]
    reached : last deflection that the doubled mesh came to [m]; below the last asked for, it found no equilibrium there
    """

    largest: float
    deflection: float
    reached: float


def mesh_change(preset: TirePreset, phi: float, deflections: Sequence[float]) -> MeshChange:
    """Compare a tire with itself on a doubled mesh at one orientation [rad] and deflections [m].

    Raises
    ------
    ConvergenceError
        If one of them does not come to the first deflection, or the tire itself not to the last.
    """
    own = solve_tire(build_tire(preset), phi, deflections)
    finer = refined_preset(preset, 2 * preset.circumferential_plates, 2 * preset.plates_per_spoke)
    try:
        fine = solve_tire(build_tire(finer), phi, deflections)
    except ConvergenceError as error:
        if not isinstance(error.last_good, TireEquilibria):
            raise
        fine = error.last_good
    change = fine.load / own.load[: len(fine.load)] - 1.0
    worst = int(np.abs(change).argmax())
    return MeshChange(
        largest=float(change[worst]), deflection=float(fine.deflection[worst]), reached=float(fine.deflection[-1])
    )
