"""Where the time of a motion goes, and how far it is from the bare kernels.

Shares are measured by the interpreter's profiler, which adds to the time of everything that is called often; the bare
kernels are timed one by one on undeformed tires 20 mm deep in the ground, shortest of many calls, and multiplied by how
often each is needed.
"""

from __future__ import annotations

import cProfile
import pstats
from collections.abc import Callable

from ancf_reduced.tire.wheel_set import WheelSet
from benchmarks.ancf_rows.clock import shortest
from benchmarks.flexible_rows.cases import driven, row
from benchmarks.flexible_rows.motions import TOLERANCE
from rover_dynamics.flexible.flexible_system import FlexibleSystem
from rover_dynamics.flexible.flexible_vehicle import FlexibleVehicle
from rover_dynamics.flexible.hub_kernels import hub_wrenches
from rover_dynamics.flexible.linear_solves import condense
from rover_dynamics.multibody.generalised_alpha import generalised_alpha
from rover_dynamics.multibody.tree_kernels import tree_motion
from workbench.questions.speed.aims import BARE

__all__ = ["kernel_rows", "kernel_times", "profile_rows"]

STEP, BUDGET = 0.01, 0.3
"""Length of the step whose matrix is condensed; time for each kernel [s]."""
PARTS = {
    "forces of plates": {("plates/model.py", "elastic_force"), ("plates/model.py", "damping_force")},
    "forces of contact": {("plate_contact.py", "force")},
    "tangents of plates": {("plates/model.py", "step_matrices")},
    "tangents of contact": {("plate_contact.py", "tangents")},
    "plates' matrices to blocks": {("block_reduction.py", "__call__")},
    "condensation": {("linear_solves.py", "condense")},
    "Newton's change": {("step_solver.py", "_correct")},
    "bodies, hubs, time integration": {("flexible_system.py", "advanced"), ("flexible_system.py", "_bias")},
}
"""File and function, with all they call; no part contains another."""


def profile_rows(case: str, vehicle: FlexibleVehicle, end: float) -> list[dict[str, object]]:
    """Shares of a motion, settling included."""
    driven(vehicle, 0.1, TOLERANCE)
    profile = cProfile.Profile()
    profile.runcall(driven, vehicle, end, TOLERANCE)
    stats = pstats.Stats(profile)
    whole: float = stats.total_tt  # type: ignore[attr-defined]
    spent = dict.fromkeys(PARTS, 0.0)
    for (path, _, function), (_, _, _, cumulative, _) in stats.stats.items():  # type: ignore[attr-defined]
        for part, functions in PARTS.items():
            if any(path.endswith(file) and function == name for file, name in functions):
                spent[part] += cumulative
    rows = [row(case, f"share: {part}", "%", 100.0 * seconds / whole) for part, seconds in spent.items()]
    return [*rows, row(case, "share: all else", "%", 100.0 * (1.0 - sum(spent.values()) / whole))]


def kernel_times(vehicle: FlexibleVehicle) -> dict[str, float]:
    """Times of the kernels for all tires [us]."""
    system, tires = FlexibleSystem(vehicle), vehicle.tires
    now = system.at_rest(0.0)
    assert isinstance(tires, WheelSet)
    z, v = system.whole(now)
    p, p_dot, model, contact = tires.node_coordinates(z), tires.node_rates(v), tires.system.model, tires.contact
    wrenches = hub_wrenches(now.hub.z, system.residual(now, system.known(0.0)).hubs)
    c, w_v, w_q = generalised_alpha(0.6, 1.0, 1).weights(STEP)
    blocks, axes = tires.step_matrix(z, v, (w_q, w_v)), system.axes(now)

    def bodies() -> None:
        tree_motion(system.tree, now.q, now.v)
        system._bias(now, wrenches)

    calls: dict[str, Callable[[], object]] = {
        "elastic force": lambda: model.elastic_force(p),
        "damping force": lambda: model.damping_force(p, p_dot),
        "contact force": lambda: contact.force(p, p_dot),
        "equations of the bodies": bodies,
        "tangents of plates": lambda: model.step_matrices(p, (w_q, w_v)),
        "contact tangents": lambda: contact.tangents(p, p_dot),
        "all forces": lambda: tires.force(z, v),
        "all tangents, as blocks": lambda: tires.step_matrix(z, v, (w_q, w_v)),
        "condensation": lambda: condense(tires, blocks, axes, c),
    }
    return {name: shortest(call, BUDGET) for name, call in calls.items()}


FORCES = ("elastic force", "damping force", "contact force", "equations of the bodies")
TANGENTS = ("tangents of plates", "contact tangents")


def kernel_rows(case: str, vehicle: FlexibleVehicle, end: float) -> list[dict[str, object]]:
    """Times of the kernels, and of a motion over that of the kernels it needs."""
    found = kernel_times(vehicle)
    rested, moved = driven(vehicle, 0.1, TOLERANCE), driven(vehicle, end, TOLERANCE)
    iterations = moved.motion.iterations - rested.motion.iterations
    linearisations = moved.motion.linearisations - rested.motion.linearisations
    bare = iterations * sum(found[k] for k in FORCES) + linearisations * sum(found[k] for k in TANGENTS)
    rows = [row("six tires, undeformed, 20 mm in the ground", name, "us", time) for name, time in found.items()]
    return [*rows, row(case, BARE, "-", (moved.seconds - rested.seconds) / (1e-6 * bare))]
