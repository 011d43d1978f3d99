"""Quasi-static load of an ANCF tire against its deflection: the ground plane is pushed up against a held hub.

Deflection d is the hub's drop from the nominal radius R: the plane lies R - d from the hub. A tire whose outer face
lies inside the nominal circle (see `outer_face_error` in tire_surfaces) therefore carries nothing at first: the thesis
preset's 45 deg curve begins with a dead zone of about 4 mm. Gravity is left out, as in theory notes, section 7.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.motion.equilibrium import NewtonControls, PathPoint, follow_path
from ancf_reduced.tire.mesh import RIM, SPOKE, Tire, build_tire
from ancf_reduced.tire.plane_problem import PlaneProblem
from ancf_reduced.tire.preset import TirePreset
from contracts.curves import StiffnessCurve
from contracts.errors import ConvergenceError, IncrementRecord, InputError
from contracts.frames import ground_direction_h

__all__ = ["TireEquilibria", "solve_near", "solve_tire", "stiffness_curve", "tire_curve"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class TireEquilibria:
    """Equilibria of one tire at one orientation, one row per deflection.

    Attributes
    ----------
    phi : circumferential position that faces the ground [rad]
    deflection : (n,) float [m], hub drop from the nominal radius
    load : (n,) float [N], ground on wheel, from the residual at the reference node
    contact_load : (n,) float [N], sum of the contact forces; equal to ``load`` in equilibrium
    penetration : (n,) float [m], load-weighted mean over the contact points, sum f delta / sum f
    penetration_max : (n,) float [m], of the deepest contact point
    volume_ratio_min : (n,) float [-], smallest det F over the Gauss points
    iterations : (n,) int, linear solves since the row before
    coordinates : (n, n_nodes, 4, 3) float [m, -], structure coordinates in the wheel frame
    history : every increment attempted
    """

    phi: float
    deflection: FloatArray
    load: FloatArray
    contact_load: FloatArray
    penetration: FloatArray
    penetration_max: FloatArray
    volume_ratio_min: FloatArray
    iterations: NDArray[np.int64]
    coordinates: FloatArray
    history: tuple[IncrementRecord, ...]

    def at(self, deflection: float) -> FloatArray:
        """Coordinates (n_nodes, 4, 3) at a solved deflection [m]; raises InputError for one that was not solved."""
        row = int(np.abs(self.deflection - deflection).argmin())
        if abs(self.deflection[row] - deflection) > 1e-9:
            solved = ", ".join(f"{1e3 * d:g}" for d in self.deflection)
            raise InputError("deflection", f"{1e3 * deflection:g} mm", f"was not solved ({solved} mm)", "solve it")
        chosen: FloatArray = self.coordinates[row]
        return chosen

    def curve(self, source: str, partial: bool = False) -> StiffnessCurve:
        """The stiffness curve: further columns as `stiffness_curve` lists them."""
        return StiffnessCurve(
            model="ancf",
            orientation_deg=float(np.degrees(self.phi)),
            deflection=self.deflection,
            load=self.load,
            columns={
                "tire_deformation_m": self.deflection - self.penetration,
                "penetration_m": self.penetration,
                "penetration_max_m": self.penetration_max,
                "balance_error_N": self.contact_load - self.load,
                "volume_ratio_min": self.volume_ratio_min,
                "newton_iterations": self.iterations.astype(np.float64),
            },
            source=source,
            partial=partial,
        )


def _collect(
    problem: PlaneProblem, phi: float, points: Sequence[PathPoint], history: Sequence[IncrementRecord]
) -> TireEquilibria:
    """Evaluate loads and penetrations at the converged points."""
    model, tie = problem.tire.model, problem.tire.tie
    coordinates = np.array([problem.expand(point.x) for point in points])
    states = [(p, point.target) for p, point in zip(coordinates, points, strict=True)]
    patches = [problem.patch(p, deflection) for p, deflection in states]
    reactions = [
        tie.reference_force(model.elastic_force(p) - problem.contact_force(p, deflection))[0]
        for p, deflection in states
    ]
    return TireEquilibria(
        phi=phi,
        deflection=np.array([point.target for point in points]),
        load=np.array(reactions) @ problem.direction,
        contact_load=np.array([patch.load for patch in patches]),
        penetration=np.array([patch.penetration_mean for patch in patches]),
        penetration_max=np.array([patch.penetration_max for patch in patches]),
        volume_ratio_min=np.array([model.volume_ratio(p).min() for p in coordinates]),
        iterations=np.array([point.iterations for point in points], dtype=np.int64),
        coordinates=coordinates,
        history=tuple(history),
    )


def solve_tire(
    tire: Tire, phi: float, deflections: FloatArray | Sequence[float], controls: NewtonControls | None = None
) -> TireEquilibria:
    """Follow the equilibrium of a tire pressed on a frictionless rigid plane, hub held.

    Parameters
    ----------
    tire : from `build_tire`
    phi : circumferential position that faces the ground [rad], any angle
    deflections : (n,) float [m], hub drop from the nominal radius, >= 0, strictly increasing, below R - hub radius
    controls : Newton's tolerance and limits

    Raises
    ------
    InputError
        For deflections or an angle out of range.
    ConvergenceError
        If an increment fails down to the smallest step; ``last_good`` is the TireEquilibria so far (None if none).

    Verified by tests/unit/test_ancf_static_tire.py and tests/verification/test_ancf_tire_table.py.
    """
    targets = np.asarray(deflections, dtype=np.float64)
    _check(tire.preset, phi, targets)
    controls = controls or NewtonControls()
    problem = PlaneProblem(tire=tire, direction=ground_direction_h(phi))
    start = tire.mesh.reference_coordinates()[tire.tie.free].ravel()
    points, history = list[PathPoint](), list[IncrementRecord]()
    path = follow_path(lambda d, x: problem.solve(d, x, controls), (0.0, start), targets.tolist(), controls, history)
    try:
        points.extend(path)
    except ConvergenceError as error:
        last_good = _collect(problem, phi, points, history) if points else None
        where = f"ANCF tire at phi = {np.degrees(phi):g} deg, deflection in m: {error}"
        raise ConvergenceError(where, history, last_good) from error
    return _collect(problem, phi, points, history)


def solve_near(tire: Tire, near: TireEquilibria, controls: NewtonControls | None = None) -> TireEquilibria:
    """Equilibria of a tire from those of one with the same mesh that differs little: no path, one Newton solve each.

    Where one of them does not arrive, the whole path is followed instead (`solve_tire`, which see for what is raised).

    Verified by tests/unit/test_ancf_static_tire.py.
    """
    controls = controls or NewtonControls()
    problem = PlaneProblem(tire=tire, direction=ground_direction_h(near.phi))
    points = list[PathPoint]()
    for deflection, p in zip(near.deflection.tolist(), near.coordinates, strict=True):
        result = problem.solve(deflection, p[tire.tie.free].ravel(), controls)
        if not result.converged:
            return solve_tire(tire, near.phi, near.deflection, controls)
        points.append(PathPoint(target=deflection, x=result.x, iterations=result.iterations))
    return _collect(problem, near.phi, points, ())


def _check(preset: TirePreset, phi: float, targets: FloatArray) -> None:
    """Raise InputError for deflections or an orientation that cannot be solved."""
    limit = preset.zero_radius - preset.hub_radius
    if not np.isfinite(phi):
        raise InputError("orientation", f"{phi} rad", "must be finite", "give an angle such as 0.785 rad")
    if targets.ndim != 1 or not len(targets) or not np.all(np.isfinite(targets)):
        raise InputError("deflections", targets, "must be a list of finite numbers", "give e.g. 1 to 35 mm")
    if targets[0] < 0.0 or targets[-1] >= limit or np.any(np.diff(targets) <= 0.0):
        raise InputError(
            "deflections",
            f"{1e3 * targets.min():g}..{1e3 * targets.max():g} mm",
            f"must increase strictly within 0..{1e3 * limit:g} mm (the plane would reach the hub)",
            "sort them and stay below the limit",
        )


def stiffness_curve(
    preset: TirePreset, phi: float, deflections: FloatArray | Sequence[float], controls: NewtonControls | None = None
) -> StiffnessCurve:
    """Stiffness curve of an ANCF tire at one orientation.

    Further columns: ``tire_deformation_m`` (the tire's own deformation: hub drop minus penetration),
    ``penetration_m`` (load-weighted mean of the contact points), ``penetration_max_m`` (deepest point),
    ``balance_error_N`` (contact load minus hub reaction), ``volume_ratio_min`` (smallest det F) and
    ``newton_iterations``. Deflection is the hub's drop from the nominal radius R, dead zone included.

    Parameters
    ----------
    preset, phi [rad], deflections [m], controls : as `solve_tire`; two deflections or more

    Raises
    ------
    InputError, ConvergenceError
        As `solve_tire`.

    Verified by tests/verification/test_ancf_tire_table.py.
    """
    return tire_curve(build_tire(preset), phi, deflections, controls)


def tire_curve(
    tire: Tire, phi: float, deflections: FloatArray | Sequence[float], controls: NewtonControls | None = None
) -> StiffnessCurve:
    """Stiffness curve of a tire that is built already, on whatever plates; see `stiffness_curve`.

    phi [rad], deflections (n,) [m], controls : as there
    """
    return solve_tire(tire, phi, deflections, controls).curve(source=_describe(tire))


def _describe(tire: Tire) -> str:
    """The line printed with the curve: which mesh, contact grid and penalty."""
    preset, parts = tire.preset, tire.mesh.parts
    n, m = preset.contact_points
    layout = "edges included, at i/(n-1)" if preset.contact_layout == "edges" else "cell centres, at (i+1/2)/n"
    return (
        f"ANCF tire, {parts.count(RIM)} circumferential + {parts.count(SPOKE)} radial plates, contact grid "
        f"{n} x {m} per plate ({layout}), k = {preset.contact_stiffness:g} N/m per point; hub drop from the nominal "
        f"radius; penetration = load-weighted mean"
    )
