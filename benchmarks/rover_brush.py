"""Speed of the rover on brush tires and on a wheel by its curves: straight path, random rocks, and EXUDYN beside it.

``make bench NAME=rover_brush`` prints the table and writes ``build/bench/rover_brush.json``; with ``ARGS=--record`` the
run is kept for the report. Processor time of one thread, the shortest of three runs, compilation left out; ten outputs
a second. Errors are against a run with a hundred times smaller error a step and a fifth of the longest step: place of
any body, and the root mean square of the wheel loads' differences (impacts on a rock's edge shift by milliseconds).

The wheel by its curves is made up, a tenth stiffer every third of a turn, 24 curves of 15 points as a study's have;
what it costs does not depend on them. Its carcass is as stiff as the built-in wheel.

EXUDYN (`peer_codes/rover_exudyn.py`) gets the same bodies, hinges, masses, speed law and radial law on the plane, and a
slip law equal to ours at the driven speed; our tire leaves rolling resistance and the fall of friction with slip out
there, as EXUDYN has none. How far the fine runs of the two then lie apart is a row of the table. EXUDYN's step is the
one at which its place along the path in the first 4 s, the acceleration, is as exact as ours, from its order of two, to
the next part of the time between outputs; each code is held against its own fine run. Times in turn, the shortest of
three. Over rocks EXUDYN has no terrain of ours: that column is empty.
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from benchmarks.output.run import Run, add_option  # noqa: E402
from benchmarks.peer_codes.rover_exudyn import SAMPLED, PeerRun, alike, run_exudyn  # noqa: E402
from contracts.curves import StiffnessCurve  # noqa: E402
from contracts.terrain import Plane, Terrain  # noqa: E402
from contracts.terrain_rocks import RandomRocks  # noqa: E402
from rover_dynamics.multibody.implicit_steps import ImplicitSteps  # noqa: E402
from rover_dynamics.multibody.motion_law import SpeedTrapezoid  # noqa: E402
from rover_dynamics.rover.rover import Actuators, build_rover  # noqa: E402
from rover_dynamics.rover.rover_file import read_rover  # noqa: E402
from rover_dynamics.tires.brush_settings import Carcass, yielding  # noqa: E402
from rover_dynamics.tires.wheel_potential import Tips, wheel_potential  # noqa: E402
from rover_dynamics.vehicle.vehicle import Vehicle, VehicleMotion, drive_vehicle  # noqa: E402
from workbench.questions.speed.aims import BESIDE_EXUDYN, FASTER, PATHS, PEER_TIME, on_its_curves  # noqa: E402

FloatArray = NDArray[np.float64]
DESIGN = read_rover()
FORWARD = 70.0 / 3600.0
"""[m/s]"""
SPEED = FORWARD / DESIGN.wheel_radius
STRAIGHT = SpeedTrapezoid(speed=SPEED, accelerates=5.0, decelerates=5.0, ends=40.0)
ON = SpeedTrapezoid(speed=SPEED, accelerates=5.0)
ROCKS = RandomRocks(seed=1, size=(6.0, 4.0), origin=(-1.5, -2.0), clear=(0.0, 0.0, 1.0), abundance=0.2)
"""A rock in the path lifts a wheel by 67 mm."""
STEPS = ImplicitSteps()
FINE = ImplicitSteps(tolerance=0.01 * STEPS.tolerance, longest=0.2 * STEPS.longest)
WINDOW = 4.0
"""Time over which both codes' errors along the path are compared [s]."""
CARCASS = Carcass(forward=2800.0, sideways=12000.0)
"""Forwards and sideways [N/m], near the built-in wheel's."""
PEER_STEP, PEER_FINE = 0.02, 5e-4
"""Steps of EXUDYN's run from which ours is chosen, and of its fine run [s]."""


def rover(law: SpeedTrapezoid, terrain: Terrain) -> Vehicle:
    """All six wheels driven by one law."""
    laws = {f"drive_{leg.name}": law for leg in DESIGN.legs}
    return build_rover(DESIGN, terrain=terrain, actuators=Actuators(laws=laws), height=-0.024)


def on_curves(vehicle: Vehicle) -> Vehicle:
    """The same rover on wheels that carry as curves all around say."""
    deflection, tips = np.linspace(0.0, 0.055, 15), Tips(radius=0.1425, height=3e-3, number=12.0, phase=0.0, half=3e-3)
    curves = [
        StiffnessCurve(
            model="fe",
            orientation_deg=5.0 * k,
            deflection=deflection,
            load=(8000.0 + 800.0 * np.cos(np.radians(15.0 * k))) * deflection,
        )
        for k in range(24)
    ]
    settings = replace(vehicle.settings, potential=wheel_potential(curves, np.radians(120.0), tips))
    return replace(vehicle, settings=yielding(settings, vehicle.tire, CARCASS))


