"""Memory that solves are foretold to take, and what they take: wheels of two studies, in some sizes.

Run by `make bench NAME=foretold_memory`; `ARGS="--times 1 1.5"` takes chosen sizes. As in a run, the mesh is made by
its own task and the process that is measured reads it from a file; a small process starts that one, see
`benchmarks.peer_codes.outcome`. The smallest mesh is solved once before, so that loops are compiled.
The laws of `workbench.questions.fe.foresight` are fitted to this; README.md here has the last measured table.
"""

from __future__ import annotations

import argparse
import importlib
import json
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT)]

from benchmarks.output.run import Run  # noqa: E402
from benchmarks.peer_codes.outcome import measured  # noqa: E402
from workbench.execution.task import Task  # noqa: E402
from workbench.questions.curve_graph import stiffness_tasks  # noqa: E402
from workbench.questions.modes.graph import AskedModes, modes_tasks  # noqa: E402
from workbench.study.model import Study  # noqa: E402
from workbench.study.reading import read_study  # noqa: E402

STUDIES = ("first", "exomars_hoops")
TIMES = (0.7, 1.0, 2.0, 3.5)
"""How many times finer than the study's own mesh [-]."""
POINTS = 2
"""Of a curve: its factors are as large there as anywhere."""
LIMIT_S = 3600.0
SOLVE = """
import importlib, json, pathlib, sys
module, function = sys.argv[1].split(":")
inputs = json.loads(pathlib.Path("inputs.json").read_text())
solve = getattr(importlib.import_module(module), function)
print(solve(inputs, {"mesh": pathlib.Path("mesh")}, pathlib.Path("out"), lambda fraction: None))
"""


def finer(study: Study, times: float) -> Study:
    """The study with all sizes of its mesh divided."""
    given = {name: getattr(study.mesh, name) for name in ("element_size", "axial_size", "edge_size")}
    sizes = {name: size / times for name, size in given.items() if size is not None}
    return study.model_copy(update={"mesh": study.mesh.model_copy(update=sizes)})


def asked_of(study: Study) -> dict[str, Task]:
    """The mesh, and what is solved on it."""
    rough = study.model_copy(update={"fe": study.fe.model_copy(update={"friction": 0.6})})
    mesh, curve = stiffness_tasks(study, "fe", (0.0,))
    held = AskedModes(state="held", load=0.0, orientation_deg=0.0, count=6)
    found = {"mesh": mesh, "curve": curve, "curve, friction": stiffness_tasks(rough, "fe", (0.0,))[-1]}
    for name, task in found.items():
        if name != "mesh":
            inputs = task.inputs | {"deflections": task.inputs["deflections"][:POINTS]}
            found[name] = replace(task, inputs=inputs)
    return found | {"modes": modes_tasks(study, ("fe",), held)[-1]}


def rows(name: str, times: float) -> Iterator[dict[str, object]]:
    """What solves on one mesh are foretold to take, and take."""
    asked = asked_of(finer(read_study(ROOT / "studies" / f"{name}.toml"), times))
    with tempfile.TemporaryDirectory() as text:
        folder, mesh = Path(text), asked.pop("mesh")
        for made in ("mesh", "out"):
            (folder / made).mkdir()
        module, _, function = mesh.function.partition(":")
        getattr(importlib.import_module(module), function)(mesh.inputs, {}, folder / "mesh", lambda _: None)
        for kind, task in asked.items():
            (folder / "inputs.json").write_text(json.dumps(task.inputs), encoding="utf-8")
            run = measured([sys.executable, "-c", SOLVE, task.function], folder, 1, LIMIT_S)
            took, foretold = run.memory_MB * 1.024**2, task.memory / 1e6  # the kernel counts in KiB
            unknowns = int(run.output.split()[-1])
            yield {"study": name, "solve": kind, "unknowns": unknowns, "took_MB": took, "foretold_MB": foretold}


def main() -> None:
    """Measure the chosen sizes, print a table, write the JSON."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--times", nargs="+", type=float, default=TIMES, help="how many times finer than the studies")
    chosen, run, kept = parser.parse_args(), Run("foretold_memory"), list[dict[str, object]]()
    list(rows(STUDIES[0], min(chosen.times)))
    print(f"{'study':16s} {'solve':16s} {'unknowns':>9s} {'took MB':>8s} {'foretold MB':>12s}")
    for name in STUDIES:
        for times in chosen.times:
            for row in rows(name, times):
                kept.append(row)
                numbers = f"{row['unknowns']:9d} {row['took_MB']:8.0f} {row['foretold_MB']:12.0f}"
                print(f"{row['study']:16s} {row['solve']:16s} {numbers}", flush=True)
    for written in run.write(kept, keep=False):
        print(f"written: {written}")


if __name__ == "__main__":
    main()
