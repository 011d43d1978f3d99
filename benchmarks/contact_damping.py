"""What damps the contact points of ANCF tires, side by side: c = 0, 10, 100 N s/m and Hunt and Crossley's law.

``make bench NAME=contact_damping`` prints the table and writes ``build/bench/contact_damping.json``; with
``ARGS=--record`` the run is kept for the report. The rover on six tires of the thesis' dimensions on level ground, once
for each law: at rest (deflection); the straight path at 70 m/h from 5 to 16.5 s, one angle between spokes (power of the
drives, and who takes it, by the energy account); 3.5 N m on each drive, 1.5 to 2 s; a twentieth of the weight laid on
the rover at rest (what of its bouncing is left after 3 s). Means of power are over the whole window, stored energy
included.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from ancf_reduced.contact.law import ContactLaw  # noqa: E402
from ancf_reduced.tire.mesh import build_tire  # noqa: E402
from ancf_reduced.tire.preset import thesis_preset  # noqa: E402
from benchmarks.flexible_rows.cases import row  # noqa: E402
from benchmarks.output.run import Run, add_option  # noqa: E402
from rover_dynamics.flexible.account import COLUMNS, FlexibleAccount  # noqa: E402
from rover_dynamics.flexible.flexible_system import FlexibleSystem  # noqa: E402
from rover_dynamics.rover.rover_file import read_rover  # noqa: E402
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS  # noqa: E402
from rover_dynamics.rover.scenarios.scenario import Scenario, run_scenario  # noqa: E402
from workbench.questions.rover.tire_shapes import Watch  # noqa: E402
from workbench.questions.rover.tires import AncfRide, contact_law, on_ancf_tires, watching  # noqa: E402
from workbench.questions.speed.damping import (  # noqa: E402
    AT_REST,
    BOUNCES,
    LAWS,
    SHARE,
    SPEED,
    STRAIGHT,
    TRACTION,
    drives_of,
)

DESIGN, TIRE = read_rover(), build_tire(thesis_preset())
ADDED = 0.05
"""Of the weight, laid on the rover at rest."""


def laws() -> dict[str, ContactLaw]:
    """By name, as `LAWS`: the thesis' law with its c changed, and the default of other tires."""
    printed = contact_law(TIRE.preset)
    others = contact_law(replace(TIRE.preset, contact_damping="hunt_crossley"))
    return dict(zip(LAWS, [*(replace(printed, damping=c) for c in (0.0, 10.0, 100.0)), others], strict=True))


def powers(scenario: Scenario, between: tuple[float, float]) -> tuple[dict[str, float], float, float]:
    """Mean power of each column of the account [W] and speed [m/s] between two times; mean deflection at zero [m]."""
    accounts: list[FlexibleAccount] = []

    def account(system: FlexibleSystem) -> Watch:
        accounts.append(FlexibleAccount(system))
        return accounts[-1].watch

    run = run_scenario(watching(scenario, account), DESIGN)
    if run.stopped is not None:
        raise SystemExit(run.stopped)
    times, table = np.array(accounts[-1].times), accounts[-1].table()
    first, last = np.searchsorted(times, between[0]), np.searchsorted(times, between[1] - 1e-9)
    mean = (table[last] - table[first]) / (times[last] - times[first])
    window = (run.motion.times >= between[0]) & (run.motion.times <= between[1])
    speed = float(run.motion.velocities[window, 0, 0].mean())
    return dict(zip(COLUMNS, mean.tolist(), strict=True)), speed, float(run.deflections[0].mean())


def bouncing_left(law: ContactLaw) -> float:
    """Rms of the body's vertical speed from 3 to 4 s over that of the first second after weight is added [-]."""
    held = replace(SCENARIOS["straight"], settles=0.0, lasts=4.0, every=0.02, actuators=SCENARIOS["drop"].actuators)
    scenario = on_ancf_tires(held, TIRE, law=law)
    assert isinstance(scenario.ride, AncfRide)
    light = replace(DESIGN, gravity=(1.0 - ADDED) * DESIGN.gravity)
    start = scenario.ride.standing(scenario, light, 0.0)
    motion = scenario.ride.moved(scenario, DESIGN, start)
    speed = motion.velocities[:, 0, 2]
    late, early = motion.times >= 3.0, motion.times <= 1.0
    return float(np.sqrt(np.mean(speed[late] ** 2) / np.mean(speed[early] ** 2)))


def rows_of(name: str, law: ContactLaw) -> list[dict[str, object]]:
    """Of one law."""
    straight = replace(SCENARIOS["straight"], lasts=17.0)
    traction = replace(SCENARIOS["traction"], lasts=2.0)
    found = []
    for path, scenario, between in ((STRAIGHT, straight, (5.0, 16.5)), (TRACTION, traction, (1.5, 2.0))):
        mean, speed, deflection = powers(on_ancf_tires(scenario, TIRE, law=law), between)
        found.append(row(name, drives_of(path), "W", mean["drives"]))
        for part, words in SHARE.items():
            found.append(row(name, f"{path}: {words}", "%", 100.0 * mean[part] / mean["drives"]))
        found.append(row(name, f"{path}: {SPEED}", "m/s", speed))
        if path == STRAIGHT:
            found.append(row(name, AT_REST, "mm", 1e3 * deflection))
    return [*found, row(name, BOUNCES, "%", 100.0 * bouncing_left(law))]


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_option(parser)
    options, run = parser.parse_args(), Run("contact_damping")
    rows = [r for name, law in laws().items() for r in rows_of(name, law)]
    for r in rows:
        print(f"{r['case']:<28}{r['metric']:<60}{r['ours']:>12.4g} {r['unit']}")
    for path in run.write(rows, keep=options.record):
        print(f"written: {path}")


if __name__ == "__main__":
    main()