def timed(vehicle: Vehicle, times: FloatArray) -> tuple[VehicleMotion, float]:
    """The motion and the shortest processor time of three runs [s]."""
    drive_vehicle(vehicle, times[:2])
    spent = []
    for _ in range(3):
        begun = time.process_time()
        motion = drive_vehicle(vehicle, times, STEPS)
        spent.append(time.process_time() - begun)
    return motion, min(spent)


def row(
    case: str, metric: str, unit: str, ours: float, peer: float | None = None, ratio: float | None = None
) -> dict[str, object]:
    """One line of the table."""
    return {"case": case, "metric": metric, "unit": unit, "ours": ours, "peer": peer, "ratio": ratio}


def own_rows(case: str, vehicle: Vehicle, end: float) -> list[dict[str, object]]:
    """Time, steps and errors of our run."""
    times = np.linspace(0.0, end, round(10.0 * end) + 1)
    motion, spent = timed(vehicle, times)
    fine = drive_vehicle(vehicle, times, FINE)
    place = float(np.abs(motion.positions - fine.positions).max())
    loads = float(np.sqrt(np.mean((motion.tires - fine.tires)[:, :, 1] ** 2)))
    return [
        row(case, "processor time", "s", spent),
        row(case, FASTER, "-", end / spent),
        row(case, "steps", "-", motion.steps),
        row(case, "steps refused", "-", motion.rejected),
        row(case, "Newton iterations", "-", motion.iterations),
        row(case, "rise of a wheel", "m", float(np.ptp(motion.positions[:, :, 2], axis=0).max())),
        row(case, "error of a place", "m", place),
        row(case, "error of the wheel loads, rms", "N", loads),
    ]


def peer_rows(vehicle: Vehicle) -> list[dict[str, object]]:
    """Both codes on the same model, at our error along the path."""

    def peer(end: float, step: float) -> PeerRun:
        return run_exudyn(vehicle, STRAIGHT, FORWARD, end, step)

    times = np.linspace(0.0, WINDOW, round(10.0 * WINDOW) + 1)
    found, fine = (drive_vehicle(vehicle, times, steps).positions[:, 0] for steps in (STEPS, FINE))
    error, _, height = np.abs(found - fine).max(axis=0).tolist()
    exact = peer(WINDOW, PEER_FINE).places
    coarse = np.abs(peer(WINDOW, PEER_STEP).places - exact).max(axis=0)
    step = SAMPLED / round(SAMPLED / (PEER_STEP * np.sqrt(error / coarse[0])))
    theirs = np.abs(peer(WINDOW, step).places - exact).max(axis=0).tolist()
    apart = np.abs(fine - exact).max(axis=0).tolist()
    end, spent, other = STRAIGHT.ends, [], []
    for _ in range(3):
        spent.append(timed(vehicle, np.linspace(0.0, end, round(10.0 * end) + 1))[1])
        other.append(peer(end, step).seconds)
    ours, others = min(spent), min(other)
    case = BESIDE_EXUDYN
    return [
        row(case, "fine runs apart, along the path", "m", apart[0]),
        row(case, "fine runs apart, height", "m", apart[2]),
        row(case, "longest step", "s", STEPS.longest, step),
        row(case, "error along the path", "m", error, theirs[0]),
        row(case, "error of the height", "m", height, theirs[2]),
        row(case, PEER_TIME, "s", ours, others, others / ours),
    ]


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_option(parser)
    options, run = parser.parse_args(), Run("rover_brush")
    straight, rocks = rover(STRAIGHT, Plane()), rover(ON, ROCKS.terrain())
    rows = [r for (case, end), v in zip(PATHS.items(), (straight, rocks), strict=True) for r in own_rows(case, v, end)]
    for (case, end), v in zip(PATHS.items(), (straight, rocks), strict=True):
        rows += own_rows(on_its_curves(case), on_curves(v), end)
    rows += peer_rows(alike(straight))
    for r in rows:
        peer = "" if r["peer"] is None else f"{r['peer']:>12.3g}"
        ratio = "" if r["ratio"] is None else f"{r['ratio']:>8.2f}"
        print(f"{r['case']:<38}{r['metric']:<34}{r['ours']:>12.4g} {r['unit']:<3}{peer}{ratio}")
    for path in run.write(rows, keep=options.record):
        print(f"written: {path}")


if __name__ == "__main__":
    main()
