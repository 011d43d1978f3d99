"""Where each check comes from: the tasks behind it with the keys of their results, and the files that show it.

Links follow from the task graph: a check rests on the tasks of its question, unless the words of its family, or its own
identifier, name others. Verified by tests/unit/test_workbench_evidence.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

from contracts.records import Check
from workbench.questions.comparison import Comparison
from workbench.questions.registry import questions_of
from workbench.study.model import Study
from workbench.verdict.statements import Statement, statement_of

__all__ = ["Evidence", "evidence_of"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Evidence:
    """A check with its links.

    Attributes
    ----------
    check : the check
    section : section of the page that shows it, that of its question
    tasks : task -> key under which its result is stored: the hash of everything it depends on
    files : curves and series in the report's folder, e.g. ``"curves/fe_phi000.csv"``
    """

    check: Check
    section: str
    tasks: Mapping[str, str]
    files: tuple[str, ...]


def evidence_of(study: Study, found: Comparison, keys: Mapping[str, str], files: Sequence[str]) -> tuple[Evidence, ...]:
    """Every check with its links, in the order of the checks.

    Parameters
    ----------
    study : decides the questions and their tasks
    found : the checks, and which question made each
    keys : task -> key of its result, of the whole graph
    files : what the report publishes
    """
    own = {question.name: [task.name for task in question.tasks(study)] for question in questions_of(study)}
    return tuple(
        _evidence(check, name, own[name], keys, files)
        for check in found.checks
        if (name := found.question_of[check.id])
    )


def _evidence(
    check: Check, section: str, own: Sequence[str], keys: Mapping[str, str], files: Sequence[str]
) -> Evidence:
    words = statement_of(check.id, check.quantity, check.title)
    return Evidence(
        check=check,
        section=section,
        tasks={name: keys[name] for name in _tasks(check.id, words, own, keys)},
        files=tuple(name for name in files if any(fnmatchcase(name, pattern) for pattern in words.files)),
    )


def _tasks(id: str, words: Statement, own: Sequence[str], keys: Mapping[str, str]) -> list[str]:
    """Those the words name; else the question's task whose name begins the identifier; else all of the question's."""
    if words.tasks:
        return [name for name in keys if any(fnmatchcase(name, pattern) for pattern in words.tasks)]
    flat = f"{id.replace('.', '_')}_"
    begun = [name for name in own if flat.startswith(f"{name}_")]
    return [max(begun, key=len)] if begun else list(own)
