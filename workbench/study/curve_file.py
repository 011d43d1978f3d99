"""Curve files as people have them: other units, other deformations, the uncertainty of the load. docs/curves.md.

Everything behind it is SI. A file that begins with ``deflection_m,load_N`` is the project's own format. Verified by
tests/unit/test_workbench_curve_file.py.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from contracts.csv_table import CsvTable, TableRule, read_table, table_text
from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.input_file import input_text
from contracts.text import one_line
from workbench.study.deformation import DEFORMATIONS, UNLOADED, Deformation, Kind, beyond_size, deformation_named
from workbench.study.magnitudes import number_in_si, require_possible
from workbench.study.quantities import to_si

__all__ = ["MeasuredCurve", "in_si", "load_uncertainty", "newtons", "read_measured_curve", "require_distinct"]

_OWN = ("deflection_m", "load_N")
_LOADS = ("load", "force", "wheel_load", "vertical_load")
_UNCERTAINTY = "load_uncertainty"
_ROLES = {"deformation": tuple(DEFORMATIONS), "load": _LOADS, "uncertainty": (_UNCERTAINTY,)}
_WHAT = "curve file"
_HEADER = re.compile(r"(.*?)[\s_]*(?:\[([^][]*)\]|\(([^()]*)\)|(?<=[\s_])([^\W\d_]+|%))")
"""A name and its unit: ``deflection_mm``, ``deflection [mm]``, ``Load (kN)``."""
_LONGEST_HEADER = 200
_SAID_ONCE = ("deformation", *UNLOADED.values(), "uncertainty", "partial")


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasuredCurve:
    """A curve in SI, with what its file says of it.

    Attributes
    ----------
    curve : load [N] against deformation [m]; ``deflection`` holds whatever ``kind`` says
    kind : radial deflection of the hub, or change of diameter between two plates
    uncertainty : (n,) float [N], half width of the interval in which the load lies; None if the file is silent
    """

    curve: StiffnessCurve
    kind: Kind
    uncertainty: NDArray[np.float64] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class _Column:
    """A column's place, the quantity its header names, and the factor to SI (1 for a relative uncertainty)."""

    place: int
    quantity: str
    factor: float
    relative: bool = False


def read_measured_curve(path: Path) -> MeasuredCurve:
    """Read a curve from CSV with headers such as ``deflection_mm,load_kN`` in any order.

    Comments that mean something: ``# source:``, ``# partial: True``, ``# deformation:``, ``# unloaded_radius:``,
    ``# unloaded_diameter:``, ``# uncertainty:``.

    Raises
    ------
    InputError
        If the file cannot be read, lacks a column, a unit or the unloaded size that it needs, names a deformation that
        is not known, says a thing twice and differently, or holds numbers that no wheel has.
    """
    names, remarks = _head(path)
    require_distinct(path, names)
    own = names[:2] == _OWN or not names
    columns = _columns(path, names[2:] if own else names, own=own)
    units = "give deflection in metres and load in newtons, or units in the header (docs/curves.md)"
    table = read_table(path, TableRule(what=_WHAT, first=_OWN if own else names, units=units))
    deformation = _deformation(path, columns["deformation"].quantity, remarks)
    deflection = _si_deformation(path, deformation, columns["deformation"], table, remarks)
    with np.errstate(over="ignore"):  # the curve refuses what is infinite
        load = columns["load"].factor * table.values[:, columns["load"].place]
    try:
        curve = StiffnessCurve(
            model=one_line(path.stem),
            orientation_deg=None,
            deflection=deflection,
            load=load,
            columns=_others(table, columns),
            source=table.source,
            partial=table.partial,
        )
    except InputError as error:
        where = _bad_line(table, columns["deformation"].place, load, falls=deformation.unloaded is not None)
        raise InputError(_WHAT, path, f"{error.what} {error.rule}{where}", error.hint) from error
    _require_possible(f"{path}: largest deflection", curve.deflection, "curve.deflection")
    _require_possible(f"{path}: largest load", curve.load, "curve.load")
    uncertainty = _stated(path, load, columns.get("uncertainty"), table, remarks)
    return MeasuredCurve(curve=curve, kind=deformation.kind, uncertainty=uncertainty)


def _bad_line(table: CsvTable, place: int, load: NDArray[np.float64], *, falls: bool) -> str:
    """Where a curve first has a value that is not finite, or a deformation that does not grow; empty if nowhere.
    ``falls``: whether the column of deformation lists what is left, which falls as the wheel deforms."""
    values = table.values[:, place]
    finite = np.isfinite(values) & np.isfinite(load)
    grows = np.diff(-values if falls else values) > 0.0
    bad = np.flatnonzero(~finite) if not finite.all() else 1 + np.flatnonzero(~grows)
    return f" (line {table.lines[int(bad[0])]})" if len(bad) else ""


