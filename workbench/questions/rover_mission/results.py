"""The record of `workbench mission`: written from what its tasks found, read as a table of requirements and tires.

Verified by tests/unit/test_workbench_rover_mission.py.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

from contracts.curves import StiffnessCurve
from rover_dynamics.rover.scenarios.outcome import LEAST_FRICTION, Outcome
from workbench.questions.models.wheel_tasks import Between
from workbench.questions.rover_mission.requirements import MISSION, plainly, tightest
from workbench.questions.strength.yielding import first_yield

__all__ = ["Cell", "Decided", "Effort", "Mission", "WheelYield", "found_of", "mission_of", "wheel_yield"]

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
    load differs most from curves solved apart, half way between those it goes through."""

    cells: Mapping[tuple[str, str], Cell]
    wheel: WheelYield | None
    between: Mapping[str, Between]

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
    results: Iterable[Mapping[str, Any]], wheel: WheelYield | None, between: Mapping[str, Between]
) -> dict[str, Any]:
    """The record of what tasks found, JSON values."""
    strength = (
        None if wheel is None else {"load_N": wheel.load, "orientation_deg": wheel.orientation_deg, "part": wheel.part}
    )
    steps = {tire: list(one) for tire, one in between.items()}
    return {"wheel": strength, "between": _rounded(steps), "runs": [_rounded(dict(one)) for one in results]}


def _rounded(value: Any) -> Any:
    """Floats to six digits."""
    if isinstance(value, float):
        return float(f"{value:.6g}")
    if isinstance(value, dict):
        return {name: _rounded(one) for name, one in value.items()}
    return [_rounded(one) for one in value] if isinstance(value, list) else value


def mission_of(found: Mapping[str, Any]) -> Mission:
    """The table of a record's ``found``; a run in which the study's wheel carries more than it yields at is not met."""
    strength = found["wheel"]
    wheel = None
    if strength is not None:
        wheel = WheelYield(
            load=float(strength["load_N"]), orientation_deg=float(strength["orientation_deg"]), part=strength["part"]
        )
    cells = [_with_strength(_cell(run), run, wheel) for run in found["runs"]]
    between = {tire: Between(*map(float, one)) for tire, one in found["between"].items()}
    return Mission(cells={(cell.tire, cell.scenario): cell for cell in cells}, wheel=wheel, between=between)


def _cell(run: Mapping[str, Any]) -> Cell:
    outcomes = [Outcome(**one) for one in run["outcomes"]]
    stopped, ends, least = run["stopped"], run.get("ends"), run.get("smallest_torque")
    cell = Cell(
        tire=run["tire"],
        scenario=run["scenario"],
        decided="met" if run["met"] else "not met",
        decides=tightest(outcomes) if outcomes else None,
        load=max((row[2] for row in run.get("loads", ())), default=0.0),
        unlimited=_effort(run) if "torque_Nm" in run else None,
        least=None if least is None else _effort(least),
        friction=run.get("smallest_friction"),
        confirmed=run.get("confirmed"),
    )
    if run["met"]:
        return cell
    if ends is None:
        return replace(cell, decided="undecided", words=plainly(stopped or ""))
    cause = str(ends["cause"])
    where = f"at {ends['time']:.3g} s, after {ends['way']:.2f} m"
    words = plainly(stopped) if stopped else f"ended by {_CAUSES[cause]} {where}"
    decided: Decided = "undecided" if stopped else "not met"
    return replace(cell, decided=decided, cause=cause, time=ends["time"], way=ends["way"], words=words)


def _effort(run: Mapping[str, Any]) -> Effort:
    return Effort(
        torque=float(run["torque_Nm"]), power=float(run["power_W"]), energy=float(run["energy_J"]), way=run["way_m"]
    )


def _with_strength(cell: Cell, run: Mapping[str, Any], wheel: WheelYield | None) -> Cell:
    if wheel is None or wheel.part is None or cell.tire not in _SOLVED or cell.decided == "not met":
        return cell
    beyond = [row for row in run.get("loads", ()) if row[2] > wheel.load]
    if not beyond:
        return cell
    time, way, load = beyond[0]
    part = wheel.part.replace("_", " ")
    words = f"ended by the wheel's strength at {time:.3g} s, after {way:.2f} m: {load:.0f} N, {part} yields"
    return replace(cell, decided="not met", cause="strength", time=time, way=way, words=words)
