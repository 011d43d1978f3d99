"""A case by this project's solver; run as a module with the case's description as JSON."""

from __future__ import annotations

import json
import sys
import time

from benchmarks.peer_codes.case import FRONT, REAR, TOLERANCE, LoadCase, from_description
from contracts.errors import IncrementRecord
from reference_fe.cells.discretisation import Discretisation, ElementFamily
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSettings, NewtonSolver

ELEMENTS = {
    "27 nodes": Discretisation(),
    "20 nodes": Discretisation(family=ElementFamily.SERENDIPITY, gauss_points=(2, 2, 2)),
}


def solve(case: LoadCase, element: str, steps: int) -> dict[str, float]:
    """Drive the line to its full travel in equal steps."""
    cpu, wall = time.process_time(), time.perf_counter()
    supports = [Support(meetings=((FRONT, REAR),), components=(case.component,), value=(case.travel,))]
    if case.held_faces or case.held_parts:
        supports.append(Support(faces=case.held_faces, parts=case.held_parts))
    if case.symmetry:
        supports.append(Support(faces=(case.symmetry,), components=(1,)))
    materials = {part: case.material for part in case.mesh.parts if part not in case.held_parts}
    problem = StaticProblem(Domain.from_tagged(case.mesh), materials, supports, discretisation=ELEMENTS[element])
    solver = NewtonSolver(problem, NewtonSettings(relative_tolerance=TOLERANCE))
    history: list[IncrementRecord] = []
    states = list(solve_increments(solver, [(k + 1) / steps for k in range(steps)], history))
    driven = problem.bcs[0].dof_indices()[0]
    return {
        "unknowns": problem.dofs,
        "increments": len(states),
        "iterations": sum(len(record.residuals) - 1 for record in history),
        "force_N": case.force_factor * float(states[-1].outcome.residual[driven].sum()),
        "cpu_s": time.process_time() - cpu,
        "wall_s": time.perf_counter() - wall,
    }


if __name__ == "__main__":
    wanted = json.loads(sys.argv[1])
    case = from_description(wanted["case"])
    solve(from_description(wanted["warm_up"]), wanted["element"], 1)  # compiles, or loads what was compiled
    print(json.dumps(solve(case, wanted["element"], wanted["steps"])))
