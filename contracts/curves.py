"""Stiffness curves: load against radial deflection of a wheel, and the CSV they travel in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.csv_table import CsvTable, TableRule, read_table, table_text
from contracts.errors import InputError
from contracts.text import one_line

__all__ = ["StiffnessCurve", "average_curve", "read_curve", "write_curve"]

_RULE = TableRule(
    what="curve file", first=("deflection_m", "load_N"), units="give deflection in metres and load in newtons"
)


@dataclass(frozen=True, slots=True, kw_only=True)
class StiffnessCurve:
    """Quasi-static load of a wheel against its radial deflection.

    Attributes
    ----------
    model : ``"fe"``, ``"ancf"``, ``"brush"`` or a user's name
    orientation_deg : circumferential position that faces the ground [deg]; None for an average
    deflection : (n,) float [m], strictly increasing, zero at first contact unless the model says otherwise
    load : (n,) float [N], ground on wheel, positive in compression
    columns : further columns by header (name with unit), each (n,) float
    source : where the curve comes from, printed with it
    partial : True if the run ended before its target; marked wherever the curve appears. Such a curve may hold first
        contact alone, see `unloaded`

    Verified by tests/unit/test_curves.py.
    """

    model: str
    orientation_deg: float | None
    deflection: NDArray[np.float64]
    load: NDArray[np.float64]
    columns: Mapping[str, NDArray[np.float64]] = field(default_factory=dict)
    source: str = ""
    partial: bool = False

    def __post_init__(self) -> None:
        if (
            self.deflection.shape != self.load.shape
            or self.deflection.ndim != 1
            or len(self.deflection) < 2 - self.partial
        ):
            raise InputError("curve", f"{self.deflection.shape} points", "needs two or more points", "check the file")
        if not (np.all(np.isfinite(self.deflection)) and np.all(np.isfinite(self.load))):
            raise InputError("curve", self.model, "has values that are not finite", "remove NaN and infinite rows")
        if not np.all(np.diff(self.deflection) > 0.0):
            hint = "sort the rows, drop repeats; loading and unloading are two curves, and compression is positive"
            raise InputError("deflection", self.model, "must increase strictly", hint)
        for name, values in self.columns.items():
            if values.shape != self.deflection.shape:
                rule = f"must have one value per point, shape {self.deflection.shape}"
                raise InputError(f"curve column {name}", f"shape {values.shape}", rule, "drop the column or fill it")

    @property
    def unloaded(self) -> bool:
        """Whether there is no point but first contact, because the run converged nowhere."""
        return len(self.deflection) < 2

    def load_at(self, deflection: float | NDArray[np.float64]) -> NDArray[np.float64]:
        """Load [N] at a deflection [m] by linear interpolation; NaN-free: raises InputError outside the curve."""
        d = np.asarray(deflection, dtype=np.float64)
        if d.size and not (d.min() >= self.deflection[0] - 1e-12 and d.max() <= self.deflection[-1] + 1e-12):
            raise InputError(
                "deflection",
                f"{d.min() * 1e3:.3g}..{d.max() * 1e3:.3g} mm",
                f"lies outside the curve ({self.deflection[0] * 1e3:.3g}..{self.deflection[-1] * 1e3:.3g} mm)",
                "compute the curve further",
            )
        return np.interp(d, self.deflection, self.load)

    def deflection_at(self, load: float) -> float:
        """Smallest deflection [m] at which the curve reaches ``load`` [N]; raises InputError if it never does."""
        reached = np.flatnonzero(self.load >= load)
        if load < self.load[0] or not len(reached):
            rule = f"lies outside the curve ({self.load.min():.4g}..{self.load.max():.4g} N)"
            raise InputError("load", f"{load:g} N", rule, "compute the curve further")
        i = int(reached[0])
        if i == 0:
            return float(self.deflection[0])
        d, f = self.deflection[i - 1 : i + 1], self.load[i - 1 : i + 1]
        return float(d[0] + (load - f[0]) * (d[1] - d[0]) / (f[1] - f[0]))

    def initial_tangent(self, up_to: float) -> float:
        """Slope [N/m] of the least-squares line through the origin over 0..``up_to`` [m], on a uniform grid of 101."""
        if not up_to > 0.0:
            raise InputError("initial tangent range", f"{up_to * 1e3:g} mm", "must be greater than zero", "try 5 mm")
        d = np.linspace(0.0, up_to, 101)
        return float(d @ self.load_at(d) / (d @ d))


@dataclass(frozen=True, slots=True, kw_only=True)
class Around:
    """How a wheel repeats itself around its axle.

    Attributes
    ----------
    period : turn that maps it onto itself [deg]
    mirrored : whether it is its own mirror image about position 0, so that phi and -phi give one curve
    """

    period: float = 360.0
    mirrored: bool = False

    def weights(self, orientations_deg: Sequence[float]) -> list[float]:
        """Share of the period that each orientation stands for [-]: up to half way to its neighbours.

        A mirrored wheel has half a period; its two ends count half as much as what lies between. Verified by
        tests/unit/test_curves.py.
        """
        turned = np.asarray(orientations_deg, dtype=np.float64) % self.period
        if self.mirrored:
            turned = np.minimum(turned, self.period - turned)
        turned = np.round(turned, 6) % self.period
        places, which, count = np.unique(turned, return_inverse=True, return_counts=True)
        if self.mirrored:
            arcs = np.diff([0.0, *(0.5 * (places[1:] + places[:-1])), 0.5 * self.period]) / (0.5 * self.period)
        else:
            gaps = np.diff(np.append(places, places[0] + self.period))
            arcs = 0.5 * (gaps + np.roll(gaps, 1)) / self.period
        return [float(arcs[k] / count[k]) for k in which]


def average_curve(
    curves: Sequence[StiffnessCurve], step: float = 0.5e-3, weights: Sequence[float] | None = None
) -> StiffnessCurve:
    """Mean of load at equal deflection over the range common to all curves.

    Parameters
    ----------
    curves : curves of one model at different orientations
    step : spacing of the common grid [m]
    weights : of the curves, positive; equal if left out
    """
    if not curves:
        raise InputError("average", "0 curves", "needs at least one curve", "compute an orientation first")
    start = max(c.deflection[0] for c in curves)
    end = min(c.deflection[-1] for c in curves)
    if not 0.0 < step <= end - start:
        rule = f"must be > 0 and fit into the range common to all curves ({start * 1e3:.4g}..{end * 1e3:.4g} mm)"
        raise InputError("average step", f"{step * 1e3:g} mm", rule, "compute the curves over the same deflections")
    grid = start + step * np.arange(int(np.floor((end - start) / step + 1e-9)) + 1)
    loads = np.array([c.load_at(grid) for c in curves])
    kind = "arithmetic" if weights is None else "weighted"
    return StiffnessCurve(
        model=curves[0].model,
        orientation_deg=None,
        deflection=grid,
        load=np.average(loads, axis=0, weights=weights),
        columns={"load_min_N": loads.min(axis=0), "load_max_N": loads.max(axis=0)},
        source=f"{kind} mean of {len(curves)} orientations at equal deflection",
        partial=any(c.partial for c in curves),
    )


def write_curve(curve: StiffnessCurve, path: Path) -> None:
    """Write ``deflection_m,load_N`` and the further columns as CSV with a source line (comment)."""
    path.parent.mkdir(parents=True, exist_ok=True)
    names = ("deflection_m", "load_N", *curve.columns)
    values = np.column_stack([curve.deflection, curve.load, *curve.columns.values()])
    table = CsvTable(names=names, values=values, source=curve.source, partial=curve.partial)
    path.write_text(table_text(table), encoding="utf-8", newline="")


def read_curve(path: Path, model: str | None = None, orientation_deg: float | None = None) -> StiffnessCurve:
    """Read a curve from CSV: comment lines with ``#``, a header, ``deflection_m,load_N`` first.

    Columns are (n,), deflection [m] and load [N]. ``model`` is the file's stem by default; ``orientation_deg`` [deg] is
    None for an average.

    Raises
    ------
    InputError
        If the file is missing, empty, without these two columns, holds text where a number belongs, or has rows
        that do not match its header.
    """
    table = read_table(path, _RULE)
    try:
        return StiffnessCurve(
            model=model or one_line(path.stem),
            orientation_deg=orientation_deg,
            deflection=table.values[:, 0],
            load=table.values[:, 1],
            columns={name: table.values[:, 2 + i] for i, name in enumerate(table.names[2:])},
            source=table.source,
            partial=table.partial,
        )
    except InputError as error:
        raise InputError("curve file", path, f"{error.what} {error.rule}", error.hint) from error
