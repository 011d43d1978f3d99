"""What each command does, once the command line is parsed; returns the exit status.

Verified by tests/end_to_end.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.table import Table

from contracts.curves import StiffnessCurve, read_curve
from contracts.errors import InputError, StudyError
from contracts.records import Check
from workbench.errors import InterruptedRunError, RunError
from workbench.full_study import full_study
from workbench.graph import mesh_tasks, report_tasks, stiffness_tasks
from workbench.outputs import check_folder, copy_files, junit, publish, summary, to_json
from workbench.progress import RunDisplay
from workbench.result_files import early_ends
from workbench.results import mean_curve
from workbench.runner import Computing, run_tasks
from workbench.store import Entry, Store
from workbench.study_file import built_in_study, read_study
from workbench.task import Task

__all__ = ["check_orientation", "naming", "run_compare", "run_doctor", "run_mesh", "run_report", "run_stiffness"]

console = Console()
_MODELS = ("fe", "section", "ancf", "brush")


def run_report(study_path: Path | None, out: Path, store: Path, computing: Computing, *, full: bool = False) -> int:
    """Everything a study asks for, or its full study, then the report."""
    path = study_path or built_in_study()
    study = read_study(path)
    if full:
        with naming(path):
            study = full_study(study)
    check_folder(out)
    entries = _compute(path, report_tasks(study, path.parent), store, computing)

    from workbench.comparison import compare, exit_status
    from workbench.provenance import provenance
    from workbench.report import PageContent, render
    from workbench.results import task_timings
    from workbench.topics import topics_of

    with naming(path):
        found = compare(study, {name: entry.path for name, entry in entries.items()})
    timings, origin = task_timings(entries), provenance(path, entries)
    content = PageContent(
        study=study, found=found, pictures=entries["pictures"].path, timings=timings, provenance=origin
    )
    texts = {
        "report.html": render(content),
        "junit.xml": junit(study.name, found.checks),
        "summary.json": to_json(summary(study.name, found.checks, timings, origin)),
    }
    curves = [*found.fe.by_orientation.values(), found.fe.average]
    curves += [*found.ancf.by_orientation.values(), found.ancf.average, found.brush]
    curves += [curve for topic in topics_of(study) for curve in topic.curves(study, found.topics[topic.name])]
    series = [one for topic in topics_of(study) for one in topic.series(study, found.topics[topic.name])]
    publish(out, texts, curves, _field_files(entries), series)
    _print_checks(found.checks)
    console.print(f"report: {out / 'report.html'}", highlight=False, markup=False, soft_wrap=True)
    _complain_of_early_ends(path, origin["partial"])
    return exit_status(found.checks)


def _field_files(entries: dict[str, Entry]) -> dict[str, Path]:
    """``fe_phi000_200N.vtu`` -> the file in the store."""
    found = [(name, path) for name, entry in entries.items() for path in sorted(entry.path.glob("fields_*N.vtu"))]
    return {f"{name}_{path.name.removeprefix('fields_')}": path for name, path in found}


def run_mesh(study_path: Path, out: Path, store: Path) -> int:
    """Mesh files, summary and picture of a study's wheel."""
    study = read_study(study_path)
    check_folder(out)
    entries = _compute(study_path, mesh_tasks(study, with_files=True), store, Computing(workers=1))
    files = entries["mesh_files"]
    for path in copy_files(files.path, sorted(files.manifest["files"]), out):
        console.print(str(path), highlight=False, markup=False, soft_wrap=True)
    return 0


def run_stiffness(
    study_path: Path, model: str, orientations: tuple[float, ...], out: Path, store: Path, computing: Computing
) -> int:
    """Curves of one model at the orientations asked for."""
    if model not in _MODELS:
        raise InputError("model", model, "is not known", f"give one of {', '.join(_MODELS)}")
    for orientation in orientations:
        check_orientation(orientation)
    study = read_study(study_path)
    check_folder(out)
    tasks = stiffness_tasks(study, model, tuple(dict.fromkeys(orientations)))
    entries = _compute(study_path, tasks, store, computing)
    with naming(study_path):
        curves = _curves(model, entries)
    publish(out, {}, curves)
    for curve in curves:
        label = "average" if curve.orientation_deg is None else f"{curve.orientation_deg:g} deg"
        reach = f"{curve.deflection[-1] * 1e3:.1f} mm at {curve.load[-1]:.1f} N"
        reach = "no point converged" if curve.unloaded else reach
        part = " (partial)" if curve.partial else ""
        console.print(f"{model} {label}: {reach}{part}", highlight=False, markup=False)
    console.print(f"curves: {out / 'curves'}", highlight=False, markup=False, soft_wrap=True)
    _complain_of_early_ends(study_path, early_ends({name: entry.path for name, entry in entries.items()}))
    return 0


