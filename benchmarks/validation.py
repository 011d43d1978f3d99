"""Wheels of others: the continuum model beside published hub displacements, with what the inputs left open can do.

``make bench NAME=validation``. Each wheel of ``workbench/questions/validation/cases.toml`` is solved on three meshes,
then with every input that its publication leaves open at each of its values. Writes ``build/bench/validation.json`` and
the record that the report reads, ``validation.json`` in the folder beside each wheel's study.
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
from contracts.curves import read_curve  # noqa: E402
from workbench.commands.computing import computed  # noqa: E402
from workbench.commands.options import DEFAULT_STORE, computing  # noqa: E402
from workbench.execution.result_files import read_result  # noqa: E402
from workbench.questions.kept import keep  # noqa: E402
from workbench.questions.model_curves import CURVE  # noqa: E402
from workbench.questions.validation.cases import (  # noqa: E402
    COMMAND,
    FACTORS,
    NAME,
    PublishedWheel,
    input_task,
    published_wheels,
    wheel_tasks,
)
from workbench.questions.validation.uncertainty import comparisons, input_effects  # noqa: E402
from workbench.study.reading import built_in_study, read_study  # noqa: E402


def displacements(wheel: PublishedWheel, folder: Path) -> list[float]:
    """Hub displacement at each published load [m]."""
    curve = read_curve(folder / CURVE, model="fe", orientation_deg=wheel.orientation)
    return [curve.deflection_at(load) for load, _ in wheel.points]


def found_of(wheel: PublishedWheel, folders: Mapping[str, Path]) -> dict[str, Any]:
    """What the record holds."""
    solid = [folders[f"solid_x{factor:g}"] for factor in FACTORS]
    nominal = folders["inputs_nominal"] if wheel.inputs_by == "section" else solid[0]
    return {
        "factors": list(FACTORS),
        "unknowns": [read_result(folder)["dofs"] for folder in solid],
        "solid_m": [displacements(wheel, folder) for folder in solid],
        "inputs_nominal_m": displacements(wheel, nominal),
        "inputs_m": [
            [displacements(wheel, folders[input_task(i, k)]) for k in range(len(one.values))]
            for i, one in enumerate(wheel.inputs)
        ],
    }


def _show(wheel: PublishedWheel, found: Mapping[str, Any]) -> list[dict[str, object]]:
    rows: list[dict[str, object]] = []
    for one in input_effects(wheel, found):
        moved = ", ".join(f"{name} {100.0 * move:+.1f} %" for name, move in one.moves.items())
        print(f"{wheel.name:8s} {one.what}: {moved}")
    for c in comparisons(wheel, found):
        u_data = "unknown" if c.u_data is None else f"{1e3 * c.u_data:.3f}"
        print(
            f"{wheel.name:8s} {c.load:7.3f} N: S {1e3 * c.simulated:.3f} mm, D {1e3 * c.published:.3f} mm, "
            f"E {1e3 * c.error:+.3f} mm ({100.0 * c.error / c.published:+.1f} %); u_num {1e3 * c.u_num:.3f}, "
            f"u_input {1e3 * c.u_input:.3f}, u_D {u_data}, u_val {1e3 * c.u_val:.3f} mm; |E| / u_val {c.ratio:.2f}"
        )
        ratio = c.published / c.simulated
        row = {"case": wheel.name, "metric": f"hub displacement at {c.load:g} N", "unit": "m"}
        rows.append(row | {"ours": c.simulated, "peer": c.published, "ratio": ratio})
    return rows


def main() -> None:
    """Solve, print, write, keep."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    names = [wheel.name for wheel in published_wheels()]
    parser.add_argument("--only", choices=names, nargs="+", default=names, help="wheels to solve")
    chosen = parser.parse_args()
    run, rows, written = Run(NAME), [], []
    for wheel in (wheel for wheel in published_wheels() if wheel.name in chosen.only):
        started, path = time.perf_counter(), built_in_study().parent / wheel.study
        tasks = wheel_tasks(wheel, path)
        entries = computed(path, tasks, DEFAULT_STORE, computing(None, 1, None))
        found = found_of(wheel, {name: entry.path for name, entry in entries.items()})
        rows += _show(wheel, found)
        written.append(keep(read_study(path), NAME, COMMAND, tasks, time.perf_counter() - started, found))
    for target in [*run.write(rows, keep=False), *written]:
        print(f"written: {target}")


if __name__ == "__main__":
    main()