def require_distinct(path: Path, names: Sequence[str] | None = None) -> None:
    """Refuse a file one of whose headers stands twice, InputError; ``names`` of its header if they are known."""
    names = _head(path)[0] if names is None else names
    twice = [name for name in names if names.count(name) > 1]
    if twice:
        raise InputError(_WHAT, path, f"has two columns {one_line(twice[0])}", "rename or remove one of them")


def in_si(path: Path, found: MeasuredCurve | None = None) -> str:
    """The file's text if it is a radial deflection in the project's own format, else the same curve in it.

    Raises
    ------
    InputError
        As `read_measured_curve`; and for a change of diameter, which is not what the report compares.
    """
    found = read_measured_curve(path) if found is None else found
    if found.kind != "radial deflection":
        rule = "is a change of diameter between two plates; the models' curves are radial deflections of a loaded hub"
        raise InputError(_WHAT, path, rule, "compare it with a curve of its own kind (workbench compare)")
    names, remarks = _head(path)
    if names[:2] == _OWN and "deformation" not in remarks:
        return input_text(path, _WHAT)
    curve = found.curve
    values = np.column_stack([curve.deflection, curve.load])
    return table_text(CsvTable(names=_OWN, values=values, source=curve.source, partial=curve.partial))


def load_uncertainty(text: str, load: NDArray[np.float64], what: str = "uncertainty") -> NDArray[np.float64]:
    """Half width of the load's interval [N] at each of ``load`` (n,) [N], from ``"3 %"`` of it or ``"5 N"``.

    Raises
    ------
    InputError
        If it is neither, negative, or above 100 %.
    """
    relative = not re.search(r"[^\W\d_]", re.sub(r"[eE][+-]?\d+", "", text))
    value = number_in_si(what, text, "" if relative else "N")
    if value < 0.0 or (relative and value > 1.0):
        raise InputError(what, text, "must lie between 0 and 100 %", "write it like '3 %', or '5 N' for newtons")
    width = value * np.abs(load) if relative else np.full_like(load, value)
    _require_possible(what, width, "curve.uncertainty")
    return width


def _require_possible(what: str, values: NDArray[np.float64], like: str) -> None:
    """Raise InputError for a column whose largest magnitude no wheel has; a tire may carry nothing at all."""
    largest = float(np.max(np.abs(values)))
    if largest > 0.0:
        require_possible(what, largest, like)


def _head(path: Path) -> tuple[tuple[str, ...], dict[str, str]]:
    """Names of the header, and what comments say by their word before the colon; nothing of a file not readable."""
    try:
        lines = input_text(path, _WHAT).splitlines()
    except InputError:
        return (), {}
    remarks: dict[str, str] = {}
    for line in lines:
        word, colon, rest = line.removeprefix("#").partition(":")
        if line.startswith("#") and colon:
            key, said = word.strip().lower().replace(" ", "_"), " ".join(rest.split())
            if key in _SAID_ONCE and remarks.get(key, said).lower() != said.lower():
                rule = f"says {key} twice, {one_line(remarks[key])} and {one_line(said)}"
                raise InputError(_WHAT, path, rule, "leave out the line that is wrong")
            remarks.setdefault(key, said)
    header = next((line for line in lines if line.strip() and not line.startswith("#")), "")
    try:
        return tuple(name.strip() for cells in csv.reader([header]) for name in cells), remarks
    except csv.Error:
        return (), {}


def _columns(path: Path, names: Sequence[str], *, own: bool) -> dict[str, _Column]:
    """Column of each role: deformation, load, and uncertainty if there is one; ``names`` of the header, those behind
    deflection_m,load_N if the file is in our ``own`` format."""
    found: dict[str, _Column] = {}
    if own:
        found["deformation"] = _Column(place=0, quantity="deflection", factor=1.0)
        found["load"] = _Column(place=1, quantity="load", factor=1.0)
    known = {"deformation": tuple(DEFORMATIONS), "load": (), "uncertainty": (_UNCERTAINTY,)} if own else _ROLES
    for place, name in enumerate(names, start=len(found)):
        quantity, unit = _parts(name)
        role = next((role for role, quantities in known.items() if quantity in quantities), None)
        if role is None:
            continue
        if role in found:
            raise InputError(_WHAT, path, f"has two columns of {role}, one is {name}", "rename one of them")
        relative = role == "uncertainty" and unit == "%"
        factor = 0.01 if relative else _factor(path, name, unit, role)
        found[role] = _Column(place=place, quantity=quantity, factor=factor, relative=relative)
    for role in ("deformation", "load"):
        if role not in found:
            rule = f"has no column of {role} among {', '.join(names[:8])}{', ...' * (len(names) > 8)}"
            if other := next((mark for mark in (";", "\t") if any(mark in name for name in names)), ""):
                rule = f"parts its columns by {'tabs' if other == '\t' else 'semicolons'}"
                raise InputError(_WHAT, path, rule, "save it with commas between columns and points in numbers")
            raise InputError(_WHAT, path, rule, "name two columns such as deflection_mm,load_kN, parted by commas")
    return found


