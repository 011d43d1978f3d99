"""Question: whether the continuum model finds what others published of their wheels, as far as both are known.

Answered from the records beside those wheels' studies (`workbench.questions.kept`); without one it is not asked.
Verified by tests/unit/test_workbench_validation.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from contracts.records import Check
from workbench.questions.kept import OF_ANOTHER, Kept, State, kept
from workbench.questions.question import Question
from workbench.questions.validation.cases import NAME, PublishedWheel, published_wheels, wheel_tasks
from workbench.questions.validation.uncertainty import Comparison, InputEffect, comparisons, input_effects
from workbench.study.model import Study
from workbench.study.reading import read_study
from workbench.verdict.rules import Claim, at_most, undecided

__all__ = ["VALIDATION", "ValidatedWheel", "Validation"]


@dataclass(frozen=True, slots=True, kw_only=True)
class ValidatedWheel:
    """A published wheel with its record, whether that is about the wheel's study as it is, and what it says."""

    wheel: PublishedWheel
    record: Kept
    state: State
    comparisons: tuple[Comparison, ...]
    effects: tuple[InputEffect, ...]

    @property
    def worst(self) -> Comparison:
        """The load whose error stands furthest out of what is not known."""
        return max(self.comparisons, key=lambda one: one.ratio)


@dataclass(frozen=True, slots=True, kw_only=True)
class Validation:
    """Every wheel that has a record."""

    wheels: tuple[ValidatedWheel, ...]


def _files(study: Study) -> list[tuple[PublishedWheel, Path]]:
    """Wheels whose study and record lie beside this study, and the studies' files."""
    if study.kept is None:
        return []
    beside = [(wheel, study.kept.parent / wheel.study) for wheel in published_wheels()]
    return [
        (w, path) for w, path in beside if path.is_file() and (path.with_suffix(".kept") / f"{NAME}.json").is_file()
    ]


def _read(study: Study, folders: Mapping[str, Path]) -> Validation:
    found = []
    for wheel, path in _files(study):
        record = _record(wheel, path)
        if record is not None:
            found.append(
                ValidatedWheel(
                    wheel=wheel,
                    record=record,
                    state=record.state(wheel_tasks(wheel, path)),
                    comparisons=comparisons(wheel, record.found),
                    effects=input_effects(wheel, record.found),
                )
            )
    return Validation(wheels=tuple(found))


def _record(wheel: PublishedWheel, path: Path) -> Kept | None:
    """The record of a wheel, read to its end."""
    return kept(read_study(path), NAME, lambda found: (comparisons(wheel, found), input_effects(wheel, found)))


@lru_cache(maxsize=16)
def _readable(name: str, path: Path, changed: tuple[int, ...]) -> bool:
    """Whether a wheel has a record; InputError for one that cannot be read. ``changed``: of study and record [ns]."""
    (wheel,) = (one for one in published_wheels() if one.name == name)
    return _record(wheel, path) is not None


def _asked(study: Study) -> bool:
    """A record that cannot be read is told here, before anything is computed."""
    found = False
    for wheel, path in _files(study) if study.of_the_thesis else []:
        files = path, path.with_suffix(".kept") / f"{NAME}.json"
        found |= _readable(wheel.name, path, tuple(file.stat().st_mtime_ns for file in files))
    return found


def _checks(study: Study, results: Validation) -> Sequence[Check]:
    return [_check(one) for one in results.wheels]


def _check(found: ValidatedWheel) -> Check:
    """Undecided where the record is about another study of that wheel."""
    claim = Claim(
        id=f"validation.{found.wheel.name.lower()}",
        title=f"FE against the published {found.wheel.name} wheel: largest |E| / u_val of the hub displacement",
        quantity="comparison error over validation uncertainty",
        unit="-",
        role="finding",
        source="Pizzamiglio, Genta, Cofano, manuscript of 2018; uncertainties after ASME V&V 20-2009",
    )
    check = at_most(claim, lambda: found.worst.ratio, 2.0)
    if found.state != "stale":
        return check
    return undecided(check, OF_ANOTHER)


VALIDATION = Question(
    name="validation",
    title="Others' wheels",
    group="Solvers",
    read=_read,
    checks=_checks,
    applies=_asked,
)
