"""Question: how far the ANCF wheel is from the solid model all around, and on other wheels.

Answered from the records beside those wheels' studies (`workbench.questions.kept`); without one it is not asked.
Verified by tests/unit/test_workbench_ancf_wheels.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path

from contracts.records import Check
from workbench.questions.ancf_wheels.cases import ComparedWheel, compared_wheels, wheel_tasks
from workbench.questions.ancf_wheels.results import Agreement, agreement
from workbench.questions.kept import OF_ANOTHER, Kept, State, kept
from workbench.questions.question import Question
from workbench.study.model import Study
from workbench.verdict.rules import Claim, at_most, undecided

__all__ = ["ANCF_WHEELS", "HeldWheel"]

_TRAVEL_LIMIT = 0.05
"""Of a stiffness; ours [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HeldWheel:
    """A wheel with its record, whether that is about the wheel's study as it is, and what it says."""

    wheel: ComparedWheel
    record: Kept
    state: State
    agreement: Agreement


def _files(study: Study) -> list[tuple[ComparedWheel, Path]]:
    """Wheels whose study and record lie beside this study, and the studies' files."""
    if study.kept is None or not study.of_the_thesis:
        return []
    beside = [(wheel, study.kept.parent / wheel.study) for wheel in compared_wheels()]
    return [(w, path) for w, path in beside if path.is_file() and _record_file(w, path).is_file()]


def _record_file(wheel: ComparedWheel, path: Path) -> Path:
    return path.with_suffix(".kept") / f"{wheel.record}.json"


def _read(study: Study, folders: Mapping[str, Path]) -> Sequence[HeldWheel]:
    found = []
    for wheel, path in _files(study):
        of = wheel.read(path)
        record = kept(of, wheel.record, partial(agreement, wheel))
        if record is not None:
            state, says = record.state(wheel_tasks(wheel, of)), agreement(wheel, record.found)
            found.append(HeldWheel(wheel=wheel, record=record, state=state, agreement=says))
    return found


@lru_cache(maxsize=16)
def _readable(name: str, path: Path, changed: tuple[int, ...]) -> bool:
    """Whether a wheel has a record; InputError for one that cannot be read. ``changed``: of study and record [ns]."""
    (wheel,) = (one for one in compared_wheels() if one.name == name)
    return kept(wheel.read(path), wheel.record, partial(agreement, wheel)) is not None


def _asked(study: Study) -> bool:
    """A record that cannot be read is told here, before anything is computed."""
    found = False
    for wheel, path in _files(study):
        files = path, _record_file(wheel, path)
        found |= _readable(wheel.name, path, tuple(file.stat().st_mtime_ns for file in files))
    return found


def _checks(study: Study, results: Sequence[HeldWheel]) -> Sequence[Check]:
    loads = [_check(one, study.tolerances.ancf_wheel_largest) for one in results]
    return [*loads, *(_travel_check(one) for one in results if one.agreement.travel is not None)]


def _check(found: HeldWheel, limit: float) -> Check:
    """Load at every orientation."""
    claim = Claim(
        id=f"ancf_wheels.{found.wheel.name}",
        title=f"ANCF wheel against the solid model, {found.wheel.title}: load at any orientation",
        quantity="difference",
        unit="-",
        role="finding",
        source="our own solid model of the same design: code to code, no number fitted",
    )
    return _decided(found, at_most(claim, lambda: abs(found.agreement.largest), limit))


def _travel_check(found: HeldWheel) -> Check:
    """Forwards, sideways and turned, at every orientation asked."""
    claim = Claim(
        id=f"ancf_travel.{found.wheel.name}",
        title=f"ANCF wheel against the solid model, {found.wheel.title}: stiffness along the ground",
        quantity="difference",
        unit="-",
        role="finding",
        source="our own solid model of the same design: code to code, no number fitted",
    )
    return _decided(found, at_most(claim, lambda: abs(found.agreement.travel or 0.0), _TRAVEL_LIMIT))


def _decided(found: HeldWheel, check: Check) -> Check:
    """Undecided where the record is about another study of that wheel, or a run of it ended early."""
    why = OF_ANOTHER if found.state == "stale" else "a run ended early"
    if found.state != "stale" and not found.agreement.partial:
        return check
    return undecided(check, why)


ANCF_WHEELS = Question(
    name="ancf_wheels",
    title="ANCF on other wheels",
    group="Wheel",
    read=_read,
    checks=_checks,
    applies=_asked,
)
