"""The record of `workbench traverse`: written from what its tasks found, and read.

The loads of all stretches of a wheel, one behind the other, are one history for rainflow. Where a stretch ends before
the rover is there, the drive ends; the stretches behind, each from rest, count in all else. Verified by
tests/unit/test_workbench_traverse.py.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from itertools import chain
from typing import Any

import numpy as np

from workbench.questions.kept import rounded
from workbench.questions.traverse.counting import counted
from workbench.questions.traverse.graph import TRAVERSE_TIRES, Asked

__all__ = ["WIDTHS", "TireRun", "Traverse", "found_of", "run_of", "traverse_of"]

WIDTHS = {"load": 20.0, "deflection": 2e-3}
"""Of the ranges that are counted together [N], [m]."""
CAUSES = {
    "wheel": "a wheel pressed deeper than its curves go",
    "computation": "the computation",
    "heading": "a rover that turned off its way",
    "stability": "a lean of more than 30 degrees",
    "clearance": "a body on the ground",
    "friction": "wheels that turn without taking it there",
}
_LISTS = ("loads", "deflections", "airborne", "load_cycles", "deflection_cycles")


@dataclass(frozen=True, slots=True, kw_only=True)
class TireRun:
    """The drive on one kind of tire; lists have one entry a wheel.

    Attributes
    ----------
    tire : name
    reached : way up to where it first ends [m]
    way, time : of all stretches [m], [s]
    energy, work : what drives give, and that less what they are given back [J]
    stretches, ended : how many there are, and how many end before the rover is there
    cause, words : of the first that does, None and "" where none does; what its solver said
    stretch, moment, place : where: its number from 1 on, time in it [s], x and y from its start [m]
    rocks, avoided, tallest : in straight tracks of the wheels: to be driven over, driven around, height of the tallest
        of the former [m]
    aside, lean : largest [m], [rad]
    loads, deflections : largest [N], [m]
    typical : of the stretches' largest loads the median and the 95th percentile [N]
    airborne, over : share of the time without load, and above the first yield of the study's wheel, None without one
    overloaded : stretches in which a wheel carries more than that, None without one
    first_yield : that load [N], or None
    load_cycles, deflection_cycles : numbers of cycles in ranges of `WIDTHS`, from 0 on
    """

    tire: str
    reached: float
    way: float
    time: float
    energy: float
    work: float
    stretches: int
    ended: int
    cause: str | None
    words: str
    stretch: int | None
    moment: float | None
    place: list[float] | None
    rocks: int
    avoided: int
    tallest: float
    aside: float
    lean: float
    loads: list[float]
    deflections: list[float]
    typical: list[float]
    airborne: list[float]
    over: list[float] | None
    overloaded: int | None
    first_yield: float | None
    load_cycles: list[list[float]]
    deflection_cycles: list[list[float]]

    @property
    def energy_per_metre(self) -> float:
        """[J/m]"""
        return self.energy / self.way if self.way > 0.0 else 0.0

    @property
    def work_per_metre(self) -> float:
        """[J/m]"""
        return self.work / self.way if self.way > 0.0 else 0.0

    @property
    def ends(self) -> str:
        """What ends it, in words; "" where nothing does."""
        if self.cause is None:
            return ""
        where = "before it sets out"
        if self.place is not None and self.moment is not None:
            where = f"at {self.moment:.4g} s, {self.place[0]:.2f} m ahead and {self.place[1]:+.2f} m aside of its start"
        first = f"ended after {self.reached:.1f} m by {CAUSES[self.cause]}: stretch {self.stretch}, {where}"
        return f"{first}; {self.ended} of {self.stretches} stretches end early"


@dataclass(frozen=True, slots=True, kw_only=True)
class Traverse:
    """What was asked, names of the wheels, and the drive on each kind of tire."""

    asked: Asked
    wheels: list[str]
    runs: dict[str, TireRun]


def run_of(tire: str, results: Sequence[Mapping[str, Any]]) -> TireRun:
    """The whole drive from its stretches' results, in their order."""
    broken = [k for k, one in enumerate(results) if one["ended"] is not None]
    moved = [one for one in results if "time_s" in one]
    last = results[broken[0]] if broken else None
    wheels = range(len(moved[0]["loads_N"])) if moved else range(0)
    time = sum(one["time_s"] for one in moved)

    def largest(name: str) -> list[float]:
        return [max(one[name][w] for one in moved) for w in wheels]

    def share(name: str) -> list[float]:
        return [sum(one[name][w] * one["time_s"] for one in moved) / time for w in wheels]

    def cycles(name: str) -> list[list[float]]:
        return [counted(chain.from_iterable(one[name][w] for one in moved), WIDTHS[name]) for w in wheels]

    limit, heaviest = results[0]["yield_N"], [max(one["loads_N"]) for one in moved]
    return TireRun(
        tire=tire,
        reached=sum(one["way_m"] for one in results[: broken[0] + 1 if broken else None]),
        way=sum(one["way_m"] for one in results),
        time=time,
        energy=sum(one["energy_J"] for one in moved),
        work=sum(one["work_J"] for one in moved),
        stretches=len(results),
        ended=len(broken),
        cause=None if last is None else last["ended"]["cause"],
        words="" if last is None else last["ended"]["words"],
        stretch=broken[0] + 1 if broken else None,
        moment=None if last is None else last.get("time_s"),
        place=None if last is None else last.get("place_m"),
        rocks=sum(one["rocks"] for one in results),
        avoided=sum(one["avoided"] for one in results),
        tallest=max(one["tallest_m"] for one in results),
        aside=max((one["aside_m"] for one in moved), default=0.0),
        lean=max((one["lean_rad"] for one in moved), default=0.0),
        loads=largest("loads_N"),
        deflections=largest("deflections_m"),
        typical=np.percentile(heaviest, (50.0, 95.0)).tolist() if heaviest else [],
        airborne=share("airborne"),
        over=None if limit is None else share("over"),
        overloaded=None if limit is None else sum(load > limit for load in heaviest),
        first_yield=limit,
        load_cycles=cycles("load"),
        deflection_cycles=cycles("deflection"),
    )


