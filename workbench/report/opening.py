"""The first screen of the report: who agrees with the continuum, by how much, how surely, and what lies outside.

Verified by tests/unit/test_workbench_contents.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from contracts.records import Check
from workbench.questions.comparison import Comparison
from workbench.questions.models.agreement import Agreement
from workbench.study.magnitudes import loosened, unusual
from workbench.study.model import Study
from workbench.verdict.number_format import displayed

__all__ = ["Opening", "Outside", "Rating", "check_groups", "counts", "opening", "verdict"]

_WORDS = {
    "no difference": "cannot be told apart",
    "agrees": "agrees",
    "differs": "differs",
    "undecided": "undecided: the mesh could tip it",
    "not known": "not judged: uncertainty not known",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Rating:
    """One model beside the continuum: its name, what was found, the verdict in words, and the drawing's numbers."""

    name: str
    found: Agreement
    words: str

    @property
    def tone(self) -> str:
        """Class of the colour."""
        tones = {"agrees": "pass", "no difference": "pass", "differs": "fail"}
        return tones.get(self.found.verdict, "error")

    @property
    def full(self) -> float:
        """Right end of the drawn scale [-]."""
        return max(1.6 * self.found.limit, 1.15 * (self.found.distance + (self.found.uncertainty or 0.0)))

    def at(self, value: float) -> float:
        """Place on the drawn scale [%]."""
        return 100.0 * min(max(value / self.full, 0.0), 1.0)


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
    verdict : what the gates say, and which of them the study has made easier
    warnings : what is unusual about the study
    counts : role, status, number
    ratings : models beside the continuum
    band : checks of the reference band
    outside : checks that did not pass, gates first
    """

    verdict: str
    warnings: Sequence[str]
    counts: Sequence[tuple[str, str, int]]
    ratings: Sequence[Rating]
    band: Sequence[Check]
    outside: Sequence[Outside]


def opening(study: Study, found: Comparison) -> Opening:
    """Choose it."""
    checks, judged = found.checks, found.agreements
    names = {"ancf_average": "ANCF tire", "brush": "Brush tire"}
    names |= {f"user_{k}": user.label for k, user in enumerate(study.compare.curves)}
    ratings = [
        Rating(name=n, found=judged[k], words=_WORDS[judged[k].verdict]) for k, n in names.items() if k in judged
    ]
    bad = sorted((c for c in checks if c.status != "pass"), key=lambda c: c.role != "gate")
    return Opening(
        verdict=verdict(checks, loosened(study)),
        warnings=unusual(study),
        counts=counts(checks),
        ratings=ratings,
        band=[c for c in checks if c.id == "fe.initial_tangent" or c.id.startswith("fe.deflection_at_")],
        outside=[
            Outside(check=c, section=found.question_of[c.id], value=displayed(c.value, c.unit, c.quantity)) for c in bad
        ],
    )


def verdict(checks: Sequence[Check], easier: Sequence[str] = ()) -> str:
    """What the gates say, how many findings lie outside or are unknown; then the gates that are ``easier`` to pass
    than the project's own, if any (`loosened`)."""
    if not easier:
        return _of_checks(checks)
    number = "1 gate tolerance is" if len(easier) == 1 else f"{len(easier)} gate tolerances are"
    return f"{_of_checks(checks)} {number} the study's own: {'; '.join(easier)}."


def _of_checks(checks: Sequence[Check]) -> str:
    gates = [c for c in checks if c.role == "gate"]
    findings = [c for c in checks if c.role == "finding"]
    bad = sum(c.status != "pass" for c in gates)
    outside, unknown = (sum(c.status == s for c in findings) for s in ("fail", "error"))
    first = f"All {len(gates)} gates passed" if not bad else f"{bad} of {len(gates)} gates did not pass"
    if not outside + unknown:
        return f"{first}; every finding lies inside its limits."
    second = f"{outside or 'no'} finding{'s' if outside > 1 else ''} outside {'their' if outside > 1 else 'its'} limits"
    return f"{first}; {second}{f', {unknown} not evaluated' if unknown else ''}."


def counts(checks: Sequence[Check]) -> list[tuple[str, str, int]]:
    """(role, status, number) in a fixed order, without empty ones."""
    pairs = [(r, s) for r in ("gate", "finding") for s in ("pass", "fail", "error")]
    counted = [(r, s, sum(c.role == r and c.status == s for c in checks)) for r, s in pairs]
    return [row for row in counted if row[2]]


def check_groups(found: Comparison, titles: Mapping[str, str]) -> list[tuple[str, str, list[Check]]]:
    """Section, its title, its checks; in the order of the sections (name -> title)."""
    held: dict[str, list[Check]] = {}
    for check in found.checks:
        held.setdefault(found.question_of[check.id], []).append(check)
    return [(name, titles[name], held[name]) for name in titles if name in held]
