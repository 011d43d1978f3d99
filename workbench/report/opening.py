"""The first screen of the report: three answers with their numbers, the models beside the wheel, what lies outside.

Verified by tests/unit/test_workbench_contents.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from contracts.records import Check
from workbench.questions.comparison import Comparison
from workbench.questions.models.agreement import Agreement
from workbench.report.answers import Answers, answers
from workbench.study.magnitudes import loosened, unusual
from workbench.study.model import Study
from workbench.verdict.number_format import displayed

__all__ = ["Opening", "Outside", "Rating", "check_groups", "counts", "opening", "verdict"]

_WORDS = {
    "no difference": "cannot be told apart",
    "agrees": "agrees",
    "differs": "differs",
    "undecided": "undecided: what is not known could tip it",
    "not known": "not judged: uncertainty not known",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Rating:
    """One curve of the study's reference beside the continuum: its name, what was found, the verdict in words."""

    name: str
    found: Agreement
    words: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Outside:
    """A check that did not pass, and the section that shows why."""

    check: Check
    section: str
    value: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Opening:
    """What the first screen shows, beside the main figure.

    Attributes
    ----------
    answers : whether the computation is sound, the wheel does its job, and which model may stand in for it
    verdict : what the gates say, and which of them the study has made easier
    warnings : what is unusual about the study
    counts : role, status, number
    ratings : the reference's curves beside the continuum
    outside : checks that did not pass, gates first
    """

    answers: Answers
    verdict: str
    warnings: Sequence[str]
    counts: Sequence[tuple[str, str, int]]
    ratings: Sequence[Rating]
    outside: Sequence[Outside]


def opening(study: Study, found: Comparison) -> Opening:
    """Choose it."""
    checks, judged = found.checks, found.agreements
    names = {f"user_{k}": user.label for k, user in enumerate(study.reference_curves)}
    ratings = [
        Rating(name=n, found=judged[k], words=_WORDS[judged[k].verdict]) for k, n in names.items() if k in judged
    ]
    bad = sorted((c for c in checks if c.status != "pass"), key=lambda c: c.role != "gate")
    return Opening(
        answers=answers(study, found),
        verdict=verdict(checks, loosened(study)),
        warnings=unusual(study),
        counts=counts(checks),
        ratings=ratings,
        outside=[
            Outside(check=c, section=found.question_of[c.id], value=displayed(c.value, c.unit, c.quantity)) for c in bad
        ],
    )


def verdict(checks: Sequence[Check], easier: Sequence[str] = ()) -> str:
    """What the gates say, how many findings lie outside or are unknown; then the limits that are ``easier`` to meet
    than the project's own, if any (`loosened`)."""
    if not easier:
        return _of_checks(checks)
    number = "1 tolerance is" if len(easier) == 1 else f"{len(easier)} tolerances are"
    return f"{_of_checks(checks)} {number} the study's own: {'; '.join(easier)}."


def _of_checks(checks: Sequence[Check]) -> str:
    gates = [c for c in checks if c.role == "gate"]
    findings = [c for c in checks if c.role == "finding"]
    bad = sum(c.status != "pass" for c in gates)
    outside = sum(c.status == "fail" for c in findings)
    unknown = sum(c.status in ("undecided", "error") for c in findings)
    first = f"All {len(gates)} gates passed" if not bad else f"{bad} of {len(gates)} gates did not pass"
    if not outside + unknown:
        return f"{first}; every finding lies inside its limits."
    second = f"{outside or 'no'} finding{'s' if outside > 1 else ''} outside {'their' if outside > 1 else 'its'} limits"
    return f"{first}; {second}{f', {unknown} undecided or not evaluated' if unknown else ''}."


def counts(checks: Sequence[Check]) -> list[tuple[str, str, int]]:
    """(role, status, number) in a fixed order, without empty ones."""
    pairs = [(r, s) for r in ("gate", "finding") for s in ("pass", "fail", "undecided", "error")]
    counted = [(r, s, sum(c.role == r and c.status == s for c in checks)) for r, s in pairs]
    return [row for row in counted if row[2]]


def check_groups(found: Comparison, titles: Mapping[str, str]) -> list[tuple[str, str, list[Check]]]:
    """Section, its title, its checks; in the order of the sections (name -> title)."""
    held: dict[str, list[Check]] = {}
    for check in found.checks:
        held.setdefault(found.question_of[check.id], []).append(check)
    return [(name, titles[name], held[name]) for name in titles if name in held]