def found_of(asked: Asked, wheels: Sequence[str], runs: Sequence[TireRun]) -> dict[str, Any]:
    """The record, JSON values [SI]."""
    return {"asked": asdict(asked), "wheels": list(wheels), "runs": [rounded(asdict(one)) for one in runs]}


def traverse_of(found: Mapping[str, Any]) -> Traverse:
    """What a record's ``found`` holds.

    Raises
    ------
    ValueError, TypeError, LookupError
        For what no record of ours holds.
    """
    from pydantic import TypeAdapter

    if any(set(one) != {each.name for each in fields(TireRun)} for one in found["runs"]):
        raise ValueError("a run holds what one of ours holds, and nothing else")
    text = json.dumps(found["runs"], allow_nan=False)  # strictly: no text is a number
    runs = TypeAdapter(list[TireRun]).validate_json(text, strict=True)
    asked = TypeAdapter(Asked).validate_python(found["asked"])
    wheels = TypeAdapter(list[str]).validate_python(found["wheels"])
    tires = [one.tire for one in runs]
    if not tires or len(set(tires)) != len(tires) or not set(tires) <= set(TRAVERSE_TIRES):
        raise ValueError("runs are those of its kinds of tire, each once")
    for one in runs:
        _require_ours(one, len(wheels))
    return Traverse(asked=asked, wheels=wheels, runs=dict(zip(tires, runs, strict=True)))


def _require_ours(run: TireRun, wheels: int) -> None:
    """Raise ValueError for a run whose values do not go together."""
    lists = [getattr(run, name) for name in _LISTS] + ([] if run.over is None else [run.over])
    if any(len(values) not in (0, wheels) for values in lists) or run.cause not in (None, *CAUSES):
        raise ValueError("every list has one entry a wheel, and the cause is one of ours")
    if run.place is not None and len(run.place) != 2:
        raise ValueError("a place has x and y")
    if len({run.over is None, run.overloaded is None, run.first_yield is None}) > 1:
        raise ValueError("a share and stretches above first yield go with its load")
    if len(run.typical) != (2 if run.loads else 0):
        raise ValueError("largest loads have a median and a 95th percentile")
    if not 0 <= run.ended <= run.stretches or run.reached > run.way + 1e-3:
        raise ValueError("no more stretches end than there are, and what was reached was driven")
    flat = [one for values in lists for one in chain.from_iterable([v] if isinstance(v, float) else v for v in values)]
    if min((run.time, run.energy, run.tallest, *run.typical, run.overloaded or 0, *flat)) < 0.0:
        raise ValueError("times, energies, rocks, loads and counts are not negative")
