"""``workbench report``: everything a study asks for, compared, and written as a page and its files.

Verified by tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from rich.text import Text

from contracts.records import Check
from workbench.commands.computing import complain_of_early_ends, computed, console, naming, read_and_warn, tell_kept
from workbench.commands.gate import GateChoices, gate_of, plain_console, tell
from workbench.execution.integrity import stated
from workbench.execution.runner import Computing
from workbench.execution.store import Entry
from workbench.execution.task import Task, task_keys
from workbench.execution.terminal import empty_table
from workbench.questions.study_graph import report_tasks
from workbench.report.folders import check_folder, check_targets
from workbench.report.gate_summary import gate_markdown, gate_rows
from workbench.report.outputs import (
    beside_fields,
    curve_file,
    curve_links,
    field_files,
    junit,
    publish,
    summary,
    to_json,
)
from workbench.report.series import MOTIONS_FOLDER, SERIES_FOLDER
from workbench.study.full import full_study
from workbench.study.magnitudes import loosened, warnings_of
from workbench.study.reading import built_in_study
from workbench.verdict.baseline import read_baseline

__all__ = ["ReportChoices", "run_report"]

_TEXTS = ("report.pdf", "evidence.html", "report.html", "junit.xml", "summary.md", "summary.json")


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportChoices:
    """What the command line asks for: the full study, what would be computed and nothing more, the report as a gate,
    and whether a wheel that does not do its job makes the exit status 1."""

    full: bool = False
    require_wheel: bool = False
    dry_run: bool = False
    gate: GateChoices = field(default_factory=GateChoices)


def run_report(
    study_path: Path | None, out: Path, store: Path, computing: Computing, choices: ReportChoices | None = None
) -> int:
    """Everything a study asks for, or its full study, then the report."""
    path, choices = study_path or built_in_study(), choices or ReportChoices()
    study = read_and_warn(path)
    if choices.full:
        with naming(path):
            study = full_study(study)
    if choices.dry_run:
        return _list_tasks(report_tasks(study), store)
    check_folder(out)
    check_targets(out, (*_TEXTS, *(f"{folder}/any" for folder in ("curves", "fields", MOTIONS_FOLDER, SERIES_FOLDER))))
    accepted = None if choices.gate.baseline is None else read_baseline(choices.gate.baseline, study.name)
    shown_on = plain_console() if choices.gate.ci else console
    entries = computed(path, report_tasks(study), store, computing, shown_on)

    from workbench.questions.comparison import compare
    from workbench.report.answers import answers
    from workbench.report.contents import EVIDENCE, REPORT
    from workbench.report.evidence import evidence_of
    from workbench.report.opening import verdict
    from workbench.report.page import PageContent, render, rendered_sections
    from workbench.report.pdf import document_pdf
    from workbench.report.provenance import provenance, task_timings
    from workbench.report.series import series_files
    from workbench.verdict.status import exit_status

    with naming(path):
        folders = {name: entry.path for name, entry in entries.items()}
        found = compare(study, folders)
    timings, origin = task_timings(entries), provenance(path, entries)
    named = [f"curves/{curve_file(curve)}" for curve in found.curves]
    named += [f"series/{name}" for name in series_files(found.series)]
    evidence = evidence_of(study, found, origin["tasks"], named)
    content = PageContent(
        study=study,
        found=found,
        timings=timings,
        provenance=origin,
        evidence=evidence,
        curves=curve_links(found.curves),
    )
    told = answers(study, found)
    copies = field_files(entries) | _motion_files(entries)
    gate = gate_of(study.name, verdict(found.checks, loosened(study)), found.checks, accepted)
    page = rendered_sections(content)
    texts: dict[str, str | bytes] = {
        **beside_fields(study, copies),
        "report.pdf": document_pdf(page),
        "evidence.html": render(page, EVIDENCE),
        "report.html": render(page, REPORT),
        "junit.xml": junit(study.name, found.checks, gate.given_up),
        "summary.md": gate_markdown(gate),
        "summary.json": to_json(
            summary(study.name, evidence, timings, origin, told.summary)
            | {"warnings": warnings_of(study)}
            | gate_rows(gate)
        ),
    }
    tell_kept(publish(out, "report", texts, found.curves, found.series, copies), shown_on)
    if choices.gate.ci:
        tell(gate, shown_on)
    else:
        _print_checks(found.checks)
        shown_on.print(gate.verdict_now, soft_wrap=True)
    for one in (told.computation, told.wheel, told.stand_in):
        shown_on.print(f"{one.question} {one.decision}: {one.sentence}", soft_wrap=True)
    shown_on.print(f"report: {out / 'report.html'}", soft_wrap=True)
    complain_of_early_ends(path, origin["partial"])
    unfit = choices.require_wheel and told.wheel.decision != "yes"
    return exit_status(found.checks) or int(not gate.holds or unfit)


def _list_tasks(tasks: Sequence[Task], store: Path) -> int:
    """One line a task: whether its result is there, its name, its key. Nothing is made, computed or read in full."""
    for name, key in task_keys(tuple(tasks)).items():
        absent = stated(store / key[:2] / key, key)[1]
        console.print(f"{'compute' if absent else 'reuse':7} {name} {key}", soft_wrap=True)
    return 0


def _motion_files(entries: dict[str, Entry]) -> dict[str, Path]:
    """``motions/straight_brush.npz`` -> the file in the store of the task ``rover_straight``."""
    found = {}
    for name, entry in entries.items():
        scenario, path = name.removeprefix("rover_"), entry.path / "motion.npz"
        if path.exists():
            ancf = scenario.startswith("ancf_")
            found[f"{MOTIONS_FOLDER}/{scenario.removeprefix('ancf_')}_{'ancf' if ancf else 'brush'}.npz"] = path
    return found


def _print_checks(checks: Sequence[Check]) -> None:
    from workbench.verdict.number_format import displayed

    columns = ("status", "role", "check", "value", "tolerance")
    table = empty_table("checks", columns, texts=columns, folded=columns)
    colours = {"pass": "green", "fail": "red", "undecided": "yellow", "error": "yellow"}
    for c in checks:
        table.add_row(
            Text(c.status, style=colours[c.status]),
            c.role,
            c.title,
            displayed(c.value, c.unit, c.quantity),
            c.tolerance,
        )
    console.print(table)