def _parts(name: str) -> tuple[str, str]:
    """Quantity and unit of a header; a header without a unit is all quantity."""
    parts = _HEADER.fullmatch(name) if len(name) <= _LONGEST_HEADER else None
    whole = "_".join(name.lower().replace("_", " ").split())
    if parts is None or whole in DEFORMATIONS or whole in (*_LOADS, _UNCERTAINTY):
        return whole, ""
    quantity = "_".join(parts[1].lower().replace("_", " ").split())
    return quantity, next(unit for unit in (parts[2], parts[3], parts[4]) if unit is not None).strip()


def _factor(path: Path, name: str, unit: str, role: str) -> float:
    """SI units in one ``unit`` of a column."""
    if not unit:
        rule = f"has a column {name} without a unit"
        raise InputError(_WHAT, path, rule, "add it to the header, such as deflection_mm or load_kN")
    try:
        return to_si(f"1 {unit}", "m" if role == "deformation" else "N")
    except PydanticCustomError as error:
        rule = f"has a column {name} whose unit {error.context['rule'] if error.context else 'is not known'}"
        raise InputError(_WHAT, path, rule, "use units such as mm, in, N, kN, lbf") from error


def _deformation(path: Path, quantity: str, remarks: Mapping[str, str]) -> Deformation:
    """What the file's column of deformation means: its name, or the comment where the name is plain deflection."""
    named = DEFORMATIONS[quantity]
    if "deformation" not in remarks:
        return named
    said = deformation_named(remarks["deformation"])
    if said is None:
        rule = f"has a deformation that is not known: {remarks['deformation']}"
        raise InputError(_WHAT, path, rule, f"use one of {', '.join(DEFORMATIONS)}")
    if quantity != "deflection" and said is not named:
        rule = f"calls its deformation {remarks['deformation']} in a comment and {quantity} in the header"
        raise InputError(_WHAT, path, rule, "let them agree")
    return said


def _si_deformation(
    path: Path, deformation: Deformation, column: _Column, table: CsvTable, remarks: Mapping[str, str]
) -> NDArray[np.float64]:
    """The deformation [m], growing with load."""
    values = np.asarray(column.factor * table.values[:, column.place])
    named = UNLOADED[deformation.kind]
    if named not in remarks:
        if deformation.unloaded is None:
            return values
        rule = f"lists a {deformation.words} and does not say the unloaded size"
        raise InputError(_WHAT, path, rule, f"add a line such as '# {deformation.unloaded}: 142.5 mm'")
    size = number_in_si(f"{path}: {named}", remarks[named], "m")
    require_possible(f"{path}: {named}", size if named == "unloaded_radius" else 0.5 * size, "wheel.tire.outer_radius")
    found = values if deformation.unloaded is None else np.asarray(size - values)
    if wrong := beyond_size(found, size, table.lines):
        raise InputError(_WHAT, path, wrong, f"check {named} and the units in the header")
    return found


def _stated(
    path: Path, load: NDArray[np.float64], column: _Column | None, table: CsvTable, remarks: Mapping[str, str]
) -> NDArray[np.float64] | None:
    """Uncertainty of the load [N] that the file states in a column, else in a comment."""
    if column is None:
        said = remarks.get("uncertainty")
        return None if said is None else load_uncertainty(said, load, f"{path}: uncertainty")
    width = column.factor * table.values[:, column.place]
    if not (np.all(np.isfinite(width)) and np.all(width >= 0.0)):
        name = table.names[column.place]
        raise InputError(_WHAT, path, f"has a negative or missing value under {name}", "give half widths >= 0")
    width = np.asarray(width * np.abs(load) if column.relative else width)
    _require_possible(f"{path}: uncertainty", width, "curve.uncertainty")
    return width


def _others(table: CsvTable, used: Mapping[str, _Column]) -> dict[str, NDArray[np.float64]]:
    places = {column.place for role, column in used.items() if role != "uncertainty"}
    return {name: table.values[:, i] for i, name in enumerate(table.names) if i not in places}


def newtons(what: str, text: str) -> float:
    """A load of the command line [N]: ``"250"`` or ``"0.25 kN"``; raises InputError for what is neither."""
    bare = re.fullmatch(r"\s*[-+.\d]+([eE][-+]?\d+)?\s*", text)
    return number_in_si(what, f"{text} N" if bare else text, "N")
