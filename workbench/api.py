"""The workbench from Python: read a study, compute its curves, open a finished report.

The same store, tasks and keys as the command line: what one has computed the other reuses. Works in scripts (no
``if __name__ == "__main__"`` needed), notebooks and ``python -c``; progress goes to the logger ``workbench``. Only
what is called is loaded: PETSc, gmsh and VTK in worker processes, matplotlib and pandas by the methods that need them.

Verified by tests/unit/test_workbench_api.py and tests/end_to_end/test_python.py.
"""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Mapping
from numbers import Real
from pathlib import Path

from contracts.errors import ConvergenceError, IncrementRecord, InputError, StudyError
from workbench.api_results import Curve, Report, Series, curve_of, report_in
from workbench.study.model import Study

__all__ = ["Curve", "Report", "Series", "Study", "read_report", "read_study", "stiffness"]


def read_study(path: str | os.PathLike[str] | None = None) -> Study:
    """Read and check a study file (TOML); without a path, the built-in ExoMars study.

    All numbers of the `Study` are SI, angles in radians. What is unusual about it is warned of (`UserWarning`).

    Raises
    ------
    InputError
        For the first defect found, in one line: file, key, value, rule, what to try. The `StudyError` behind it has
        them as attributes.
    """
    from workbench.study.magnitudes import of_the_file
    from workbench.study.reading import built_in_study
    from workbench.study.reading import read_study as read

    file = built_in_study() if path is None else _path(path, "study file")
    try:
        study = read(file)
    except StudyError as error:
        what = f"{error.path}: {error.key}" if error.key else error.path
        raise InputError(what, error.value if error.key else "", error.rule, error.hint) from error
    for warning in of_the_file(study):
        warnings.warn(f"{file}: {warning}", stacklevel=2)
    return study


def stiffness(
    study: Study,
    model: str = "fe",
    orientation: float | None = None,
    *,
    store: str | os.PathLike[str] | None = None,
    workers: int | None = None,
) -> Curve:
    """Load of the wheel against its radial deflection, by one model.

    Parameters
    ----------
    study : what `read_study` returned
    model : ``"fe"`` (solid finite elements), ``"section"`` (planar ones), ``"ancf_wheel"`` (the wheel itself as
        thin ANCF plates), ``"ancf"`` (the reduced tire) or ``"brush"``
    orientation : what faces the ground, from the lowest point towards the front [deg], any finite number; None is the
        average over the study's orientations of this model. The brush is the same at every orientation
    store : folder where results are kept and found again; ``$WORKBENCH_STORE`` or ``build/store`` if left out
    workers : tasks that run at once; as the command line if left out

    Returns
    -------
    curve : deflection [m] from first touch (ANCF: from the nominal radius), load [N] of the whole wheel, ground on
        wheel, positive in compression; its ``orientation_deg`` lies within 0 and 360

    Raises
    ------
    InputError
        If the model is unknown or the wheel has none of this kind, the orientation is no finite number, or the store
        cannot be used.
    ConvergenceError
        If a solve ended before its target: ``last_good`` is the partial `Curve`, ``history`` its increments.
    workbench.execution.errors.RunError
        If a task failed otherwise, or Ctrl-C ended the run; finished results are kept.
    """
    from workbench.commands.options import DEFAULT_STORE, computing
    from workbench.execution.logged import Logged
    from workbench.execution.result_files import early_ends
    from workbench.execution.runner import run_tasks
    from workbench.execution.store import Store
    from workbench.questions.curve_graph import MODELS, stiffness_tasks
    from workbench.questions.models.curves import stiffness_curves
    from workbench.study.strengths import yield_strengths

    if not isinstance(study, Study):
        raise InputError("study", repr(study), "is no study", "give what read_study returns")
    if model not in MODELS:
        raise InputError("model", repr(model), "is not known", f"give one of {', '.join(MODELS)}")
    if workers is not None and not (isinstance(workers, int) and not isinstance(workers, bool) and workers >= 1):
        raise InputError("workers", repr(workers), "must be a whole number, at least 1", "leave it out, or give 2")
    angles = () if orientation is None else (_turned(orientation),)
    place = os.environ.get("WORKBENCH_STORE") or DEFAULT_STORE if store is None else store
    tasks = stiffness_tasks(study, model, angles)
    results = Store(_path(place, "result store"), study=study.name)
    entries = run_tasks(tasks, results, Logged(), computing(workers, 1, None))

    folders = {name: entry.path for name, entry in entries.items()}
    found = stiffness_curves(study, model, folders)
    one = found[0] if angles else found[-1]
    snapshots = {} if one.orientation_deg is None else _fields(folders[tasks[-1].name])
    curve = curve_of(one, fields=snapshots, yield_strength=yield_strengths(study))
    if early := early_ends(folders):
        text = "; ".join(f"{name} did not converge: {reason}" for name, reason in early.items())
        raise ConvergenceError(text, _increments(folders[next(iter(early))]), last_good=curve)
    return curve


def read_report(folder: str | os.PathLike[str]) -> Report:
    """A finished report, from the folder that ``workbench report --out`` wrote; nothing is computed.

    Raises
    ------
    InputError
        If there is no such folder, it holds no report, or one of its files cannot be used.
    """
    return report_in(_path(folder, "report folder"))


def _path(given: object, what: str) -> Path:
    try:
        return Path(given)  # type: ignore[arg-type]
    except TypeError:
        raise InputError(what, repr(given), "is no path", "give a text such as 'studies/first.toml'") from None


def _turned(orientation: object) -> float:
    """The orientation within one turn [deg]."""
    try:
        angle = float(orientation) if isinstance(orientation, Real) and not isinstance(orientation, bool) else math.nan
    except OverflowError:
        angle = math.inf
    if not math.isfinite(angle):
        raise InputError("orientation", repr(orientation), "must be a finite number", "give degrees such as 15")
    return round(angle % 360.0, 9) % 360.0


def _fields(folder: Path) -> Mapping[float, Path]:
    """Files of a task by their load [N]."""
    found = {float(p.stem.removeprefix("fields_")[:-1]): p.absolute() for p in folder.glob("fields_*N.vtu")}
    return dict(sorted(found.items()))


def _increments(folder: Path) -> list[IncrementRecord]:
    from workbench.execution.result_files import increments_of, read_result

    return list(increments_of(read_result(folder)))
