"""Work and precision of the multibody engine on the IFToMM problems A01 to A03, with EXUDYN beside it on the first.

``make bench NAME=multibody`` prints the table and writes ``build/bench/multibody.json``. Each row is one error asked
for in a step, explicit or implicit (ours), or one number of steps (EXUDYN, generalised-alpha, compiled): processor
seconds of one thread without set-up, the shortest of three (forty windows: of one), and the error against the published
solution: ours the largest over all times, EXUDYN's at the end. The ratio is EXUDYN's time over that of our fastest row
that is at least as accurate. Without EXUDYN its rows are left out.
"""

from __future__ import annotations

import argparse
import sys
import time
import warnings
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from benchmarks.ancf_rows.clock import row  # noqa: E402
from benchmarks.output.run import Run, add_option  # noqa: E402
from contracts.published import published_table  # noqa: E402
from rover_dynamics.multibody.verification.mechanisms import pendulum  # noqa: E402
from rover_dynamics.multibody.verification.work_precision import PROBLEMS, control_for, work  # noqa: E402

ASKED = {"explicit": (1e-4, 1e-6, 1e-8, 1e-10), "implicit": (1e-4, 1e-5, 1e-6)}
"""Errors of a step."""
RUNS = {"pendulum": 3, "four_bar_2": 3, "four_bar_40": 1, "andrews": 3}
"""Of each; the shortest counts."""
STEPS = (10_000, 100_000)
"""Of EXUDYN over ten seconds."""


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_option(parser)
    options, run = parser.parse_args(), Run("multibody")
    rows: list[dict[str, object]] = []
    ours = {name: _measured(name, rows) for name in PROBLEMS}["pendulum"]
    rows += _exudyn_rows(ours)
    for r in rows:
        ratio = "" if r["ratio"] is None else f"   ratio {r['ratio']:.3g}"
        print(
            f"{r['case']:<34}{r['metric']:<44}{r['ours'] if r['peer'] is None else r['peer']:>10.3g} {r['unit']}{ratio}"
        )
    for path in run.write(rows, keep=options.record):
        print(f"written: {path}")


def _measured(name: str, rows: list[dict[str, object]]) -> list[tuple[float, float]]:
    """Rows of one problem; seconds and error of each."""
    problem, found = PROBLEMS[name], []
    for method, asked in ASKED.items():
        for allowed in asked:
            runs = [work(problem, control_for(method, allowed)) for _ in range(RUNS[name])]
            seconds, best, what = min(r.seconds for r in runs), runs[0], f"{method}, step error {allowed:g}"
            rows += [
                row(problem.title, f"{what}: processor time", "s", seconds),
                row(problem.title, f"{what}: evaluations", "-", best.evaluations),
                row(problem.title, f"{what}: error of the result", problem.unit, best.error),
            ]
            if best.energy is not None:
                rows.append(row(problem.title, f"{what}: change of energy", "-", best.energy))
            found.append((seconds, best.error))
    return found


def _exudyn_rows(ours: list[tuple[float, float]]) -> list[dict[str, object]]:
    """The pendulum by EXUDYN, its end position held against the published one."""
    table, rows = published_table("iftomm_pendulum"), []
    end = np.array([table["x"][-1], table["y"][-1]])
    for steps in STEPS:
        runs = [_exudyn_pendulum(steps, float(table["t"][-1])) for _ in range(3)]
        seconds, error = min(r[0] for r in runs), float(np.max(np.abs(runs[0][1] - end)))
        as_good = [s for s, distance in ours if distance <= error]
        case = "A01 pendulum, 10 s, EXUDYN"
        peer = row(case, f"{steps} steps: processor time", "s", 0.0)
        rows.append({**peer, "ours": min(as_good, default=None), "peer": seconds})
        rows[-1]["ratio"] = seconds / min(as_good) if as_good else None
        rows.append({**row(case, f"{steps} steps: error at the end", "-", 0.0), "ours": None, "peer": error})
    return rows


def _exudyn_pendulum(steps: int, end: float) -> tuple[float, np.ndarray]:
    """Processor seconds and end position; the same body and hinge as ours."""
    import exudyn
    from exudyn.utilities import RigidBodyInertia

    warnings.simplefilter("ignore", DeprecationWarning)
    system = exudyn.SystemContainer().AddSystem()
    ground, bob = system.CreateGround(), pendulum().bodies[0]
    inertia = RigidBodyInertia(mass=bob.mass, inertiaTensor=bob.inertia)
    gravity = list(pendulum().gravity)
    weight = system.CreateRigidBody(referencePosition=list(bob.position), inertia=inertia, gravity=gravity)
    pin = {"position": [0.0, 0.0, 0.0], "axis": [0.0, 0.0, 1.0], "useGlobalFrame": True}
    system.CreateRevoluteJoint(bodyNumbers=[ground, weight], **pin)
    system.Assemble()
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = end, steps
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.9
    settings.solutionSettings.writeSolutionToFile = False
    begun = time.process_time()
    system.SolveDynamic(settings)
    seconds = time.process_time() - begun
    position = system.GetObjectOutputBody(weight, exudyn.OutputVariableType.Position, [0.0, 0.0, 0.0])
    return seconds, np.array(position[:2])


if __name__ == "__main__":
    main()