def check_orientation(orientation: float) -> None:
    """Raise InputError for an orientation [deg] that is not one of a turn."""
    if not (math.isfinite(orientation) and 0.0 <= orientation < 360.0):
        rule = "must be finite, at least 0 and less than 360"
        raise InputError("orientation", f"{orientation} deg", rule, "give degrees such as 15")


def _curves(model: str, entries: dict[str, Entry]) -> list[StiffnessCurve]:
    if model == "brush":
        return [read_curve(entries["brush"].path / "curve.csv", model="brush")]
    found = []
    for name, entry in entries.items():
        if name.startswith(f"{model}_phi"):
            orientation = float(name.removeprefix(f"{model}_phi"))
            found.append(read_curve(entry.path / "curve.csv", model=model, orientation_deg=orientation))
    return [*found, mean_curve(found)]


def _complain_of_early_ends(path: Path, reasons: Mapping[str, str]) -> None:
    """Everything is written; now say, as the run's one error, which curves are partial and why."""
    if reasons:
        told = "; ".join(f"{task} did not converge, its curve is partial: {why}" for task, why in reasons.items())
        raise RunError(f"{path}: {told}")


def run_compare(curve_path: Path, reference_path: Path, max_load: float | None) -> int:
    """Print how far one curve lies from another."""
    from workbench.metrics import compare_curves

    if max_load is not None and not (math.isfinite(max_load) and max_load > 0.0):
        raise InputError("max load", f"{max_load} N", "must be finite and > 0", "give newtons such as 250")
    metrics = compare_curves(read_curve(curve_path), read_curve(reference_path), max_load)
    table = Table(title=f"{curve_path.name} against {reference_path.name}", title_justify="left")
    table.add_column("quantity")
    table.add_column("value", justify="right")
    for name, text in (
        ("range of deflection", f"{metrics.start * 1e3:.3f} .. {metrics.end * 1e3:.3f} mm"),
        ("relative L2 difference", f"{100.0 * metrics.relative_l2:.3f} %"),
        ("largest difference", f"{metrics.max_error:.3f} N at {metrics.max_error_at * 1e3:.2f} mm"),
        ("mean slope", f"{metrics.tangent * 1e-3:.4f} N/mm"),
        ("mean slope of the reference", f"{metrics.tangent_reference * 1e-3:.4f} N/mm"),
        ("ISO/TS 18571 rating", "not defined" if metrics.iso_rating is None else f"{metrics.iso_rating:.4f}"),
    ):
        table.add_row(name, text)
    console.print(table)
    return 0


def run_doctor() -> int:
    """Show what is installed; 2 if something is missing."""
    from workbench.doctor import examine

    findings = examine()
    table = Table(title="workbench doctor", title_justify="left")
    for column in ("name", "found", "needed for", "advice"):
        table.add_column(column, overflow="fold")
    for finding in findings:
        table.add_row(finding.name, finding.found, finding.purpose, finding.advice or "ok")
    console.print(table)
    return 2 if any(f.advice for f in findings) else 0


@contextmanager
def naming(study_path: Path) -> Iterator[None]:
    """Put the study's path in front of what a task of it complains of."""
    try:
        yield
    except (StudyError, InterruptedRunError):
        raise
    except (InputError, RunError) as error:
        raise RunError(f"{study_path}: {error}") from error


def _compute(study_path: Path, tasks: Sequence[Task], store: Path, computing: Computing) -> dict[str, Entry]:
    """Run a study's graph with a display; entries in the order of the graph."""
    results = Store(store)
    with naming(study_path), RunDisplay(console, len(tasks)) as display:
        entries = run_tasks(tasks, results, display, computing)
    console.print(
        f"{len(tasks) - display.reused} tasks computed, {display.reused} reused", highlight=False, markup=False
    )
    return {task.name: entries[task.name] for task in tasks}


def _print_checks(checks: Sequence[Check]) -> None:
    from workbench.number_format import displayed

    table = Table(title="checks", title_justify="left")
    for column in ("status", "role", "check", "value", "tolerance"):
        table.add_column(column, overflow="fold")
    colours = {"pass": "green", "fail": "red", "error": "yellow"}
    for c in checks:
        status = f"[{colours[c.status]}]{c.status}[/]"
        table.add_row(status, c.role, c.title, displayed(c.value, c.unit, c.quantity), c.tolerance)
    console.print(table)
