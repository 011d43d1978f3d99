"""A parameter study as one table: a row for each point and model, its values, its numbers; CSV and Parquet.

Verified by tests/unit/test_workbench_sweep.py.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from contracts.text import for_cell
from workbench.questions.sweep.likeness import alike
from workbench.questions.sweep.results import Outcome, Reference, measured, own_curves
from workbench.questions.sweep.search import Judged, pareto
from workbench.study.key_units import unit_of
from workbench.study.model import Study
from workbench.study.quantities import number_and_unit
from workbench.study.sweep import SweepRange, SweepSection, Value, tied_keys

__all__ = ["Cell", "SweepTable", "sweep_table"]

type Cell = float | int | str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class SweepTable:
    """Names of the columns with their units, the rows, and which columns are what was varied and what was found.

    ``labels`` are what was varied in the same order, as written at an axis: ``"strip thickness [mm]"``.
    """

    names: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    inputs: tuple[str, ...]
    labels: tuple[str, ...]
    outputs: tuple[str, ...]

    def column(self, name: str) -> tuple[Cell, ...]:
        """Cells of one column."""
        place = self.names.index(name)
        return tuple(row[place] for row in self.rows)

    def csv(self) -> str:
        """The table as text; numbers to their last digit, an empty cell where there is none."""
        stream = io.StringIO()
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(map(for_cell, self.names))
        writer.writerows([[_written(cell) for cell in row] for row in self.rows])
        return stream.getvalue()


def _written(cell: Cell) -> float | int | str:
    return "" if cell is None else for_cell(cell) if isinstance(cell, str) else cell


def sweep_table(
    study: Study,
    keys: Mapping[str, str],
    found: Sequence[Outcome],
    against: Mapping[str, Reference],
    judged: Mapping[int, Judged] | None = None,
    confirms: Mapping[int, int] | None = None,
) -> SweepTable:
    """One row for each outcome.

    Parameters
    ----------
    keys : of every task, by its name
    against : what each model is held against
    judged, confirms : of a search: what each point misses, and which point of the search one is that ran again
    """
    section = study.sweep
    assert section is not None
    followed, kinds = own_curves(study), alike(found)
    best = _best_of_their_like(judged or {}, found, kinds)
    columns = {key: _column(section, key) for key in section.parameters}
    inputs = tuple(name for name, _, _ in columns.values())
    rows, outputs = [], tuple[str, ...]()
    for outcome, kind in zip(found, kinds, strict=True):
        values = outcome.run.point.values
        told = [convert(values[key]) if key in values else None for key, (_, _, convert) in columns.items()]
        up_to, reference = study.tangent_up_to, against.get(outcome.run.model)
        numbers = measured(outcome, section, up_to, reference, followed)
        if judged:
            number = outcome.run.point.number
            numbers |= _judged_cells(judged[number], number in best, (confirms or {}).get(number))
        outputs = tuple(numbers)
        own = " ".join(keys[task] for task in outcome.run.curves.values())
        first = (outcome.run.point.number, outcome.run.model, *told, outcome.state, kind)
        rows.append((*first, *numbers.values(), outcome.wall_s, own, outcome.note or None))
    names = ("point", "model", *inputs, "state", "alike", *outputs, "wall_time_s", "task_key", "note")
    labels = tuple(label for _, label, _ in columns.values())
    return SweepTable(names=names, rows=tuple(rows), inputs=inputs, labels=labels, outputs=outputs)


def _best_of_their_like(
    judged: Mapping[int, Judged], found: Sequence[Outcome], kinds: Sequence[int | None]
) -> set[int]:
    """Points that none of their kind beats in every aim."""
    of_kind: dict[int | None, dict[int, Judged]] = {}
    for outcome, kind in zip(found if judged else (), kinds, strict=False):
        number = outcome.run.point.number
        of_kind.setdefault(kind, {})[number] = judged[number]
    return {number for points in of_kind.values() for number in pareto(points)}


def _judged_cells(judged: Judged, best: bool, confirms: int | None) -> dict[str, float | str | None]:
    """What a search adds to the row of a point."""
    scale = judged.outcome.run.point.values.get("strip_scale", judged.scale)
    cells: dict[str, float | str | None] = {"strip_scale": float(scale), "confirms": confirms}
    cells |= {f"miss_{name}": miss for name, miss in judged.misses.items()} | dict(judged.chosen)
    return cells | {"largest_miss": judged.largest, "cost": judged.cost, "pareto": float(best)}


def _column(section: SweepSection, key: str) -> tuple[str, str, Callable[[Value], Cell]]:
    """Header and label of one parameter, and what a value becomes: a number in the unit it was written in, or text."""
    values = section.parameters[key]
    given = (values.low, values.high) if isinstance(values, SweepRange) else values
    numbers = [number_and_unit(value) for value in given]
    words = key.replace("_", " ")
    if None in numbers:
        return key, words, _as_text
    unit = next((number[1] for number in numbers if number), "") or unit_of(tied_keys(key)[0][1]) or ""
    header = f"{key}_{_in_a_name(unit)}" if unit else key
    whole = all(isinstance(value, int) for value in given) and not unit
    return header, f"{words} [{unit or '-'}]", _as_whole_number if whole else _as_number


def _as_text(value: Value) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _as_number(value: Value) -> float | None:
    found = number_and_unit(value)
    return None if found is None else found[0]


def _as_whole_number(value: Value) -> float | int | None:
    return value if isinstance(value, int) else _as_number(value)


def _in_a_name(unit: str) -> str:
    """``"N/mm^2"`` -> ``"N_per_mm2"``."""
    return unit.replace("**", "").replace("^", "").replace("/", "_per_").replace("*", "_").replace(" ", "_")
