"""What a report's folder holds for the viewer: fields of the wheel, curves, series, motions of the rover.

Verified by tests/unit/test_viewer_folder.py.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from contracts.curves import StiffnessCurve, read_curve
from contracts.errors import InputError
from contracts.foreign_folder import read_json, require_inside
from contracts.series import TimeSeries, read_series
from workbench.report.series import MOTIONS_FOLDER, SERIES_FOLDER, is_ours

__all__ = ["FieldFile", "ReportFolder", "read_folder", "spoken"]

_FIELDS = re.compile(r"(?P<model>.+)_phi(?P<orientation>\d+(?:\.\d+)?)_(?P<load>\d+)N\.vtu")
_POINTS = re.compile(r"(?P<model>.+)_phi(?P<orientation>\d+(?:\.\d+)?)_points\.npz")
_MODELS = {"fe": "FE", "ancf": "ANCF", "brush": "brush", "section": "section"}
_FOLDERS = ("fields", "curves", SERIES_FOLDER, MOTIONS_FOLDER)
_HINT = "give the folder that `workbench report --out` wrote, such as build/report"


@dataclass(frozen=True, slots=True, kw_only=True)
class FieldFile:
    """Fields of one model at one orientation [deg] and load [N]."""

    model: str
    orientation: float
    load: float
    path: Path


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportFolder:
    """A report's results.

    Attributes
    ----------
    path : the folder
    study, status : as in ``summary.json``; empty without one
    fields : in the order of model, orientation and load
    points : fields at the points of a curve, by (model, orientation)
    curves : by file name without its ending, such as ``fe_phi015``
    series : time series by (scenario, tire)
    motions : files of recorded motions by (scenario, tire)
    """

    path: Path
    study: str
    status: str
    fields: tuple[FieldFile, ...]
    points: Mapping[tuple[str, float], Path]
    curves: Mapping[str, StiffnessCurve]
    series: Mapping[tuple[str, str], TimeSeries]
    motions: Mapping[tuple[str, str], Path]

    def parts_of(self, model: str, orientation: float) -> tuple[str, ...]:
        """Names of the parts with a stress in the curve beside the fields, in the order of their tags 1, 2, ..."""
        for name, curve in self.curves.items():
            if re.fullmatch(rf"{re.escape(model)}_phi0*{orientation:g}", name):
                found = (re.fullmatch(r"max_von_mises_(.+)_Pa", column) for column in curve.columns)
                return tuple(match[1] for match in found if match)
        return ()


def read_folder(path: Path) -> ReportFolder:
    """Read everything but the fields and motions, which are large.

    Raises
    ------
    InputError
        If there is no such folder, it has no results, or one of its files cannot be used.
    """
    if not path.is_dir():
        raise InputError("report folder", path, "is not a folder" if path.exists() else "does not exist", _HINT)
    for one in [*path.glob("*"), *(one for name in _FOLDERS for one in (path / name).glob("*"))]:
        require_inside(one, path, "file of a report")
    study, status = _summary(path / "summary.json")
    series = {
        _named(one): read_series(one, *_named(one))
        for one in sorted((path / SERIES_FOLDER).glob("*.csv"))
        if is_ours(one.name)
    }
    found = ReportFolder(
        path=path,
        study=study,
        status=status,
        fields=_field_files(path / "fields"),
        points={(m["model"], float(m["orientation"])): one for one, m in _matches(path / "fields", _POINTS)},
        curves={one.stem: read_curve(one) for one in sorted((path / "curves").glob("*.csv"))},
        series=series,
        motions={_named(one): one for one in sorted((path / MOTIONS_FOLDER).glob("*_*.npz"))},
    )
    if not (found.fields or found.curves or found.series or found.motions):
        raise InputError("report folder", path, "holds no results", _HINT)
    return found


def spoken(name: str) -> str:
    """``FE 15°`` of ``fe_phi015``, ``ANCF average`` of ``ancf_average``."""
    head, _, angle = name.partition("_phi")
    words = head.split("_")
    text = " ".join([_MODELS.get(words[0], words[0]), *words[1:]])
    return f"{text} {float(angle):g}°" if re.fullmatch(r"\d+(\.\d+)?", angle) else text


def _field_files(folder: Path) -> tuple[FieldFile, ...]:
    found = [
        FieldFile(model=m["model"], orientation=float(m["orientation"]), load=float(m["load"]), path=path)
        for path, m in _matches(folder, _FIELDS)
    ]
    return tuple(sorted(found, key=lambda one: (one.model, one.orientation, one.load)))


def _matches(folder: Path, pattern: re.Pattern[str]) -> list[tuple[Path, re.Match[str]]]:
    matches = [(path, pattern.fullmatch(path.name)) for path in sorted(folder.glob("*"))]
    return [(path, m) for path, m in matches if m]


def _named(path: Path) -> tuple[str, str]:
    scenario, _, tire = path.stem.rpartition("_")
    return scenario, tire


def _summary(path: Path) -> tuple[str, str]:
    if not path.exists() and not path.is_symlink():
        return "", ""
    summary = read_json(path, "summary", "run the report again")
    return str(summary.get("study", "")), str(summary.get("status", ""))
