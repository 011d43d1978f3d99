"""The record of `workbench mission`: written from what its tasks found, read as a table of requirements and tires.

Verified by tests/unit/test_workbench_rover_mission.py.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

from contracts.curves import StiffnessCurve
from rover_dynamics.rover.scenarios.outcome import LEAST_FRICTION, Outcome
from workbench.questions.kept import rounded
from workbench.questions.models.between import Between
from workbench.questions.rover_mission.graph import MISSION_TIRES
from workbench.questions.rover_mission.requirements import MISSION, plainly, tightest
from workbench.questions.strength.yielding import first_yield

__all__ = ["Cell", "Decided", "Effort", "Mission", "WheelYield", "found_of", "mission_of", "wheel_yield"]

_LARGEST = 1e12
Decided = Literal["met", "not met", "undecided"]
_SOLVED = ("fe", "ancf_wheel")
"""Tires that are the study's wheel, which yields as its solid model says."""
_BRACKET = 0.005
"""Friction within which the least one tried is not told from the one found [-]."""
_CAUSES = {
    "friction": "friction",
    "drives": "the drives' torque",
    "stability": "stability",
    "clearance": "a body on the ground",
    "wheel": "the wheel",
    "computation": "the computation",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelYield:
    """Where stress in the wheel first reaches yield: load [N], orientation [deg], part; part None: not on its curves,
    of which the shortest ends at the load."""

    load: float
    orientation_deg: float
    part: str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """What drives of one torque limit took: that torque [N m], mechanical power of all [W], energy [J], way [m]."""

    torque: float
    power: float
    energy: float
    way: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Cell:
    """One requirement on one kind of tire.

    Attributes
    ----------
    tire, scenario : names
    decided : met, not met, or undecided where the run stopped, for its model says nothing beyond
    decides : the number that is not met, or comes nearest to its limit; None where a run stopped
    cause, time, way : what ends it, when [s] and where [m]; None of one that is met
    words : the same in words, "" of one that is met
    load : heaviest wheel's [N]
    unlimited : with drives without limits; torque is the largest
    least : with drives of the smallest torque that meets it; None where not searched
    friction : smallest at which it is met [-]; None where not searched
    confirmed : whether it is met here with a little more than another tire's smallest torque; None where not tried
    """

    tire: str
    scenario: str
    decided: Decided
    decides: Outcome | None = None
    cause: str | None = None
    time: float | None = None
    way: float | None = None
    words: str = ""
    load: float = 0.0
    unlimited: Effort | None = None
    least: Effort | None = None
    friction: float | None = None
    confirmed: bool | None = None

    @property
    def least_friction(self) -> str:
        """The smallest friction in words, "" where not searched; at most, where nothing below was tried."""
        if self.friction is None:
            return ""
        return f"{'≤ ' if self.friction <= LEAST_FRICTION + _BRACKET else ''}{self.friction:.3f}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Mission:
    """All cells by tire and scenario; where the wheel yields, or None where no solid model was asked; by tire where its
    load differs most from curves solved apart, half way between those it goes through; the same of the tire by the
    solid model on a half-round, where a plane stands for it."""

    cells: Mapping[tuple[str, str], Cell]
    wheel: WheelYield | None
    between: Mapping[str, Between]
    rock: Between | None

    @property
    def tires(self) -> list[str]:
        """In the order of the record."""
        return list(dict.fromkeys(tire for tire, _ in self.cells))

    @property
    def scenarios(self) -> list[str]:
        """In the order of the report."""
        return [name for name in MISSION if any(scenario == name for _, scenario in self.cells)]

    def of_tire(self, tire: str) -> list[Cell]:
        """Its cells, in the order of the report."""
        return [self.cells[tire, name] for name in self.scenarios if (tire, name) in self.cells]

    @property
    def tried(self) -> list[Cell]:
        """Cells in which another tire's torque was tried."""
        return [cell for cell in self.cells.values() if cell.confirmed is not None]


def wheel_yield(curves: Sequence[StiffnessCurve], strengths: Mapping[str, float]) -> WheelYield:
    """Of a wheel by its curves: the smallest load at first yield; where nothing yields, the end of the shortest."""
    found = [(first_yield(curve, strengths), curve.orientation_deg or 0.0) for curve in curves]
    yields = [one for one in found if one[0].part is not None]
    first, orientation = min(yields or found, key=lambda one: one[0].load)
    return WheelYield(load=first.load, orientation_deg=orientation, part=first.part)


def found_of(
    results: Iterable[Mapping[str, Any]],
    wheel: WheelYield | None,
    between: Mapping[str, Between],
    rock: Between | None,
) -> dict[str, Any]:
    """The record of what tasks found, JSON values."""
    strength = (
        None if wheel is None else {"load_N": wheel.load, "orientation_deg": wheel.orientation_deg, "part": wheel.part}
    )
    steps = {tire: list(one) for tire, one in between.items()}
    apart = {"between": rounded(steps), "rock": None if rock is None else rounded(list(rock))}
    return {"wheel": strength, **apart, "runs": [rounded(dict(one)) for one in results]}


def mission_of(found: Mapping[str, Any]) -> Mission:
    """The table of a record's ``found``; a run in which the study's wheel carries more than it yields at is not met.

    Raises
    ------
    ValueError, TypeError, LookupError
        For what no record of ours holds: other tires or requirements, one tire asked less than another, other kinds of
        values.
    """
    strength, runs = found["wheel"], found["runs"]
    wheel = None
    if strength is not None:
        part = None if strength["part"] is None else _word(strength["part"])
        load, orientation = _number(strength["load_N"]), _number(strength["orientation_deg"])
        wheel = WheelYield(load=load, orientation_deg=orientation, part=part)
    cells = {(run["tire"], run["scenario"]): _with_strength(_cell(run), run, wheel) for run in runs}
    between = {tire: Between(*map(_number, one)) for tire, one in found["between"].items()}
    rock = Between(*map(_number, on_rock)) if (on_rock := found.get("rock")) is not None else None
    tires, scenarios = ({key[k] for key in cells} for k in (0, 1))
    if not cells or not {*tires, *between} <= set(MISSION_TIRES) or not scenarios <= set(MISSION):
        raise ValueError("runs are those of the mission's requirements on its kinds of tire")
    if not len(runs) == len(cells) == len(tires) * len(scenarios):
        raise ValueError("every tire is asked the same requirements, each once")
    return Mission(cells=cells, wheel=wheel, between=between, rock=rock)


def _number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < _LARGEST:
        raise TypeError(f"{value!r} is no number that a run has")
    return float(value)


def _word(value: object) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{value!r} is no word")
    return value


def _yes_or_no(value: object) -> bool:
    if not isinstance(value, bool):
        raise TypeError(f"{value!r} is neither true nor false")
    return value


def _outcome(one: Mapping[str, Any]) -> Outcome:
    reference = one.get("reference")
    return Outcome(
        quantity=_word(one["quantity"]),
        value=_number(one["value"]),
        unit=_word(one["unit"]),
        reference=None if reference is None else _number(reference),
        limit=_number(one["limit"]),
        at_least=_yes_or_no(one["at_least"]),
    )


def _cell(run: Mapping[str, Any]) -> Cell:
    outcomes = [_outcome(one) for one in run["outcomes"]]
    stopped, ends, least = run["stopped"], run.get("ends"), run.get("smallest_torque")
    friction, confirmed = run.get("smallest_friction"), run.get("confirmed")
    met = _yes_or_no(run["met"])
    cell = Cell(
        tire=run["tire"],
        scenario=run["scenario"],
        decided="met" if met else "not met",
        decides=tightest(outcomes) if outcomes else None,
        load=max((_number(load) for _, _, load in run.get("loads", ())), default=0.0),
        unlimited=_effort(run) if "torque_Nm" in run else None,
        least=None if least is None else _effort(least),
        friction=None if friction is None else _number(friction),
        confirmed=None if confirmed is None else _yes_or_no(confirmed),
    )
    if met:
        return cell
    if ends is None:
        return replace(cell, decided="undecided", words=plainly(_word(stopped or "")))
    cause, time, way = _word(ends["cause"]), _number(ends["time"]), _number(ends["way"])
    words = plainly(_word(stopped)) if stopped else f"ended by {_CAUSES[cause]} at {time:.3g} s, after {way:.2f} m"
    decided: Decided = "undecided" if stopped else "not met"
    return replace(cell, decided=decided, cause=cause, time=time, way=way, words=words)


def _effort(run: Mapping[str, Any]) -> Effort:
    torque, power, energy, way = (_number(run[name]) for name in ("torque_Nm", "power_W", "energy_J", "way_m"))
    return Effort(torque=torque, power=power, energy=energy, way=way)


def _with_strength(cell: Cell, run: Mapping[str, Any], wheel: WheelYield | None) -> Cell:
    if wheel is None or wheel.part is None or cell.tire not in _SOLVED or cell.decided == "not met":
        return cell
    beyond = [row for row in run.get("loads", ()) if row[2] > wheel.load]
    if not beyond:
        return cell
    time, way, load = beyond[0]
    part = wheel.part.replace("_", " ")
    where = f"at {time:.3g} s, after {way:.2f} m" if time > 0.0 else "where it starts"
    words = f"ended by the wheel's strength {where}: {load:.0f} N, beyond first yield ({part})"
    return replace(cell, decided="not met", cause="strength", time=time, way=way, words=words)
