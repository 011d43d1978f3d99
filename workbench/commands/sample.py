"""``workbench sample``: every sample of a study's [input_uncertainty], kept beside the study for its report.

Verified by tests/end_to_end/test_sample.py.
"""

from __future__ import annotations

import shlex
import time
from collections.abc import Sequence
from pathlib import Path

from contracts.errors import StudyError
from workbench.commands.computing import console, naming, warn
from workbench.execution.progress import RunDisplay
from workbench.execution.runner import Computing, run_all
from workbench.execution.store import Store
from workbench.questions.input_uncertainty.keeping import found_of
from workbench.questions.input_uncertainty.samples import RECORD, record_task, require_inputs
from workbench.questions.kept import keep, require_place
from workbench.questions.section.graph import without_planar_model
from workbench.questions.sweep.graph import sweep_graph
from workbench.questions.sweep.results import Outcome, outcomes
from workbench.study.input_points import input_points
from workbench.study.input_uncertainty import InputUncertaintySection
from workbench.study.magnitudes import of_the_file
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study_table, study_of

__all__ = ["run_sample"]


def run_sample(study_path: Path | None, store: Path, computing: Computing) -> int:
    """Run the samples, goes on where it stopped; 0 also where some of them have no curve: the record says how many."""
    path = study_path or built_in_study()
    content = read_study_table(path)
    study = study_of(path, content)
    warn(path, of_the_file(study))
    section = _stated(path, study)
    require_inputs(path, content, section)
    require_place(study, RECORD)
    console.print(f"reading {section.samples} samples, each as a whole study")
    points = input_points(path, content, section)
    graph = sweep_graph(points, ("section",))
    console.print(f"{section.samples} samples of {len(section.inputs)} inputs: {len(graph.tasks)} curves")
    begun = time.monotonic()
    with naming(path), RunDisplay(console, graph.tasks) as display:
        ended = run_all(graph.tasks, Store(store, study=path.stem), display, computing)
    found = outcomes(graph, ended.entries, ended.failures)
    elapsed = max(time.monotonic() - begun, _seconds(found) / (computing.workers or 1))
    with naming(path):
        record = found_of(study, section, found)
    again = "make sample" if study_path is None else f"workbench sample {shlex.quote(str(path))}"
    kept = keep(study, RECORD, again, [record_task(study, section)], elapsed, record)
    failed = sum(one.curve is None for one in found)
    console.print(
        f"{section.samples} samples, {failed} without a curve, {record['early']} that end early: {kept}", soft_wrap=True
    )
    return 0


def _stated(path: Path, study: Study) -> InputUncertaintySection:
    """The section; StudyError where there is none, or the wheel has no planar model."""
    if study.input_uncertainty is None:
        rule = "is missing: it says what is not exactly known"
        raise StudyError(path, RECORD, "", rule, "copy it from studies/exomars.toml")
    if (reason := without_planar_model(study)) is not None:
        raise StudyError(path, reason.what, reason.value, reason.rule, "samples are run by the section model alone")
    return study.input_uncertainty


def _seconds(found: Sequence[Outcome]) -> float:
    """Wall time of all curves, those that an earlier run computed included [s]."""
    return sum(one.wall_s or 0.0 for one in found)
