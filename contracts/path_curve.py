"""Force and moment of the ground on a wheel whose hub goes along a path over it, and their CSV.

Verified by tests/unit/test_path_curve.py and tests/verification/test_fe_hub_path.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.csv_table import CsvTable, TableRule, read_table, table_text
from contracts.errors import InputError
from contracts.hub_travel import HubPlace, Way
from contracts.travel_curve import WRENCH

__all__ = ["PathCurve", "read_path", "write_path"]

type Array = NDArray[np.float64]
_PLACES = tuple(f"{name}_{'rad' if Way(name).turns else 'm'}" for name in HubPlace._fields)
_STORED, _LOST = ("stored_energy_J", "slip_energy_J"), ("friction_dissipation_J", "plastic_dissipation_J")


@dataclass(frozen=True, slots=True, kw_only=True)
class PathCurve:
    """One path of one model's wheel, from first touch on.

    Attributes
    ----------
    model : fe or ancf_wheel
    orientation_deg : circumferential position that faces the ground [deg]
    places : (n, 6) of the hub, in the order of `HubPlace` [m; rad]
    columns : (n,) by name; those of `WRENCH`, and what the model tells besides
    source : one line
    partial : whether the run ended before the path did

    Raises
    ------
    InputError
        For fewer than two rows, and columns that are missing, not finite or do not fit.
    """

    model: str
    orientation_deg: float
    places: Array
    columns: Mapping[str, Array]
    source: str
    partial: bool = False

    def __post_init__(self) -> None:
        if self.places.ndim != 2 or self.places.shape[1] != len(_PLACES) or len(self.places) < 2:
            raise InputError("path", str(self.places.shape), "must have two rows or more of six", "go further")
        lacking = [name for name in WRENCH if name not in self.columns]
        if lacking:
            raise InputError("columns of a path", ", ".join(lacking), "are missing", "write all six of the wrench")
        every = [*self.places.T, *self.columns.values()]
        if any(len(column) != len(self.places) or not np.isfinite(column).all() for column in every):
            raise InputError("columns of a path", "", "must be finite and as long as the path", "")

    @property
    def work(self) -> Array:
        """Work of the hub on the wheel since first touch, (n,) [J], by the trapezoid rule.

        The ground moves by dm along its own axes, which turn with it, and turns by w about them: F . dm + M . w, with
        the mean of both ends' force F and moment M.
        """
        hub = HubPlace(*self.places.T)
        moved = np.column_stack([-hub.fore_aft, -hub.lateral, hub.radial])
        turned = -np.column_stack([hub.leaning, hub.wind_up, hub.turning])
        wrench = np.column_stack([self.columns[name] for name in WRENCH])
        steps = np.hstack([np.diff(moved, axis=0), _turns(turned)])
        done = (0.5 * (wrench[1:] + wrench[:-1]) * steps).sum(axis=1)
        return np.concatenate([[0.0], np.cumsum(done)])

    @property
    def stored(self) -> Array:
        """Energy of the wheel and of elastic slip, (n,) [J]."""
        return self._sum(_STORED)

    @property
    def lost(self) -> Array:
        """What the model counts as dissipated by friction and by flow, (n,) [J]; zero where it counts nothing."""
        return self._sum(_LOST)

    def _sum(self, names: tuple[str, ...]) -> Array:
        found = [self.columns[name] for name in names if name in self.columns]
        return np.asarray(sum(found, start=np.zeros(len(self.places))))


def _turns(vectors: Array) -> Array:
    """Small turns about axes that turn along, between rotation vectors (n, 3) [rad], (n - 1, 3) [rad].

    At the middle v, of length t: w = dv - (1 - cos t) / t^2 v x dv + (t - sin t) / t^3 v x (v x dv).
    """
    v, change = 0.5 * (vectors[1:] + vectors[:-1]), np.diff(vectors, axis=0)
    t = np.linalg.norm(v, axis=1)[:, None]
    once = np.cross(v, change)
    cubic = np.divide(1.0 - np.sinc(t / np.pi), t**2, out=np.full_like(t, 1.0 / 6.0), where=t > 1e-3)
    return np.asarray(change - 0.5 * np.sinc(0.5 * t / np.pi) ** 2 * once + cubic * np.cross(v, once))


def write_path(curve: PathCurve, path: Path) -> None:
    """Write the hub's place, the wrench, the work and the further columns as CSV."""
    path.parent.mkdir(parents=True, exist_ok=True)
    others = [name for name in curve.columns if name not in WRENCH]
    names = (*_PLACES, *WRENCH, "work_J", *others)
    known = {"work_J": curve.work, **curve.columns}
    values = np.column_stack([curve.places, *(known[name] for name in names[len(_PLACES) :])])
    table = CsvTable(names=names, values=values, source=curve.source, partial=curve.partial)
    path.write_text(table_text(table), encoding="utf-8", newline="")


def read_path(path: Path, model: str, orientation_deg: float) -> PathCurve:
    """Read what `write_path` writes, of a model and orientation [deg]; raises InputError for something else."""
    table = read_table(path, TableRule(what="path file", first=_PLACES, units="SI units"))
    columns = {name: table.values[:, i] for i, name in enumerate(table.names) if name not in (*_PLACES, "work_J")}
    return PathCurve(
        model=model,
        orientation_deg=orientation_deg,
        places=table.values[:, : len(_PLACES)],
        columns=columns,
        source=table.source,
        partial=table.partial,
    )
