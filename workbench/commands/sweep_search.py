"""The batches of ``workbench sweep`` where its design is a search: choose, run, judge, choose better.

Verified by tests/end_to_end/test_search.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from workbench.commands.computing import console
from workbench.commands.point_batches import PointBatches
from workbench.execution.runner import Computing
from workbench.execution.store import Store
from workbench.questions.sweep.results import Outcome, own_curves
from workbench.questions.sweep.search import Judged, Strategy, best_points, judge
from workbench.study.model import Study
from workbench.study.sweep import SweepSection, Value
from workbench.study.sweep_points import drawn_values, place_of, require_keys

__all__ = ["Searched", "search"]


@dataclass(slots=True, kw_only=True)
class Searched:
    """What a search found.

    Attributes
    ----------
    found : outcome of each point, read at its scale; refused ones say why in their note
    judged : number of a point -> against the aims
    confirms : number of a point that ran again -> number of the point of the search that it is
    keys : keys of the tasks, by their names
    """

    found: list[Outcome] = field(default_factory=list)
    judged: dict[int, Judged] = field(default_factory=dict)
    confirms: dict[int, int] = field(default_factory=dict)
    keys: dict[str, str] = field(default_factory=dict)


def search(path: Path, content: Mapping[str, Any], study: Study, store: Store, computing: Computing) -> Searched:
    """Run the search of a study's [sweep], and what it confirms; a line for each batch.

    Raises
    ------
    StudyError
        If an aim is no column of the table, a parameter no key of the study, or no point of the first batch a wheel.
    """
    section = study.sweep
    assert section is not None
    base = {key: value for key, value in content.items() if key != "sweep"}
    run = PointBatches(path=path, base=base, study=study, store=store, computing=computing, section="sweep")
    run.require_columns(section, section.wanted)
    searched = Searched()
    require_keys(path, base, section)
    start = place_of(section, base)
    strategy = Strategy(start=start, batch=section.batch, seed=section.seed, step=section.first_step)
    assert section.samples is not None
    while len(searched.judged) < section.samples:
        values = drawn_values(section, strategy.ask())
        judged = _judged(run, searched, values, section)
        strategy.tell([one.cost for one in judged])
        _tell(searched, section.samples)
    chosen = best_points(searched.judged, section.confirm)
    again = [_confirmed(searched, number, section) for number in chosen]
    if again:
        console.print(f"{len(again)} points run again, at the thickness found and at every orientation")
        first = max(searched.judged) + 1
        fixed = section.model_copy(update={"scaled": False})
        for at in range(0, len(again), section.batch):
            _judged(run, searched, again[at : at + section.batch], fixed)
        searched.confirms = {first + i: number for i, number in enumerate(chosen)}
        failed = [one for one in searched.found[-len(again) :] if one.state == "failed"]
        if failed:
            console.print(f"{len(failed)} of them have no curve; the first: {failed[0].note}", soft_wrap=True)
    return searched


def _confirmed(searched: Searched, number: int, section: SweepSection) -> dict[str, Value]:
    """Values of a point as it runs again."""
    outcome, scale = searched.judged[number].outcome, searched.judged[number].scale
    step = f"{section.confirm_step:.9g} rad"
    return {**outcome.run.point.values, "strip_scale": float(f"{scale:.6g}"), "orientation_step": step}


def _judged(
    batches: PointBatches, searched: Searched, values: Sequence[Mapping[str, Value]], section: SweepSection
) -> list[Judged]:
    """One batch, in its order."""
    study, followed = batches.study, own_curves(batches.study)
    first = max(searched.judged, default=0) + 1
    found = [judge(o, section, study.tangent_up_to, followed) for o in batches.run(values, section, first)]
    searched.judged |= dict(enumerate(found, start=first))
    searched.found += [one.outcome for one in found]
    searched.keys = batches.keys
    return found


def _tell(searched: Searched, samples: int) -> None:
    (best,) = best_points(searched.judged, 1)
    judged = searched.judged[best]
    misses = ", ".join(f"{name} {miss:.2f}" for name, miss in judged.misses.items())
    told = f"{len(searched.judged)} of {samples} points; best: {best}, largest miss {judged.largest:.3f} ({misses})"
    console.print(told, soft_wrap=True)
