"""The wheel on the ground, solid or as a planar section: hub held, ground raised, load and stress recorded.

A client of `StaticProblem`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import asdict
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.errors import ConvergenceError, IncrementRecord
from contracts.material_laws import J2Plasticity
from contracts.materials import Material
from contracts.mesh import TaggedMesh
from reference_fe.contact.inner import InnerContactTerm
from reference_fe.contact.obstacle import ObstacleTerm
from reference_fe.contact.overlap import FaceOverlap
from reference_fe.contact.patch import ContactPatch, measure_patch
from reference_fe.material.linearised_stress import LinearisedStress
from reference_fe.material.stored_energy import StoredEnergy
from reference_fe.material.stress import StressRecovery
from reference_fe.problem.balance import support_moment
from reference_fe.problem.problem_state import ProblemState
from reference_fe.solver.checkpoint import Arrays, Checkpoint, below, packed, problem_key, unpacked
from reference_fe.solver.converged_state import ConvergedState
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSolver
from reference_fe.wheel.case import NO_STRIPS, FieldSnapshot, WheelLoadCase, WheelResult
from reference_fe.wheel.problem import wheel_problem
from reference_fe.wheel.unloading import FORCE_SHARE, at_end, next_deflection, permanent_set, unloading_curve
from reference_fe.wheel.wrench import wrench

__all__ = ["FieldSnapshot", "WheelLoadCase", "WheelResult", "solve_wheel"]


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
    mesh : wheel in its frame, solid or planar (the curve's model is then "section"); contact faces ``tire_outer``,
        ``tread_outer``, ``grouser_outer``; a face group ``symmetry`` marks a half width, whose loads and areas are
        doubled in the result
    materials : part name -> material; parts in ``load_case.rigid_parts`` (by default the hubs and what links them) need
        none, but if theirs has a thermal strain they expand by it. First touch is that of the expanded wheel
    progress : called with the deflection reached [m] and the load [N] after each increment
    checkpoint : file to keep each increment in and, if an earlier run of this very case left it, to go on from; removed
        at the end

    Returns
    -------
    result : the curve's columns are ``contact_length_m`` (extent along the ground), ``contact_area_m2``,
        ``penetration_m`` (also between the points of contact), ``contact_point_penetration_m``,
        ``force_forward_N``, ``force_left_N``, ``moment_forward_Nm``, ``moment_left_Nm``, ``moment_up_Nm`` (of the
        ground on the wheel, with the load its whole wrench at the hub's centre; up is the ground's normal),
        ``force_imbalance`` (support plus contact force over contact force), ``moment_imbalance`` (support plus contact
        moment about the hub's centre, over contact force times the distance of hub and plane at first touch),
        ``relative_residual``, ``newton_iterations``, ``negative_pivots`` (negative eigenvalues of the tangent: none
        where the equilibrium is stable; absent with friction, whose tangent is unsymmetric), ``spring_rim_gap_m``
        (smallest distance of the springs from the rim's inside; negative is overlap: the contact's penetration, or
        more without inner contact),
        ``stored_energy_J`` (elastic energy of the body), ``slip_energy_J`` (stored by elastic slip on a rough
        obstacle), ``friction_dissipation_J`` (by sliding, so far), ``inner_penetration_m`` (largest at any point of
        inner contact), ``max_von_mises_{part}_Pa``, which near a weld's end has no limit under refinement,
        ``max_linearised_{part}_Pa`` of rim and springs, which has one, see `LinearisedStress`, and where a part can
        yield ``plastic_dissipation_J`` (by flow, so far) and ``max_plastic_strain_{part}`` (equivalent, without a
        limit there either)

    Raises
    ------
    ConvergenceError
        With the partial `WheelResult` as ``last_good``: its curve is marked partial, and holds first touch alone if no
        point converged.

    Verified by tests/verification/test_fe_wheel.py.
    """
    run = _WheelRun(mesh, materials, load_case)
    kept = None
    if checkpoint is not None:
        key = problem_key(mesh, sorted(materials.items()), load_case)
        kept = Checkpoint(path=checkpoint, key=key, recorder=run)
    try:
        for state in solve_increments(run.solver, run.next_target, run.history, checkpoint=kept):
            load = run.record(state)
            if progress is not None:
                progress(state.control, load)
    except ConvergenceError as error:
        where = f"orientation {load_case.orientation_deg:g} deg, {run.reach()}: "
        raise ConvergenceError(where + str(error), error.history, run.result(partial=True), error.limit) from error
    if kept is not None:
        kept.discard()
    return run.result(partial=False)


