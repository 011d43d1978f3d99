"""What the Python interface returns: a curve with its fields and stresses, a report's checks, curves and series.

The one module that imports pandas. Verified by tests/unit/test_workbench_api.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.foreign_folder import read_json
from contracts.records import Check, Timing
from contracts.series import TimeSeries

if TYPE_CHECKING:
    from _typeshed import DataclassInstance
    from pandas import DataFrame  # type: ignore[import-untyped]

    from workbench.charts.still_charts import Axes

__all__ = ["Curve", "Report", "Series", "curve_of", "report_in"]

_HINT = "give the folder that `workbench report --out` wrote, such as build/report"


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve(StiffnessCurve):
    """A `contracts.curves.StiffnessCurve` (deflection [m], load [N], ``load_at``, ``deflection_at``) that shows itself.

    Attributes
    ----------
    fields : load [N] -> VTU file with mesh, ``displacement_m`` (n_points, 3) [m] and ``von_mises_Pa`` (n_points,) [Pa],
        wheel frame; half of a wheel solved by its half width. At the study's snapshot loads that were reached, for FE
        at one orientation; in the store, and gone with its result
    yield_strength : yield strength of each part [Pa]; empty for a curve read from a report
    """

    fields: Mapping[float, Path] = field(default_factory=dict)
    yield_strength: Mapping[str, float] = field(default_factory=dict)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw load [N] against deflection [mm] into ``ax``, or into new axes of pyplot; returns the axes."""
        from workbench.charts.still_charts import curve_axes

        return curve_axes(self, ax)

    def to_dataframe(self) -> DataFrame:
        """A row for each point: ``deflection_m``, ``load_N``, then the further columns, their units in their names."""
        return _frame({"deflection_m": self.deflection, "load_N": self.load, **self.columns})

    def peak_stress(self, load: float) -> DataFrame:
        """Stress of each part at a load [N], interpolated linearly between the curve's points.

        Returns
        -------
        table : ``part``; ``stress_Pa``, of strips linearised through the thickness (`LinearisedStress`);
            ``max_von_mises_Pa``, the largest anywhere; ``yield_strength_Pa``; ``utilisation``, of the first over the
            third [-]; without a row for a model that has no stress, and for an average

        Raises
        ------
        InputError
            If the curve does not reach the load.
        """
        from workbench.questions.strength.yielding import peak_stresses

        found = peak_stresses(self, self.yield_strength, load)
        return _frame(
            {
                "part": [one.part for one in found],
                "stress_Pa": [one.stress for one in found],
                "max_von_mises_Pa": [one.local for one in found],
                "yield_strength_Pa": [one.strength for one in found],
                "utilisation": [one.used for one in found],
            }
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Series(TimeSeries):
    """A `contracts.series.TimeSeries` (time [s], columns named with their units) as a table."""

    def to_dataframe(self) -> DataFrame:
        """A row for each sample: ``time_s``, then the columns."""
        return _frame({"time_s": self.time, **self.columns})


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """A finished report.

    Attributes
    ----------
    folder : where it lies
    study : name of its study
    status : ``"pass"``, ``"fail"`` or ``"error"``: of the gates alone
    checks : in the order of the report
    curves : by file name without its ending: ``"fe_phi015"``, ``"ancf_average"``, ``"brush_average"``
    series : of the rover, by ``"{scenario}_{tire}"``
    fields : VTU files by file name without its ending: ``"fe_phi015_200N"``
    timings : wall time of each task
    provenance : versions, commit, machine, key of each task's result, as in ``summary.json``
    """

    folder: Path
    study: str
    status: str
    checks: tuple[Check, ...]
    curves: Mapping[str, Curve]
    series: Mapping[str, Series]
    fields: Mapping[str, Path]
    timings: tuple[Timing, ...]
    provenance: Mapping[str, Any]

    def check(self, id: str) -> Check:
        """The check with an identifier such as ``"fe.initial_tangent"``; raises InputError if there is none."""
        for one in self.checks:
            if one.id == id:
                return one
        raise InputError("check", id, f"is none of the {len(self.checks)} of this report", "see checks_table()")

    def checks_table(self) -> DataFrame:
        """A row for each check, a column for each of its attributes (`contracts.records.Check`)."""
        return _frame({f.name: [getattr(one, f.name) for one in self.checks] for f in fields(Check)})


def curve_of(curve: StiffnessCurve, **more: Any) -> Curve:
    """The same curve as one that shows itself, with some attributes changed."""
    return Curve(**_values(StiffnessCurve, curve) | more)


def report_in(folder: Path) -> Report:
    """Read what ``workbench report`` wrote; see `workbench.api.read_report`."""
    from workbench.viewer.folder import read_folder

    found = read_folder(folder)
    path = folder / "summary.json"
    content = read_json(path, "summary of the report", _HINT)
    try:
        checks = tuple(_check(row) for row in content["checks"])
        timings = tuple(Timing(**{name: row[name] for name in Timing.__slots__}) for row in content["timings"])
        provenance = dict(content["provenance"])
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        rule = f"is no summary of a report, or one of another version ({type(error).__name__}: {error})"
        raise InputError("summary of the report", path, rule, _HINT) from error
    return Report(
        folder=folder,
        study=found.study,
        status=found.status,
        checks=checks,
        curves={name: _curve(name, curve) for name, curve in found.curves.items()},
        series={"_".join(names): Series(**_values(TimeSeries, one)) for names, one in found.series.items()},
        fields={one.path.stem: one.path for one in found.fields},
        timings=timings,
        provenance=provenance,
    )


def _check(row: Mapping[str, Any]) -> Check:
    """From a summary; raises an error of Python's for what is no check, InputError for one without its words."""
    given = {f.name: row[f.name] for f in fields(Check) if f.name in row}
    given |= {name: tuple(value) for name, value in given.items() if isinstance(value, list)}
    return Check(**given)


def _curve(name: str, curve: StiffnessCurve) -> Curve:
    """A curve with the model and orientation that its name says."""
    model, _, angle = name.removesuffix("_average").partition("_phi")
    with suppress(ValueError):
        return curve_of(curve, model=model, orientation_deg=float(angle))
    return curve_of(curve, model=model)


def _values(kind: type[DataclassInstance], one: DataclassInstance) -> dict[str, Any]:
    return {f.name: getattr(one, f.name) for f in fields(kind)}


def _frame(columns: Mapping[str, Any]) -> DataFrame:
    import pandas as pd

    return pd.DataFrame(dict(columns))
