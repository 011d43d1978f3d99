"""``workbench mesh``: the wheel's mesh, or the reduced tire's surfaces, loaded or not, as STEP files.

Verified by tests/end_to_end/test_commands.py and tests/end_to_end/test_surfaces.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from contracts.errors import InputError
from workbench.commands.computing import computed, console, naming, read_and_warn, tell_kept
from workbench.commands.stiffness import check_orientation
from workbench.execution.progress import RunDisplay
from workbench.execution.result_files import read_result
from workbench.execution.runner import Computing, run_tasks
from workbench.execution.store import Store
from workbench.questions.ancf.question import surfaces_task
from workbench.questions.curve_graph import mesh_tasks
from workbench.report.folders import check_folder, check_targets
from workbench.report.placing import copy_files
from workbench.study.magnitudes import above_zero

__all__ = ["deflections_si", "run_mesh_of"]

_FILES = ("wheel.msh", "wheel.vtu", "wheel.step", "wheel.png", "solved.msh", "solved.vtu", "summary.json")


def run_mesh_of(
    study_path: Path, model: str, orientation_deg: float, deflections: Sequence[str], out: Path, store: Path
) -> int:
    """The wheel's mesh, or the surfaces of the ANCF tire unloaded and at deflections such as ``"10 mm"``."""
    if model not in ("fe", "ancf"):
        raise InputError("model", model, "is not known", "give fe or ancf")
    if model == "ancf":
        check_orientation(orientation_deg)
        return _run_surfaces(study_path, orientation_deg, deflections, out, store)
    if deflections:
        raise InputError("deflection", deflections[0], "is for the ANCF tire only", "add --model ancf")
    return _run_mesh(study_path, out, store)


def _run_mesh(study_path: Path, out: Path, store: Path) -> int:
    """Mesh files, summary and picture of a study's wheel."""
    study = read_and_warn(study_path)
    check_folder(out)
    check_targets(out, _FILES)
    entries = computed(study_path, mesh_tasks(study, with_files=True), store, Computing(workers=1))
    files = entries["mesh_files"]
    names = sorted(files.manifest["files"])
    tell_kept(copy_files(files.path, names, out, "mesh"))
    for name in names:
        console.print(str(out / name), soft_wrap=True)
    return 0


def _run_surfaces(study_path: Path, orientation_deg: float, deflections: Sequence[str], out: Path, store: Path) -> int:
    """One STEP file of the unloaded tire, one for each deflection; says how far what is read back lies off."""
    study = read_and_warn(study_path)
    task = surfaces_task(study, orientation_deg, deflections_si(deflections))
    check_folder(out)
    check_targets(out, ("ancf.step",))
    with naming(study_path), RunDisplay(console, [task]) as display:
        entry = run_tasks([task], Store(store, study=study_path.stem), display, Computing(workers=1))[task.name]
    for name, deviation in read_result(entry.path)["read_back_m"].items():
        tell_kept(copy_files(entry.path, [f"{name}.step"], out, "mesh ancf"))
        text = f"{out / name}.step (read back: {1e9 * deviation:.2g} nm off at most)"
        console.print(text, soft_wrap=True)
    return 0


def deflections_si(texts: Sequence[str]) -> tuple[float, ...]:
    """Deflections [m] in increasing order, each once; raises InputError for one that is no length above zero."""
    return tuple(sorted({above_zero("deflection", text, "m", "ancf.max_deflection", "10 mm") for text in texts}))
