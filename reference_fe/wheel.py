"""The wheel on a rigid plane, solid or as a planar section: hub held, plane raised, load and stress recorded.

A client of `StaticProblem`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.errors import ConvergenceError, IncrementRecord, InputError
from contracts.frames import ground_direction_h
from contracts.materials import Material
from contracts.mesh import TaggedMesh
from reference_fe.checkpoint import Arrays, Checkpoint, below, packed, problem_key, unpacked
from reference_fe.contact_obstacle import ContactMethod, ObstacleContact, ObstacleTerm
from reference_fe.contact_patch import ContactPatch, contact_faces, facet_samples, measure_patch
from reference_fe.domain import Domain
from reference_fe.hyperelastic import MaterialLaw
from reference_fe.increments import ConvergedState, solve_increments
from reference_fe.inner_contact import InnerContact, InnerContactTerm
from reference_fe.inner_contact_pairs import wheel_contact_pairs
from reference_fe.newton import NewtonSettings, NewtonSolver
from reference_fe.obstacles import Obstacle, Plane, touch_level
from reference_fe.orientation import curved_axis_first
from reference_fe.overlap import FaceOverlap
from reference_fe.static_problem import Discretisation, StaticProblem
from reference_fe.stored_energy import StoredEnergy
from reference_fe.stress import StressRecovery
from reference_fe.supports import Support
from reference_fe.thermal_state import solve_thermal_state

__all__ = ["FieldSnapshot", "WheelLoadCase", "WheelResult", "solve_wheel"]

CONTACT_FACES = ("tire_outer", "grouser_outer")
HUB_PARTS = ("outer_hub", "cone", "impact_springs", "inner_hub")


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelLoadCase:
    """One orientation of the wheel pressed on a plane or another rigid obstacle.

    Attributes
    ----------
    orientation_deg : circumferential position that faces the ground [deg]
    deflections : wanted points of the curve, rise of the obstacle along its ground's normal from first touch [m]
    maximum_load : the run ends at the first point with at least this load [N]
    snapshot_loads : loads of the full wheel at which fields are kept [N]
    rigid_parts : parts held rigid, of those the mesh has; if the inner hub is not among them, its bore is held instead
    inner_contact : whether springs, rim and hubs hold each other off; else they pass through each other
    law : stored energy
    obstacle : what the wheel is pressed on; its s axis points forward, turned by its yaw about the ground's normal
    camber_deg : angle by which the obstacle is turned about the forward direction [deg]; positive lifts its left side
    contact_method : penalty or augmented Lagrangian, see `contact_obstacle.ContactMethod`
    contact_stiffness : penalty stiffness per undeformed area [N/m^3]; None is `contact_facets.local_stiffness`
    friction : Coulomb coefficient on the obstacle [-]
    inner_contact_stiffness : the same between the wheel's own parts [N/m^3]
    contact_ramp : gap at which the contact pressure begins [m], see `contact_law.ramped_pressure`
    gauss_points : Gauss points along the curved axis and the others of a cell, see `Discretisation`; a planar mesh
        takes the first two
    transverse_constraint : planar mesh only, part -> how it is held across the plane, see `plane_state`
    newton : tolerance and iteration limit
    """

    orientation_deg: float
    deflections: tuple[float, ...]
    maximum_load: float = float("inf")
    snapshot_loads: tuple[float, ...] = ()
    rigid_parts: tuple[str, ...] = HUB_PARTS
    inner_contact: bool = True
    law: MaterialLaw = MaterialLaw.ST_VENANT_KIRCHHOFF
    obstacle: Obstacle = field(default_factory=Plane)
    camber_deg: float = 0.0
    contact_method: ContactMethod = ContactMethod.PENALTY
    contact_stiffness: float | None = 1e11
    friction: float = 0.0
    inner_contact_stiffness: float = 1e11
    contact_ramp: float = 5e-6
    gauss_points: tuple[int, ...] = (2, 3, 3)
    transverse_constraint: Mapping[str, float] = field(default_factory=dict)
    newton: NewtonSettings = field(default_factory=NewtonSettings)

    def __post_init__(self) -> None:
        if not np.isfinite(self.orientation_deg):
            raise InputError("orientation", f"{self.orientation_deg} deg", "must be finite", "give degrees, e.g. 15")
        if not abs(self.camber_deg) < 90.0:
            raise InputError("camber", f"{self.camber_deg} deg", "must lie between -90 and 90 deg", "e.g. 10")
        if not self.maximum_load > 0.0:
            raise InputError("maximum load", f"{self.maximum_load:g} N", "must be > 0", "300 N covers the reference")


@dataclass(frozen=True, slots=True, kw_only=True)
class FieldSnapshot:
    """Fields at one load.

    Attributes
    ----------
    load : load of the full wheel [N]
    deflection : rise of the plane from first touch [m]
    displacement : (n_points, dim) at the mesh's nodes [m], wheel frame
    von_mises : (n_points,) Cauchy von Mises stress averaged at the nodes [Pa]; 0 on rigid parts
    """

    load: float
    deflection: float
    displacement: NDArray[np.float64]
    von_mises: NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelResult:
    """Curve, increments and fields of one orientation.

    Attributes
    ----------
    curve : load of the full wheel against the plane's rise from first touch; columns as in `solve_wheel`
    increments : every attempted increment, in order
    snapshots : fields at the chosen loads that were reached
    dofs : number of displacement unknowns
    distance_at_touch : distance of hub and plane at first touch [m]
    wall_s : wall time of the solve [s]
    """

    curve: StiffnessCurve
    increments: tuple[IncrementRecord, ...]
    snapshots: tuple[FieldSnapshot, ...]
    dofs: int
    distance_at_touch: float
    wall_s: float


def solve_wheel(
    mesh: TaggedMesh,
    materials: Mapping[str, Material],
    load_case: WheelLoadCase,
    progress: Callable[[float, float], None] | None = None,
    checkpoint: Path | None = None,
) -> WheelResult:
    """Stiffness curve of a wheel at one orientation.

    Parameters
    ----------
    mesh : wheel in its frame, solid or planar (the curve's model is then "section"); contact faces ``tire_outer`` and
        ``grouser_outer``; a face group ``symmetry`` marks a half width, whose loads and areas are doubled in the result
    materials : part name -> material; parts in ``load_case.rigid_parts`` (by default the hubs and what links them) need
        none, but if theirs has a thermal strain they expand by it. First touch is that of the expanded wheel
    progress : called with the deflection reached [m] and the load [N] after each increment
    checkpoint : file to keep each increment in and, if an earlier run of this very case left it, to go on from; removed
        at the end

    Returns
    -------
    result : the curve's columns are ``contact_length_m`` (extent along the ground), ``contact_area_m2``,
        ``penetration_m`` (also between the points of contact), ``contact_point_penetration_m``,
        ``force_imbalance`` (support plus contact force over contact force),
        ``relative_residual``, ``newton_iterations``, ``spring_rim_gap_m`` (smallest distance of the springs from the
        rim's inside; negative is overlap: the contact's penetration, or more without inner contact),
        ``stored_energy_J`` (elastic energy), ``inner_penetration_m`` (largest at any point of inner contact) and
        ``max_von_mises_{part}_Pa``

    Raises
    ------
    ConvergenceError
        With the partial `WheelResult` as ``last_good`` (its curve marked partial), if there are two or more points.

    Verified by tests/verification/test_fe_wheel.py.
    """
    run = _WheelRun(mesh, materials, load_case)
    kept = None
    if checkpoint is not None:
        key = problem_key(mesh, sorted(materials.items()), load_case)
        kept = Checkpoint(path=checkpoint, key=key, recorder=run)
    try:
        for state in solve_increments(run.solver, load_case.deflections, run.history, checkpoint=kept):
            load = run.record(state)
            if progress is not None:
                progress(state.control, load)
            if load >= load_case.maximum_load:
                break
    except ConvergenceError as error:
        partial = run.result(partial=True) if len(run.rows) > 1 else None
        where = f"orientation {load_case.orientation_deg:g} deg, {run.reach()}: "
        raise ConvergenceError(where + str(error), error.history, partial) from error
    if kept is not None:
        kept.discard()
    return run.result(partial=False)


class _WheelRun:
    """Problem, records and fields of one orientation while it is being solved."""

    def __init__(self, mesh: TaggedMesh, materials: Mapping[str, Material], load_case: WheelLoadCase) -> None:
        self.started, self.load_case = time.perf_counter(), load_case
        self.mesh = mesh = curved_axis_first(mesh, straight=np.array([0.0, 1.0, 0.0]))
        axes = [0, 2] if mesh.dim == 2 else [0, 1, 2]
        rigid = tuple(part for part in load_case.rigid_parts if part in mesh.parts)
        flexible = {part: materials[part] for part in mesh.parts if part not in rigid and part in materials}
        faces = tuple(face for face in CONTACT_FACES if face in mesh.faces)
        self.facets = contact_faces(mesh, faces)
        direction = ground_direction_h(np.deg2rad(load_case.orientation_deg))
        self.direction = direction[axes]
        self.tangent = np.array([-direction[2], 0.0, direction[0]])[axes]
        self.half_width = "symmetry" in mesh.faces
        _check_symmetry(load_case, prismatic=self.half_width or mesh.dim == 2)
        normal, along = ground_axes(direction, load_case)
        self.normal = normal[axes]
        supports = _hub_supports(mesh, rigid, materials)
        if self.half_width:
            supports.append(Support(faces=("symmetry",), components=(1,)))
        domain = Domain.from_tagged(mesh)
        discretisation = Discretisation(law=load_case.law, gauss_points=load_case.gauss_points[: mesh.dim])
        expanded, shape = None, mesh
        if any(material.thermal_strain for material in materials.values()):
            held = load_case.transverse_constraint
            expanded = solve_thermal_state(domain, flexible, supports, discretisation, load_case.newton, held)
            shape = replace(mesh, points=mesh.points + expanded.nodal_displacement())
        points, _ = facet_samples(shape.points, self.facets)
        self.touch = -touch_level(load_case.obstacle, points @ along[axes], points @ self.normal)
        self.contact = ObstacleContact(
            faces=faces,
            normal=tuple(self.normal.tolist()),
            along=tuple(along[axes].tolist()),
            obstacle=load_case.obstacle,
            distance_at_touch=self.touch,
            stiffness=load_case.contact_stiffness,
            ramp=load_case.contact_ramp,
            method=load_case.contact_method,
            friction=load_case.friction,
        )
        self.problem = StaticProblem(
            domain,
            flexible,
            supports,
            contact=self.contact,
            surfaces=[inner] if (inner := _inner_contact(mesh, load_case)) else [],
            discretisation=discretisation,
            transverse_constraint=load_case.transverse_constraint,
        )
        if expanded is not None:
            self.problem.u.x.array[:] = expanded.u.x.array
            self.problem.residual()
            self.problem.surfaces.accept()  # friction counts slip from here
        self.solver = NewtonSolver(self.problem, load_case.newton)
        self.stress = StressRecovery(self.problem)
        self.energy = StoredEnergy(self.problem)
        springs = tuple(part for part in flexible if part not in ("tire", "grousers", *HUB_PARTS))
        self.overlap = FaceOverlap(mesh, springs, "tire_inner") if springs and "tire_inner" in mesh.faces else None
        self.history: list[IncrementRecord] = []
        self.rows: list[dict[str, float]] = [self._row(0.0, 0.0, ContactPatch(area=0.0, length=0.0, penetration=0.0))]
        self.rows[0]["stored_energy_J"] = self._sides * self.energy.value()
        self.snapshots: list[FieldSnapshot] = []

    @property
    def _inner_terms(self) -> list[InnerContactTerm]:
        return [term for term in self.problem.surfaces.terms if isinstance(term, InnerContactTerm)]

    @property
    def _obstacle_term(self) -> ObstacleTerm:
        return next(term for term in self.problem.surfaces.terms if isinstance(term, ObstacleTerm))

    @property
    def _sides(self) -> float:
        return 2.0 if self.half_width else 1.0

    def record(self, state: ConvergedState) -> float:
        """Add one converged state to the curve, with the snapshots passed on the way; returns its load [N]."""
        load, depth = self._load(state.contact_force), self._obstacle_term.penetration()
        for wanted in self.load_case.snapshot_loads:
            if self.rows[-1]["load_N"] < wanted <= load:
                self._keep_snapshot(wanted, state.control, load)
        displacement = self.problem.nodal_displacement()
        ramp = self.load_case.contact_ramp
        gap = partial(self.contact.gap, control=state.control)
        patch = measure_patch(self.mesh, self.facets, displacement, gap, self.tangent, ramp)
        force = float(np.linalg.norm(state.contact_force))
        imbalance = float(np.linalg.norm(state.reaction + state.contact_force)) / force if force else 0.0
        row = self._row(state.control, load, patch)
        row["force_imbalance"], row["relative_residual"] = imbalance, state.outcome.residuals[-1]
        row["contact_point_penetration_m"] = depth
        row["newton_iterations"] = float(state.outcome.iterations)
        if self.overlap is not None:
            row["spring_rim_gap_m"] = self.overlap.smallest_gap(displacement)
        row["inner_penetration_m"] = max((t.largest_penetration for t in self._inner_terms), default=0.0)
        row["stored_energy_J"] = self._sides * self.energy.value()
        row |= {f"max_von_mises_{part}_Pa": value for part, value in self.stress.largest_by_part().items()}
        self.rows.append(row)
        return load

    def result(self, *, partial: bool) -> WheelResult:
        """Everything recorded so far."""
        names, kind = list(self.rows[-1]), "planar" if self.mesh.dim == 2 else "solid"
        table = {name: np.array([row.get(name, 0.0) for row in self.rows]) for name in names}
        curve = StiffnessCurve(
            model="section" if kind == "planar" else "fe",
            orientation_deg=self.load_case.orientation_deg,
            deflection=table.pop("deflection_m"),
            load=table.pop("load_N"),
            columns=table,
            source=f"{kind} finite elements, {self.problem.dofs} unknowns, deflection from first touch",
            partial=partial,
        )
        return WheelResult(
            curve=curve,
            increments=tuple(self.history),
            snapshots=tuple(self.snapshots),
            dofs=self.problem.dofs,
            distance_at_touch=self.touch,
            wall_s=time.perf_counter() - self.started,
        )

    def reach(self) -> str:
        """How far the curve came, in words."""
        if len(self.rows) == 1:
            return "no point of the curve reached"
        return f"curve reached {self.rows[-1]['deflection_m'] * 1e3:.4g} mm at {self.rows[-1]['load_N']:.4g} N"

    def recorded(self) -> Arrays:
        """Rows, snapshots and time so far, for a checkpoint."""
        arrays = {"rows": packed(self.rows), "wall_s": np.array(time.perf_counter() - self.started)}
        for i, snapshot in enumerate(self.snapshots):
            arrays |= {f"snapshot{i}/{name}": np.asarray(value) for name, value in asdict(snapshot).items()}
        return arrays

    def resume(self, arrays: Arrays) -> None:
        """Take up the rows, snapshots and time of a run that was killed."""
        self.rows = unpacked(arrays["rows"])
        self.started -= float(arrays["wall_s"])
        while part := below(f"snapshot{len(self.snapshots)}", arrays):
            load, deflection = float(part["load"]), float(part["deflection"])
            fields = {name: part[name] for name in ("displacement", "von_mises")}
            self.snapshots.append(FieldSnapshot(load=load, deflection=deflection, **fields))

    def _load(self, contact_force: NDArray[np.float64]) -> float:
        return float(self._sides * contact_force @ self.normal)

    def _row(self, deflection: float, load: float, patch: ContactPatch) -> dict[str, float]:
        return {
            "deflection_m": deflection,
            "load_N": load,
            "contact_length_m": patch.length,
            "contact_area_m2": self._sides * patch.area,
            "penetration_m": patch.penetration,
            "contact_point_penetration_m": 0.0,
            "force_imbalance": 0.0,
            "relative_residual": 0.0,
            "newton_iterations": 0.0,
        }

    def _keep_snapshot(self, wanted: float, control: float, load: float) -> None:
        """Solve at the deflection interpolated for the wanted load, keep the fields, and return to ``control``."""
        problem, last = self.problem, self.rows[-1]
        here = problem.state()
        fraction = (wanted - last["load_N"]) / (load - last["load_N"])
        deflection = last["deflection_m"] + fraction * (control - last["deflection_m"])
        problem.set_control(deflection)
        if self.solver.solve(rise=deflection - control).converged:
            self.snapshots.append(
                FieldSnapshot(
                    load=self._load(problem.contact_force()),
                    deflection=deflection,
                    displacement=problem.nodal_displacement(),
                    von_mises=self.stress.nodal_von_mises(),
                )
            )
        problem.restore(here)
        problem.set_control(control)


def ground_axes(down: NDArray[np.float64], load_case: WheelLoadCase) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Unit normal of the ground, to the wheel, and the obstacle's s axis, (3,) each; the wheel stands on ``down``."""
    up, forward, left = -down, np.array([-down[2], 0.0, down[0]]), np.array([0.0, 1.0, 0.0])
    camber, yaw = np.deg2rad(load_case.camber_deg), np.deg2rad(load_case.obstacle.yaw_deg)
    normal, across = np.cos(camber) * up - np.sin(camber) * left, np.cos(camber) * left + np.sin(camber) * up
    return normal, np.cos(yaw) * forward + np.sin(yaw) * across


def _check_symmetry(load_case: WheelLoadCase, *, prismatic: bool) -> None:
    """Refuse a half-width or planar wheel on an obstacle that is not symmetric about its mid-plane."""
    turned = load_case.camber_deg or load_case.obstacle.yaw_deg
    if prismatic and turned:
        rule = "breaks the symmetry of a half-width or planar mesh"
        raise InputError("camber or yaw", f"{turned:g} deg", rule, "mesh the full width")


def _inner_contact(mesh: TaggedMesh, load_case: WheelLoadCase) -> InnerContact | None:
    """What holds the wheel's parts off each other, or None."""
    pairs = wheel_contact_pairs(mesh) if load_case.inner_contact else ()
    return InnerContact(pairs=pairs, stiffness=load_case.inner_contact_stiffness) if pairs else None


def _hub_supports(mesh: TaggedMesh, rigid: tuple[str, ...], materials: Mapping[str, Material]) -> list[Support]:
    """What holds the wheel, expanded as its material is: its rigid parts, and the bore of an elastic inner hub."""
    stretch = {part: materials[part].thermal_stretch if part in materials else 1.0 for part in mesh.parts}
    supports = [Support(parts=(part,), stretch=stretch[part]) for part in rigid]
    if "inner_hub" in mesh.parts and "inner_hub" not in rigid:
        supports.append(Support(faces=("inner_hub_bore",), stretch=stretch["inner_hub"]))
    if not supports:
        rule = "must hold the wheel: the mesh has neither of them nor an inner hub"
        raise InputError("rigid parts", ", ".join(rigid) or "none", rule, "name a part of the mesh, e.g. outer_hub")
    return supports
