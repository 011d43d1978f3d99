"""Cost of the rover on soil that keeps its ruts, against real time and against the number of touched cells.

``make bench NAME=soil`` prints the table and writes ``build/bench/soil.json``. Straight path at 70 m/h for 20 s after 5
s of settling, ten outputs a second, on rigid wheels, on brush tires and on wheels whose rim gives way as the built-in
wheel's does (three harmonics), with cells of 20, 10 and 5 mm; and once more on a field of sixteen times the area.
Processor time of one thread, the shorter of two runs, compilation left out. Touched cells: those under all six wheels
at the end, from the lengths of their contacts. Aim: five times faster than real time with cells of 10 mm.
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from benchmarks.output.run import Run  # noqa: E402
from rover_dynamics.rover.rover_file import read_rover  # noqa: E402
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS  # noqa: E402
from rover_dynamics.rover.scenarios.on_soil import on_soil  # noqa: E402
from rover_dynamics.vehicle.vehicle import Vehicle, VehicleMotion, drive_vehicle  # noqa: E402
from soil.carcass import RIGID, Carcass  # noqa: E402
from soil.soil import soil_named  # noqa: E402
from soil.steady_wheel import WheelOnSoil  # noqa: E402

DESIGN = read_rover()
LASTS, SETTLES = 20.0, 5.0
"""[s]"""
RIMS = {
    "rigid wheels": RIGID,
    "brush tires": Carcass(compliance=(0.0, 1.0 / 8250.0), load=200.0),
    "flexible rims": Carcass(compliance=(0.0, 75e-6, 41e-6, 8e-6), load=200.0),
}
CELLS, AIM = (0.02, 0.01, 0.005), 5.0


def rover(carcass: Carcass, cell: float, wider: float = 0.0) -> Vehicle:
    """The rover on its way, on a field that is wider by so much to each side [m]."""
    wheel = WheelOnSoil(radius=DESIGN.wheel_radius, width=DESIGN.wheel_width, carcass=carcass)
    scenario = replace(SCENARIOS["straight"], lasts=LASTS)
    vehicle = on_soil(scenario, soil_named("ding2011"), wheel, cell=cell).vehicle(DESIGN)
    bed = vehicle.soil
    assert bed is not None
    low, high = (tuple(x + side * wider for x in one) for side, one in ((-1.0, bed.low), (1.0, bed.high)))
    return replace(vehicle, soil=replace(bed, low=low, high=high))


def timed(vehicle: Vehicle) -> tuple[VehicleMotion, float]:
    """The motion and the shorter processor time of two runs [s]."""
    times, spent = np.concatenate([[-SETTLES], np.linspace(0.0, LASTS, round(10.0 * LASTS) + 1)]), []
    drive_vehicle(vehicle, times[:2])
    for _ in range(2):
        begun = time.process_time()
        motion = drive_vehicle(vehicle, times)
        spent.append(time.process_time() - begun)
    return motion, min(spent)


def touched(vehicle: Vehicle, motion: VehicleMotion) -> float:
    """Cells under six wheels, from the lengths of their contacts by sinkage and deflection."""
    bed = vehicle.soil
    assert bed is not None
    reach = np.array([DESIGN.wheel_radius - motion.tires[-1, k, 0] for k in range(6)])
    wheels = slice(len(DESIGN.bodies) + 2, None, 3)
    height = motion.positions[-1, wheels, 2]
    ahead = np.sqrt(np.maximum(DESIGN.wheel_radius**2 - height**2, 0.0))
    assert (reach > height).all()
    return float(np.sum(ahead + 0.4 * ahead) * bed.wheel.width / bed.cell**2)


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.parse_args()
    run, rows = Run("soil"), list[dict[str, object]]()
    cases = [(name, rim, cell, 0.0) for name, rim in RIMS.items() for cell in CELLS]
    cases.append(("flexible rims, 16 times the field", RIMS["flexible rims"], 0.01, 5.0))
    for name, rim, cell, wider in cases:
        vehicle = rover(rim, cell, wider)
        motion, spent = timed(vehicle)
        cells, faster = touched(vehicle, motion), (LASTS + SETTLES) / spent
        case = f"{name}, {1e3 * cell:g} mm"
        numbers = (
            ("processor time", spent, "s"),
            ("faster than real time", faster, "-"),
            ("touched cells, about", cells, "-"),
            ("steps", float(motion.steps), "-"),
            ("time a step", 1e3 * spent / motion.steps, "ms"),
        )
        rows += [{"case": case, "metric": m, "unit": u, "ours": v, "peer": None, "ratio": None} for m, v, u in numbers]
        aim = "" if cell != CELLS[1] else f"  aim {AIM:g}: {'met' if faster >= AIM else 'missed'}"
        print(f"{case:<46}" + "".join(f"{value:>10.3g} {unit:<3}" for _, value, unit in numbers) + aim, flush=True)
    for path in run.write(rows, keep=False):
        print(f"written: {path}")


if __name__ == "__main__":
    main()
