"""Every point of an optimisation as one table. Verified by tests/end_to_end/test_optimise.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from workbench.questions.optimise.judging import Assessed
from workbench.questions.sweep.table import Cell, SweepTable, sweep_table
from workbench.study.model import Study
from workbench.study.optimise import OptimiseSection

__all__ = ["optimise_table"]

_NOT_OF_THE_WHEEL = ("wall_time_s", "relative_l2", "held_against")
"""Columns of a sweep's table that depend on when it ran, or hold points against one that is not there."""


def optimise_table(
    study: Study,
    section: OptimiseSection,
    keys: Mapping[str, str],
    points: Sequence[Assessed],
    rounds: Mapping[int, int],
    confirms: Mapping[int, int],
    on_front: set[int],
) -> SweepTable:
    """One row for each point and model: what was varied, the columns of a sweep, and what became of it.

    Parameters
    ----------
    keys : of every task, by its name
    points : in the order of the rows
    rounds : number of a point -> round that chose it, from 0
    confirms : number of a point that ran again -> number of the point of the search that it is
    on_front : numbers of the points of the search that no feasible one beats

    Returns
    -------
    table : behind a sweep's columns ``round``, ``confirms``, ``feasible`` (1: within the limits), ``miss_...`` of each
        limit, relative to it, and of stability, and ``front``
    """
    swept = study.model_copy(update={"sweep": section.as_sweep})
    whole = sweep_table(swept, keys, [point.outcome for point in points], {})
    kept = [i for i, name in enumerate(whole.names) if name not in _NOT_OF_THE_WHEEL]
    names, ends = [whole.names[i] for i in kept], whole.names.index("task_key")
    place = kept.index(ends)
    more = [_cells(point, rounds, confirms, on_front) for point in points]
    added = tuple(more[0])
    rows = []
    for row, cells in zip(whole.rows, more, strict=True):
        own = [row[i] for i in kept]
        rows.append((*own[:place], *cells.values(), *own[place:]))
    outputs = tuple(name for name in whole.outputs if name not in _NOT_OF_THE_WHEEL)
    return SweepTable(
        names=(*names[:place], *added, *names[place:]),
        rows=tuple(rows),
        inputs=whole.inputs,
        labels=whole.labels,
        outputs=(*outputs, *added),
    )


def _cells(
    point: Assessed, rounds: Mapping[int, int], confirms: Mapping[int, int], on_front: set[int]
) -> dict[str, Cell]:
    found: dict[str, Cell] = {"round": rounds.get(point.number), "confirms": confirms.get(point.number)}
    found["feasible"] = int(point.feasible)
    found |= {f"miss_{name}": miss for name, miss in point.misses.items()}
    return found | {"front": int(point.number in on_front)}
