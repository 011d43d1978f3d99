"""A case by this project's solver; run as a module with the case's folder, element and steps as JSON."""

from __future__ import annotations

import json
import resource
import sys
import time
from pathlib import Path

from benchmarks.peer_codes.case import FRONT, REAR, TOLERANCE, LoadCase, read_case
from contracts.errors import IncrementRecord
from reference_fe.cells.discretisation import Discretisation, ElementFamily
from reference_fe.contact.obstacle import ObstacleContact
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSettings, NewtonSolver

ELEMENTS = {
    "27 nodes": Discretisation(),
    "20 nodes": Discretisation(family=ElementFamily.SERENDIPITY, gauss_points=(2, 2, 2)),
    "20 nodes, 18 points": Discretisation(family=ElementFamily.SERENDIPITY, gauss_points=(2, 3, 3)),
}


def solve(case: LoadCase, element: str, steps: int) -> dict[str, float]:
    """Drive the line, or raise the plane, to its full travel in equal steps."""
    cpu, wall = time.process_time(), time.perf_counter()
    driven = [Support(meetings=((FRONT, REAR),), components=(case.component,), value=(case.travel,))]
    supports = [] if case.ground_faces else driven
    if case.held_faces or case.held_parts:
        supports.append(Support(faces=case.held_faces, parts=case.held_parts))
    if case.symmetry:
        supports.append(Support(faces=(case.symmetry,), components=(1,)))
    materials = {part: case.material for part in case.mesh.parts if part not in case.held_parts}
    problem = StaticProblem(
        Domain.from_tagged(case.mesh),
        materials,
        supports,
        contact=_ground(case) if case.ground_faces else None,
        discretisation=ELEMENTS[element],
    )
    solver = NewtonSolver(problem, NewtonSettings(relative_tolerance=TOLERANCE))
    history: list[IncrementRecord] = []
    end = case.travel if case.ground_faces else 1.0
    states = list(solve_increments(solver, [end * (k + 1) / steps for k in range(steps)], history))
    if case.ground_faces:
        force = float(states[-1].contact_force[case.component])
    else:
        force = float(states[-1].outcome.residual[problem.bcs[0].dof_indices()[0]].sum())
    return {
        "unknowns": problem.dofs,
        "increments": len(states),
        "iterations": sum(len(record.residuals) - 1 for record in history),
        "force_N": case.force_factor * force,
        "cpu_s": time.process_time() - cpu,
        "wall_s": time.perf_counter() - wall,
    }


def _ground(case: LoadCase) -> ObstacleContact:
    return ObstacleContact(
        faces=case.ground_faces,
        normal=tuple(float(axis == case.component) for axis in range(3)),
        distance_at_touch=-case.ground_level,
        stiffness=case.ground_stiffness,
    )


if __name__ == "__main__":
    wanted = json.loads(sys.argv[1])
    solve(read_case(Path(wanted["warm_up"])), wanted["element"], 1)  # compiles, or loads what was compiled
    libraries = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    case = read_case(Path(wanted["case"]))
    print(json.dumps(solve(case, wanted["element"], wanted["steps"]) | {"libraries_MB": libraries}))
