"""Forces of the solid model beside those that another code found on the same mesh, and whether they belong together.

The other code's are kept by ``make bench NAME=crosscheck`` (`workbench.questions.kept`); ours are this report's
wherever its wheel is that of the record. Of the travel both sides are the record's, which decides where it is current.
Verified by tests/unit/test_workbench_crosscheck.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, pairwise
from typing import Any, NamedTuple

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.hub_travel import Way
from workbench.execution.task import Task
from workbench.questions.fe.graph import fe_curve_tasks
from workbench.questions.kept import Kept, State, require_numbers
from workbench.questions.travels import WORKING_LOAD, travel_tasks
from workbench.questions.wheel.graph import wheel_meshes
from workbench.study.model import Study
from workbench.study.orientation import degrees

__all__ = [
    "COMMAND",
    "NAME",
    "LoadRow",
    "PeerCheck",
    "TravelRow",
    "crosscheck_tasks",
    "peer_check",
    "points_of",
    "whole",
]

NAME, COMMAND = "crosscheck", "make bench NAME=crosscheck"
_ORIENTATIONS = 5
_LARGEST_LOAD = 1e9
_SHARES = (0.25, 0.5, 0.75)
"""Deflections over the study's largest [-]."""


def points_of(study: Study) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Orientations [deg], five of the study's, evenly; deflections [m], of those that its curves have the nearest."""
    every = [degrees(o) for o in study.fe.orientations]
    places = np.linspace(0, len(every) - 1, min(_ORIENTATIONS, len(every))).round().astype(int)
    step = study.fe.max_deflection / study.fe.points
    deflections = {round(step * max(1, round(share * study.fe.points)), 12) for share in _SHARES}
    return tuple(every[k] for k in places), tuple(sorted(deflections))


def crosscheck_tasks(study: Study, orientations_deg: Sequence[float]) -> list[Task]:
    """Mesh and curves that a record is about, and the travel forwards at the first orientation."""
    tasks = [wheel_meshes(study)[0], *fe_curve_tasks(study, orientations_deg)]
    moved = travel_tasks(study, "fe", (Way.FORE_AFT,), WORKING_LOAD, orientations_deg[:1])
    return list({task.name: task for task in (*moved, *tasks)}.values())


def whole(found: Mapping[str, Any]) -> None:
    """Raises for what a record cannot hold: loads and deflections are positive and finite, as many of each."""
    moved = found["travel"]
    columns = [moved[name] for name in ("travel_m", "ours_N", "peer_N")]
    require_numbers([*found["deflections_m"], *chain.from_iterable(columns), found["peer_unknowns"]])
    require_numbers(run[name] for run in found["runs"] for name in ("orientation_deg", "iterations"))
    require_numbers(one for run in found["runs"] for name in ("ours_N", "peer_N") for one in run[name])
    require_numbers(moved[name] for name in ("orientation_deg", "deflection_m", "friction"))
    travel = columns[0]
    if len({len(column) for column in columns}) > 1 or len(travel) < 2 or travel[0] != 0.0 or not _ascending(travel):
        raise ValueError("a travel begins at 0, ascends, and has as many forces of both")
    if any(force == column[0] for column in columns[1:] for force in column[1:]):
        raise ValueError("a hub that is moved is resisted")
    deflections = np.array(found["deflections_m"], dtype=np.float64)
    loads = np.array([[run["ours_N"], run["peer_N"]] for run in found["runs"]], dtype=np.float64)
    if loads.ndim != 3 or loads.shape[2] != len(deflections) or deflections.ndim != 1:
        raise ValueError("each run has one load of ours and one of the other code at each deflection")
    positive = (loads > 0.0) & (loads < _LARGEST_LOAD)
    if not (positive.all() and (deflections > 0.0).all() and (deflections < 1.0).all()):
        raise ValueError(f"loads lie between 0 and {_LARGEST_LOAD:g} N, deflections between 0 and 1 m")
    if not (len(deflections) and _ascending(found["deflections_m"]) and isinstance(found["peer"], str)):
        raise ValueError("deflections ascend, and the record has the name of the other code")


def _ascending(values: Sequence[float]) -> bool:
    return all(a < b for a, b in pairwise(values))


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadRow:
    """Load of the whole wheel [N] at an orientation [deg] and a deflection [m], ours and the other code's."""

    orientation: float
    deflection: float
    ours: float
    peer: float

    @property
    def difference(self) -> float:
        """The other code's load over ours, less one [-]."""
        return self.peer / self.ours - 1.0


class TravelRow(NamedTuple):
    """Force of the ground on the whole wheel, forwards [N], behind a travel [m], ours and the other code's."""

    travel: float
    ours: float
    peer: float


@dataclass(frozen=True, slots=True, kw_only=True)
class PeerCheck:
    """A record, whether it is about this study, and its rows.

    Attributes
    ----------
    record : as kept; ``found`` holds ``peer``, ``peer_unknowns``, ``deflections_m``, ``runs`` and ``travel``
    state : "current", "older sources" or "stale"
    rows : ours are this report's unless the record is stale or the report has no curve there: then the record's
    """

    record: Kept
    state: State
    rows: tuple[LoadRow, ...]

    @property
    def deflections(self) -> list[float]:
        """Of the record, ascending [m]."""
        return [float(d) for d in self.record.found["deflections_m"]]

    @property
    def orientations(self) -> list[float]:
        """Of the record [deg]."""
        return [float(run["orientation_deg"]) for run in self.record.found["runs"]]

    @property
    def iterations(self) -> tuple[int, int]:
        """Fewest and most iterations of the other code at an orientation."""
        counts = [int(run["iterations"]) for run in self.record.found["runs"]]
        return min(counts), max(counts)

    @property
    def travelled(self) -> list[TravelRow]:
        """Of the record, from where the hub begins to move."""
        moved = self.record.found["travel"]
        rows = zip(moved["travel_m"], moved["ours_N"], moved["peer_N"], strict=True)
        return [TravelRow(*map(float, row)) for row in rows]

    @property
    def stiffnesses(self) -> list[tuple[float, float]]:
        """What the force grew by since the hub began to move, over each travel, ours and the other code's [N/m]."""
        begin, *rows = self.travelled
        return [((begin.ours - one.ours) / one.travel, (begin.peer - one.peer) / one.travel) for one in rows]

    def largest_travelled(self) -> float:
        """Largest size of the relative difference of these [-]."""
        return max(abs(peer / ours - 1.0) for ours, peer in self.stiffnesses)

    def largest(self, deflection: float) -> float:
        """Largest size of the difference at a deflection, of any orientation [-]."""
        return max(abs(row.difference) for row in self.rows if row.deflection == deflection)


def peer_check(study: Study, record: Kept, curves: Mapping[float, StiffnessCurve]) -> PeerCheck:
    """The record beside the curves of this report, by orientation [deg]."""
    orientations = [float(run["orientation_deg"]) for run in record.found["runs"]]
    state = record.state_of(lambda: crosscheck_tasks(study, orientations))
    rows = []
    for run in record.found["runs"]:
        orientation = float(run["orientation_deg"])
        curve = None if state == "stale" else curves.get(orientation)
        for d, kept_load, peer in zip(record.found["deflections_m"], run["ours_N"], run["peer_N"], strict=True):
            here = curve is not None and curve.deflection[-1] >= d
            ours = float(curve.load_at(d)) if curve is not None and here else float(kept_load)
            rows.append(LoadRow(orientation=orientation, deflection=float(d), ours=ours, peer=float(peer)))
    return PeerCheck(record=record, state=state, rows=tuple(rows))