class _WheelRun:
    """Problem, records and fields of one orientation while it is being solved."""

    def __init__(self, mesh: TaggedMesh, materials: Mapping[str, Material], load_case: WheelLoadCase) -> None:
        self.started, self.load_case = time.perf_counter(), load_case
        self.wheel = wheel_problem(mesh, materials, load_case)
        self.mesh, self.problem = self.wheel.mesh, self.wheel.problem
        self.solver = NewtonSolver(self.problem, load_case.newton)
        self.stress, self.energy = StressRecovery(self.problem), StoredEnergy(self.problem)
        self.yields = any(isinstance(law, J2Plasticity) for law in self.problem.laws.values())
        ours = load_case.faces is None  # whose parts are strips of structured cells
        strips = [part for part in self.wheel.flexible if part not in NO_STRIPS and ours]
        self.linearised = LinearisedStress(self.problem, strips)
        springs = tuple(part for part in self.wheel.flexible if part not in ("tire", *NO_STRIPS))
        followed = ours and springs and "tire_inner" in mesh.faces
        self.overlap = FaceOverlap(self.mesh, springs, "tire_inner") if followed else None
        self.history: list[IncrementRecord] = []
        self.rows: list[dict[str, float]] = [self._row(0.0, 0.0, ContactPatch(area=0.0, length=0.0, penetration=0.0))]
        self.rows[0] |= self._energies()
        self.travelled: list[dict[str, float]] = []
        self.returned: list[dict[str, float]] = []
        self.fields: dict[str, list[FieldSnapshot]] = {"snapshot": [], "point": []}

    @property
    def _inner_terms(self) -> list[InnerContactTerm]:
        return [term for term in self.problem.surfaces.terms if isinstance(term, InnerContactTerm)]

    @property
    def _obstacle_term(self) -> ObstacleTerm:
        return next(term for term in self.problem.surfaces.terms if isinstance(term, ObstacleTerm))

    def next_target(self, reached: float) -> float | None:
        """The next value of the control parameter, see `next_deflection`."""
        found = next_deflection(self.load_case, self.rows, self.returned, reached)
        if found is not None and found < reached:
            largest = max(row["load_N"] for row in self.rows) / self.wheel.sides
            self.solver.inner_force = FORCE_SHARE * largest
        travel = self.load_case.travel
        if found is not None and travel is not None and travel.place(found).radial < travel.place(reached).radial:
            self.solver.inner_force = FORCE_SHARE * max(row["load_N"] for row in self.rows) / self.wheel.sides
        return found

    def record(self, state: ConvergedState) -> float:
        """Add one converged state to the curve, with the snapshots passed on the way; returns its load [N]."""
        row, travel = self._measured(state), self.load_case.travel
        if travel is not None and state.control > travel.start:
            self.travelled.append({"control": state.control} | row | {"deflection_m": travel.start})
            return row["load_N"]
        if state.control < self.rows[-1]["deflection_m"]:
            if row["load_N"] == 0.0:
                row["deflection_m"] = permanent_set(self.wheel, self.load_case)
            self.returned.append(row)
            return row["load_N"]
        self.rows.append(row)
        load = row["load_N"]
        if self.load_case.keep_points:
            self._keep("point", state.control, load)
        for wanted in self.load_case.snapshot_loads:  # last: terms of contact keep what they found there
            if self.rows[-2]["load_N"] < wanted <= load:
                self._keep_snapshot(wanted, state.start)
        return load

    def _measured(self, state: ConvergedState) -> dict[str, float]:
        """Everything a converged state tells."""
        load, depth = self._load(state.control, state.contact_force), self._obstacle_term.penetration()
        moment = self._obstacle_term.moment()
        left_over = moment + support_moment(self.problem, state.outcome.residual)
        turning = float(np.linalg.norm(left_over)) / self.wheel.contact.distance_at_touch
        displacement = self.problem.nodal_displacement()
        ramp = self.load_case.contact_ramp
        gap = partial(self.wheel.contact.gap, control=state.control)
        patch = measure_patch(self.mesh, self.wheel.facets, displacement, gap, self.wheel.tangent, ramp)
        force = float(np.linalg.norm(state.contact_force))
        imbalance = float(np.linalg.norm(state.reaction + state.contact_force)) / force if force else 0.0
        row = self._row(state.control, load, patch) | wrench(self.wheel, state.control, state.contact_force, moment)
        row["force_imbalance"], row["relative_residual"] = imbalance, state.outcome.residuals[-1]
        row["moment_imbalance"] = turning / force if force else 0.0
        row["contact_point_penetration_m"] = depth
        row["newton_iterations"] = float(state.outcome.iterations)
        if state.outcome.negative_pivots is not None:
            row["negative_pivots"] = float(state.outcome.negative_pivots)
        if self.overlap is not None:
            row["spring_rim_gap_m"] = self.overlap.smallest_gap(displacement)
        row["inner_penetration_m"] = max((t.largest_penetration for t in self._inner_terms), default=0.0)
        row |= self._energies()
        row |= {f"max_von_mises_{part}_Pa": value for part, value in self.stress.largest_by_part().items()}
        row |= {f"max_linearised_{part}_Pa": value for part, value in self.linearised.largest_by_part().items()}
        return row | {f"max_plastic_strain_{part}": a for part, a in self.stress.largest_plastic_strain().items()}

    def _energies(self) -> dict[str, float]:
        """Energies of the full wheel at the last accepted state [J]."""
        dissipated, slip = self._obstacle_term.friction_energy()
        energies = {"stored_energy_J": self.energy.value(), "slip_energy_J": slip, "friction_dissipation_J": dissipated}
        if self.yields:
            energies["plastic_dissipation_J"] = self.energy.plastic_dissipation()
        return {name: self.wheel.sides * value for name, value in energies.items()}

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
            partial=partial and not at_end(self.load_case, self.rows),
        )
        return WheelResult(
            curve=curve,
            unloading=unloading_curve(curve, self.rows[-1], self.returned, self.load_case.contact_ramp),
            travelled=tuple(self.travelled),
            increments=tuple(self.history),
            snapshots=tuple(self.fields["snapshot"]),
            points=tuple(self.fields["point"]),
            dofs=self.problem.dofs,
            distance_at_touch=self.wheel.contact.distance_at_touch,
            wall_s=time.perf_counter() - self.started,
        )

    def reach(self) -> str:
        """How far the curve came, in words."""
        if len(self.rows) == 1:
            return "no point of the curve reached"
        return f"curve reached {self.rows[-1]['deflection_m'] * 1e3:.4g} mm at {self.rows[-1]['load_N']:.4g} N"

    def recorded(self) -> Arrays:
        """Rows, fields and time so far, for a checkpoint."""
        arrays = {
            "rows": packed(self.rows),
            "travelled": packed(self.travelled),
            "returned": packed(self.returned),
            "wall_s": np.array(time.perf_counter() - self.started),
        }
        for kind, kept in self.fields.items():
            for i, one in enumerate(kept):
                arrays |= {
                    f"{kind}{i}/{name}": np.asarray(value) for name, value in asdict(one).items() if value is not None
                }
        return arrays

    def resume(self, arrays: Arrays) -> None:
        """Take up the rows, fields and time of a run that was killed."""
        self.rows, self.travelled = unpacked(arrays["rows"]), unpacked(arrays["travelled"])
        self.returned = unpacked(arrays["returned"])
        self.started -= float(arrays["wall_s"])
        for kind, kept in self.fields.items():
            while part := below(f"{kind}{len(kept)}", arrays):
                load, deflection = float(part.pop("load")), float(part.pop("deflection"))
                kept.append(FieldSnapshot(load=load, deflection=deflection, **part))

    def _load(self, control: float, contact_force: NDArray[np.float64]) -> float:
        return float(self.wheel.sides * contact_force @ self.wheel.contact.path().axes(control)[0])

    def _row(self, deflection: float, load: float, patch: ContactPatch) -> dict[str, float]:
        return {
            "deflection_m": deflection,
            "load_N": load,
            **wrench(self.wheel, 0.0, np.zeros(self.mesh.dim), np.zeros(3 if self.mesh.dim == 3 else 1)),
            "contact_length_m": patch.length,
            "contact_area_m2": self.wheel.sides * patch.area,
            "penetration_m": patch.penetration,
            "contact_point_penetration_m": 0.0,
            "force_imbalance": 0.0,
            "moment_imbalance": 0.0,
            "relative_residual": 0.0,
            "newton_iterations": 0.0,
        }

    def _keep_snapshot(self, wanted: float, start: ProblemState) -> None:
        """Solve at the deflection interpolated for the wanted load, keep the fields, and return to the last point."""
        problem, last, now = self.problem, self.rows[-2], self.rows[-1]
        here, control = problem.state(), now["deflection_m"]
        begun = control
        if self.yields or self.load_case.friction > 0.0:  # what has flowed or slid since does not go back
            problem.restore(start)
            begun = last["deflection_m"]
        fraction = (wanted - last["load_N"]) / (now["load_N"] - last["load_N"])
        deflection = last["deflection_m"] + fraction * (control - last["deflection_m"])
        problem.set_control(deflection)
        if self.solver.solve(rise=deflection - begun).converged:
            self._keep("snapshot", deflection, self._load(deflection, problem.contact_force()))
        problem.restore(here)
        problem.set_control(control)

    def _keep(self, kind: str, deflection: float, load: float) -> None:
        """Keep the fields of the last accepted state."""
        self.fields[kind].append(
            FieldSnapshot(
                load=load,
                deflection=deflection,
                displacement=self.problem.nodal_displacement(),
                von_mises=self.stress.nodal_von_mises(),
                principal_stress=self.stress.nodal_principal_stress() if kind == "snapshot" else None,
            )
        )
