"""The ANCF wheel beside the solid model: 24 orientations of the built-in wheel, and other wheels.

``make bench NAME=ancf_wheels`` computes every wheel of ``workbench/questions/ancf_wheels/wheels.toml`` by both models,
at its orientations and at one of them on meshes twice as fine; ``ARGS="--only amalia e3"`` some of them. Writes
``build/bench/ancf_wheels.json`` and the records that the report reads, ``ancf_wheel_NAME.json`` in the folder beside
each wheel's study. All of it takes most of an hour; what is in the store is not computed again.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT)]

from benchmarks.output.run import Run  # noqa: E402
from contracts.curves import StiffnessCurve, read_curve  # noqa: E402
from contracts.hub_travel import OVER_GROUND  # noqa: E402
from workbench.commands.computing import computed  # noqa: E402
from workbench.commands.options import DEFAULT_STORE, computing  # noqa: E402
from workbench.execution.result_files import read_result  # noqa: E402
from workbench.questions.ancf_wheel.results import stress_differences  # noqa: E402
from workbench.questions.ancf_wheels.cases import (  # noqa: E402
    COMMAND,
    ComparedWheel,
    compared_wheels,
    wheel_tasks,
)
from workbench.questions.ancf_wheels.results import Agreement, agreement, largest  # noqa: E402
from workbench.questions.kept import keep  # noqa: E402
from workbench.questions.model_curves import CURVE  # noqa: E402
from workbench.questions.travel_files import travel_curves  # noqa: E402
from workbench.study.orientation import orientation_name  # noqa: E402
from workbench.study.reading import built_in_study  # noqa: E402


def both(solid: StiffnessCurve, plates: StiffnessCurve) -> dict[str, Any]:
    """Loads at the plates' points within the solid's curve; largest difference of springs' stress before they touch."""
    at = [d for d in plates.deflection.tolist() if 0.0 < d <= solid.deflection[-1] + 1e-12]
    stress = stress_differences(plates, solid, touching=False)
    return {
        "deflection_m": at,
        "fe_N": [solid.load_at(min(d, float(solid.deflection[-1]))) for d in at],
        "plates_N": [plates.load_at(d) for d in at],
        "partial": solid.partial or plates.partial,
        "stress_apart": largest(stress) if len(stress) else None,
    }


def found_of(wheel: ComparedWheel, folders: Mapping[str, Path]) -> dict[str, Any]:
    """What the record holds."""

    def curve(model: str, name: str, orientation: float) -> StiffnessCurve:
        return read_curve(folders[name] / CURVE, model=model, orientation_deg=orientation)

    curves = [
        {"orientation_deg": o} | both(*(curve(m, orientation_name(m, o), o) for m in ("fe", "ancf_wheel")))
        for o in wheel.orientations
    ]
    runs = {
        name: [read_result(folders[orientation_name(model, o)]) for o in wheel.orientations]
        for name, model in (("fe", "fe"), ("plates", "ancf_wheel"))
    }
    travels = [
        {"way": way.value, "orientation_deg": o}
        | {
            name: travel_curves(model, (way,), (o,), folders)[0].stiffness
            for name, model in (("fe", "fe"), ("plates", "ancf_wheel"))
        }
        for o in wheel.moved
        for way in OVER_GROUND
    ]
    return {
        "travels": travels,
        "curves": curves,
        "fine": both(*(curve(m, f"{m}_fine", wheel.fine) for m in ("fe", "ancf_wheel"))),
        "unknowns": {name: [run["dofs"] for run in of] for name, of in runs.items()},
        "solve_s": {name: [round(run["solve_s"], 2) for run in of] for name, of in runs.items()},
    }


def _show(wheel: ComparedWheel, says: Agreement) -> list[dict[str, object]]:
    shown = {
        "load, largest difference": says.largest,
        "load, mean difference": says.mean,
        "plates twice as fine": says.plates_mesh,
        "solid twice as fine": says.solid_mesh,
        "both twice as fine, largest difference": says.finer,
        "stress of springs, largest difference": says.stress,
        "stress, both twice as fine": says.stress_finer,
        "stiffness along the ground, largest difference": says.travel,
    }
    found = {metric: value for metric, value in shown.items() if value is not None}
    for metric, value in found.items():
        print(f"{wheel.name:<10}{metric:<48}{100.0 * value:>+8.2f} %", flush=True)
    return [{"case": wheel.name, "metric": metric, "unit": "%", "ours": 100.0 * v} for metric, v in found.items()]


def main() -> None:
    """Solve, print, write, keep."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    names = [wheel.name for wheel in compared_wheels()]
    parser.add_argument("--only", choices=names, nargs="+", default=names, help="wheels to solve")
    chosen = parser.parse_args()
    run, rows, written = Run("ancf_wheels"), [], []
    for wheel in (wheel for wheel in compared_wheels() if wheel.name in chosen.only):
        started, path = time.perf_counter(), built_in_study().parent / wheel.study
        study = wheel.read(path)
        tasks = wheel_tasks(wheel, study)
        entries = computed(path, tasks, DEFAULT_STORE, computing(None, 1, None))
        found = found_of(wheel, {name: entry.path for name, entry in entries.items()})
        rows += _show(wheel, agreement(wheel, found))
        written.append(keep(study, wheel.record, COMMAND, tasks, time.perf_counter() - started, found))
    for target in [*run.write(rows, keep=False), *written]:
        print(f"written: {target}")


if __name__ == "__main__":
    main()
