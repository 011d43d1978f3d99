"""What commands share: a study's tasks computed with a display, and whose failure it was.

Verified by tests/unit/test_workbench_commands.py and tests/end_to_end/test_commands.py.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from contracts.errors import InputError, MemoryLimitError, StudyError
from workbench.commands.ending import of_bearable_length
from workbench.execution.errors import InterruptedRunError, RunError
from workbench.execution.progress import RunDisplay
from workbench.execution.runner import Computing, run_tasks
from workbench.execution.store import Entry, Store
from workbench.execution.task import Task
from workbench.execution.terminal import Terminal, console
from workbench.study.magnitudes import of_the_file
from workbench.study.model import Study
from workbench.study.reading import read_study_table, study_of

__all__ = ["complain_of_early_ends", "computed", "console", "naming", "read_and_warn", "shortest", "tell_kept", "warn"]


def read_and_warn(path: Path, changed: Callable[[Mapping[str, Any]], Mapping[str, Any]] = dict) -> Study:
    """The study of a file, as `read_study`; what is unusual about it goes to stderr.

    changed : what becomes of the file's table before it is checked
    """
    study = study_of(path, changed(read_study_table(path)))
    warn(path, of_the_file(study))
    return study


def shortest(value: float) -> str:
    """The fewest digits that are read as this very number."""
    return repr(float(value)).removesuffix(".0")


def warn(path: Path, warnings: Sequence[str]) -> None:
    """One line on stderr for each warning about a file."""
    for warning in warnings:
        sys.stderr.write(f"workbench: warning: {of_bearable_length(f'{path}: {warning}')}\n")


def computed(
    study_path: Path, tasks: Sequence[Task], store: Path, computing: Computing, shown_on: Terminal = console
) -> dict[str, Entry]:
    """Run a study's graph with a display; entries in the order of the graph."""
    results = Store(store, study=study_path.stem)
    with naming(study_path), RunDisplay(shown_on, tasks) as display:
        entries = run_tasks(tasks, results, display, computing)
    shown_on.print(f"{len(tasks) - display.reused} tasks computed, {display.reused} reused")
    return {task.name: entries[task.name] for task in tasks}


@contextmanager
def naming(study_path: Path) -> Iterator[None]:
    """Put the study's path in front of what a task of it complains of."""
    try:
        yield
    except (StudyError, InterruptedRunError):
        raise
    except (InputError, MemoryLimitError, RunError) as error:
        raise RunError(f"{study_path}: {error}") from error


def complain_of_early_ends(path: Path, reasons: Mapping[str, str]) -> None:
    """Everything is written; now say, as the run's one error, which curves are partial and why."""
    if reasons:
        told = "; ".join(f"{task} did not converge, its curve is partial: {why}" for task, why in reasons.items())
        raise RunError(f"{path}: {told}")


def tell_kept(sentences: Sequence[str], shown_on: Terminal = console) -> None:
    """Say what was kept aside in the user's folder, a line each."""
    for sentence in sentences:
        shown_on.print(sentence, soft_wrap=True)
