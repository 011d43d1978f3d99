"""What a report's folder holds for the viewer: fields of the wheel, curves, series, motions of the rover.

Verified by tests/unit/test_viewer_folder.py.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from contracts.curves import StiffnessCurve, read_curve
from contracts.errors import InputError
from contracts.foreign_folder import read_json
from contracts.series import TimeSeries, read_series
from workbench.questions.fe.ground_file import GROUND_FILE, read_ground
from workbench.questions.fe.parts_file import PARTS_FILE, read_parts
from workbench.report.series import MOTIONS_FOLDER, SERIES_FOLDER, is_ours
from workbench.viewer.ground import Ground
from workbench.viewer.names import named_apart, plain

__all__ = ["FieldFile", "ModesFile", "ReportFolder", "read_folder", "spoken"]

_FIELDS = re.compile(r"(?P<model>.+)_phi(?P<orientation>\d+(?:\.\d+)?)_(?P<load>\d+)N\.vtu", re.DOTALL | re.ASCII)
_POINTS = re.compile(r"(?P<model>.+)_phi(?P<orientation>\d+(?:\.\d+)?)_points\.npz", re.DOTALL | re.ASCII)
_PRESSURES = re.compile(r"(?P<model>.+)_phi(?P<orientation>\d+(?:\.\d+)?)_pressure\.npz", re.DOTALL | re.ASCII)
_MODES = re.compile(
    r"modes_(?P<model>.+?)_(?P<state>free|held|standing(?:_phi(?P<orientation>\d+(?:\.\d+)?)_(?P<load>[\d.e+]+)N)?(?P<grip>_grip)?)"
    r"\.vtu",
    re.DOTALL | re.ASCII,
)
_STATES = {"free": "free in space", "held": "held at its hub"}
_MODELS = {"fe": "FE", "ancf": "ANCF", "brush": "brush", "section": "section"}
_HINT = (
    "give the folder that `workbench report --out` wrote, such as build/report, or that of stiffness, modes or rover"
)


@dataclass(frozen=True, slots=True, kw_only=True)
class FieldFile:
    """Fields of one model at one orientation [deg] and load [N]."""

    model: str
    orientation: float
    load: float
    path: Path


@dataclass(frozen=True, slots=True, kw_only=True)
class ModesFile:
    """Modes of a wheel: its title, what faces the ground [deg], the file of the shapes and the table beside it."""

    title: str
    orientation: float
    path: Path
    table: Path


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportFolder:
    """A report's results.

    Attributes
    ----------
    path : the folder
    study, status : as in ``summary.json``; empty without one
    fields : in the order of model, orientation and load
    points : fields at the points of a curve, by (model, orientation)
    pressures : contact pressures at the nodes, by the same
    yield_strengths : of parts by name [Pa]; empty where nothing is told of them
    ground : what the wheel of the fields stands on
    curves : by file name without its ending, such as ``fe_phi015``
    series : time series by (scenario, tire)
    motions : files of recorded motions by (scenario, tire)
    modes : natural modes, by name
    left_out : names of what looks like a result and leads out of the folder, or is no file

    Names are `plain`: a file may be called anything.
    """

    path: Path
    study: str
    status: str
    fields: tuple[FieldFile, ...]
    points: Mapping[tuple[str, float], Path]
    pressures: Mapping[tuple[str, float], Path]
    yield_strengths: Mapping[str, float]
    ground: Ground
    curves: Mapping[str, StiffnessCurve]
    series: Mapping[tuple[str, str], TimeSeries]
    motions: Mapping[tuple[str, str], Path]
    modes: tuple[ModesFile, ...]
    left_out: tuple[str, ...] = ()

    def strengths_of(self, model: str, orientation: float) -> dict[int, float]:
        """Yield strengths [Pa] by the tags of the parts."""
        names = enumerate(self.parts_of(model, orientation), start=1)
        return {tag: self.yield_strengths[name] for tag, name in names if name in self.yield_strengths}

    def parts_of(self, model: str, orientation: float) -> tuple[str, ...]:
        """Names of the parts in the order of their tags 1, 2, ...: those with a stress in the curve beside the fields,
        behind them those that are held rigid, of which the parts' strengths alone are told.
        """
        for name, curve in self.curves.items():
            if re.fullmatch(rf"{re.escape(model)}_phi0*{orientation:g}", name):
                found = (re.fullmatch(r"max_von_mises_(.+)_Pa", column) for column in curve.columns)
                stressed = tuple(match[1] for match in found if match)
                return (*stressed, *(name for name in self.yield_strengths if name not in stressed))
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
    inside = _Inside(path)
    summary = path / "summary.json"
    study, status = _summary(summary) if next(inside.files("", summary.name), None) else ("", "")
    motions = {_named(one): one for one in inside.files(MOTIONS_FOLDER, "*_*.npz")}
    series = {_named(one): one for one in inside.files(SERIES_FOLDER, "*.csv") if is_ours(one.name)}
    parts, ground = (next(inside.files("fields", name), None) for name in (PARTS_FILE, GROUND_FILE))
    found = ReportFolder(
        path=path,
        study=study,
        status=status,
        fields=_field_files(inside.matches("fields", _FIELDS, ".vtu")),
        points=_by_orientation(inside.matches("fields", _POINTS, "_points.npz")),
        pressures=_by_orientation(inside.matches("fields", _PRESSURES, "_pressure.npz")),
        yield_strengths={} if parts is None else read_parts(parts),
        ground=Ground() if ground is None else _ground(ground),
        curves={name: read_curve(one) for name, one in named_apart(inside.files("curves", "*.csv")).items()},
        series={names: read_series(one, *names) for names, one in series.items()},
        motions=motions,
        modes=tuple(
            _modes_file(path, match)
            for path, match in inside.matches("modes", _MODES, ".vtu")
            if inside.keeps(path.with_suffix(".csv"))
        ),
        left_out=tuple(dict.fromkeys(inside.left_out)),
    )
    if not (found.fields or found.curves or found.series or found.motions or found.modes):
        raise InputError("report folder", path, "holds no fields, curves, series, motions or modes to show", _HINT)
    return found


def spoken(name: str) -> str:
    """``FE 15°`` of ``fe_phi015``, ``ANCF average`` of ``ancf_average``."""
    head, _, angle = name.partition("_phi")
    words = head.split("_")
    text = " ".join([_MODELS.get(words[0], words[0]), *words[1:]])
    return f"{text} {float(angle):g}°" if re.fullmatch(r"\d+(\.\d+)?", angle) else text


def _field_files(matches: Iterable[tuple[Path, re.Match[str]]]) -> tuple[FieldFile, ...]:
    found = [
        FieldFile(model=plain(m["model"]), orientation=float(m["orientation"]), load=float(m["load"]), path=path)
        for path, m in matches
    ]
    return tuple(sorted(found, key=lambda one: (one.model, one.orientation, one.load)))


def _modes_file(path: Path, m: re.Match[str]) -> ModesFile:
    state = _STATES.get(m["state"], "standing")
    if m["load"]:
        state += f" on {float(m['orientation']):g}° under {float(m['load']):g} N"
    return ModesFile(
        title=f"{spoken(plain(m['model']))}, {state}" + (", gripping" if m["grip"] else ""),
        orientation=float(m["orientation"] or 0.0),
        path=path,
        table=path.with_suffix(".csv"),
    )


def _ground(path: Path) -> Ground:
    shape, terrain, camber = read_ground(path)
    return Ground(shape=shape, terrain=terrain, camber=camber)


def _by_orientation(matches: Iterable[tuple[Path, re.Match[str]]]) -> dict[tuple[str, float], Path]:
    return {(plain(m["model"]), float(m["orientation"])): path for path, m in matches}


class _Inside:
    """Files within a folder; what leads out of it, or is a pipe or a folder, is left out and remembered."""

    def __init__(self, root: Path) -> None:
        self.root, self.left_out = root, list[str]()

    def files(self, folder: str, pattern: str) -> Iterator[Path]:
        """In the order of their names."""
        for path in sorted((self.root / folder).glob(pattern)):
            if self.keeps(path):
                yield path

    def matches(self, folder: str, pattern: re.Pattern[str], ending: str) -> Iterator[tuple[Path, re.Match[str]]]:
        """Those whose name matches as a whole."""
        for path in self.files(folder, f"*{ending}"):
            if match := pattern.fullmatch(path.name):
                yield path, match

    def keeps(self, path: Path) -> bool:
        """Whether it `has` this; remembers it if not."""
        kept = self.has(path)
        if not kept:
            self.left_out.append(plain(str(path.relative_to(self.root))))
        return kept

    def has(self, path: Path) -> bool:
        """Whether this is a file in the folder, or a link to one."""
        try:
            return path.is_file() and path.resolve().is_relative_to(self.root.resolve())
        except (OSError, RuntimeError):  # a link to itself
            return False


def _named(path: Path) -> tuple[str, str]:
    scenario, _, tire = path.stem.rpartition("_")
    return plain(scenario), plain(tire)


def _summary(path: Path) -> tuple[str, str]:
    summary = read_json(path, "summary", "run the report again")
    return plain(str(summary.get("study", ""))), plain(str(summary.get("status", "")))
