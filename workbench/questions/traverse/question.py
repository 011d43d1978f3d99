"""Question: the way between two samples, by the record of `workbench traverse`.

Nothing is driven here; a study without a record is not asked. Verified by tests/unit/test_workbench_traverse.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from contracts.records import Check
from workbench.questions.kept import OF_ANOTHER, Kept, State, kept
from workbench.questions.question import Question
from workbench.questions.traverse.figures import traverse_figures
from workbench.questions.traverse.graph import traverse_tasks
from workbench.questions.traverse.results import WIDTHS, TireRun, Traverse, traverse_of
from workbench.study.model import Study
from workbench.verdict.rules import Claim, at_least, at_most, undecided

__all__ = ["RECORD", "TIRE_WORDS", "TRAVERSE", "HeldTraverse"]

RECORD = "traverse"
REQUIRED = 2000.0
"""Between two samples [m]."""
SOURCE = "mission requirements, Samarini 2020, section 1, after Poulakis et al. 2015"
TIRE_WORDS = {"brush": "brush tires", "fe": "the wheel by its solid model"}


@dataclass(frozen=True, slots=True, kw_only=True)
class HeldTraverse:
    """The record, whether it is about the study as it is, and what it says."""

    record: Kept
    state: State
    traverse: Traverse

    @property
    def words(self) -> Mapping[str, str]:
        """Tires in words."""
        return TIRE_WORDS

    @property
    def widths(self) -> Mapping[str, float]:
        """Of the ranges counted together."""
        return WIDTHS


def _read(study: Study, folders: Mapping[str, Path]) -> HeldTraverse:
    record = kept(study, RECORD, traverse_of)
    assert record is not None  # else it is not asked
    found = traverse_of(record.found)
    state = record.state_of(lambda: traverse_tasks(study, tuple(found.runs), found.asked))
    return HeldTraverse(record=record, state=state, traverse=found)


def _asked(study: Study) -> bool:
    """A record that cannot be read is told here, before anything is computed."""
    return study.rover is not None and kept(study, RECORD, traverse_of) is not None


def _checks(study: Study, results: HeldTraverse) -> Sequence[Check]:
    checks = []
    for run in results.traverse.runs.values():
        checks.append(_distance(run, results.traverse.asked.distance))
        if run.first_yield is not None:
            checks.append(_strength(run, run.first_yield))
    if results.state != "stale":
        return checks
    return [undecided(check, OF_ANOTHER) for check in checks]


def _distance(run: TireRun, asked: float) -> Check:
    """Undecided where less was asked and nothing ended it; where the computation did, or a wheel beyond its curves."""
    claim = Claim(
        id=f"traverse.{run.tire}",
        title=f"Way between two samples over rocks on {TIRE_WORDS[run.tire]}",
        quantity="way",
        unit="km",
        role="finding",
        source=SOURCE,
    )
    check = at_least(claim, lambda: 1e-3 * run.reached, 1e-3 * REQUIRED)
    unknown = run.cause in ("computation", "wheel") or (run.cause is None and asked < REQUIRED)
    return replace(check, status="undecided") if unknown else check


def _strength(run: TireRun, limit: float) -> Check:
    claim = Claim(
        id=f"traverse.{run.tire}_strength",
        title=f"Way between two samples over rocks on {TIRE_WORDS[run.tire]}: heaviest wheel",
        quantity="load",
        unit="N",
        role="finding",
        source="first yield of the study's wheel by its own solid model, on a plane",
    )
    return at_most(claim, lambda: max(run.loads, default=0.0), limit)


TRAVERSE = Question(
    name="traverse",
    title="Two kilometres",
    group="Rover",
    read=_read,
    checks=_checks,
    figures=lambda study, results: traverse_figures(results.traverse),
    applies=_asked,
)
