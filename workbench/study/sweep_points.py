"""The points of a parameter study: which values each one takes, and the whole study it then is.

Verified by tests/unit/test_workbench_sweep_points.py.
"""

from __future__ import annotations

import copy
import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from contracts.errors import InputError, StudyError
from workbench.study.full import steps_around
from workbench.study.key_units import is_key, is_table, is_whole_number, nearest_key, parts_of
from workbench.study.model import Study
from workbench.study.obstacle_words import obstacle_words
from workbench.study.own_mesh import materials_by_part
from workbench.study.quantities import number_and_unit, to_si
from workbench.study.reading import study_of
from workbench.study.sweep import SweepRange, SweepSection, Value, tied_keys

__all__ = [
    "Point",
    "beyond_reach",
    "design_points",
    "drawn_values",
    "end_points",
    "latin_hypercube",
    "place_of",
    "probes",
    "require_keys",
    "set_parameters",
    "study_point",
    "sweep_points",
    "written_at",
]

NAMED = {
    "strip_thickness": "wheel.tire.thickness",
    "strip_scale": "",
    "obstacle": "",
    "plates": "ancf.circumferential_plates",
    "orientation_step": "full.orientation_step",
}
"""Names of parameters that are more than one key -> the key that says what kind of value they take."""
_PUT = {"obstacle": -1}
"""Order in which values are put into a study: an obstacle before its keys, other names last."""
_MOST_ENDS = 40


@dataclass(frozen=True, slots=True, kw_only=True)
class Point:
    """One point of a sweep.

    Attributes
    ----------
    number : from 1; 0 is the study as it is
    values : parameter -> value as a study file would have it
    study : the whole study with these values
    temperature : of the whole wheel [K]; None for 20 C
    """

    number: int
    values: Mapping[str, Value]
    study: Study
    temperature: float | None = None

    @property
    def label(self) -> str:
        """Its values in one line."""
        return ", ".join(f"{key} = {value}" for key, value in self.values.items()) or "the study as it is"


def design_points(section: SweepSection) -> list[dict[str, Value]]:
    """Values of every point: all combinations, the last parameter fastest, or a Latin hypercube.

    A search chooses its own, see `workbench.questions.sweep.search`. Of a hypercube every parameter's range is cut into
    as many equal pieces as there are points, and each piece holds one of them (scipy.stats.qmc.LatinHypercube); values
    of a list are drawn equally often, as far as that goes.
    """
    parameters = section.parameters
    if section.design == "search":
        return []
    if section.design == "grid":
        lists = [values for values in parameters.values() if not isinstance(values, SweepRange)]
        return [dict(zip(parameters, chosen, strict=True)) for chosen in itertools.product(*lists)]
    return drawn_values(section, latin_hypercube(section))


def latin_hypercube(section: SweepSection) -> NDArray[np.float64]:
    """Places of the points of a hypercube, (samples, parameters) in [0, 1), by the section's seed."""
    assert section.samples is not None
    generator = np.random.default_rng(section.seed)
    from scipy.stats import qmc  # a second of every command's start

    return qmc.LatinHypercube(d=len(section.parameters), rng=generator).random(section.samples)


def drawn_values(section: SweepSection, u: NDArray[np.float64]) -> list[dict[str, Value]]:
    """Values of the points at ``u`` (n, parameters) in [0, 1)."""
    parameters = section.parameters
    columns = [_drawn(key, values, u[:, i]) for i, (key, values) in enumerate(parameters.items())]
    return [dict(zip(parameters, row, strict=True)) for row in zip(*columns, strict=True)]


def place_of(section: SweepSection, base: Mapping[str, Any]) -> NDArray[np.float64]:
    """Where a study file's table stands among the ranges, (parameters,) in [0, 1); 0.5 where it is beyond or silent."""
    return np.array([_place(key, values, base) for key, values in section.parameters.items()])


def written_at(key: str, base: Mapping[str, Any]) -> Any:
    """What a study file's table has at a parameter, the first key of several; None where it is silent."""
    found: Any = base
    try:
        for part in parts_of(NAMED.get(key) or tied_keys(key)[0][1]):
            found = found[part]
    except (KeyError, IndexError, TypeError):
        return None
    return found


def _place(key: str, values: Sequence[Value] | SweepRange, base: Mapping[str, Any]) -> float:
    found = written_at(key, base)
    if not isinstance(values, SweepRange):
        return (values.index(found) + 0.5) / len(values) if found in values else 0.5
    ends = [number_and_unit(one) for one in (values.low, found, values.high)]
    if any(end is None or end[1] != ends[0][1] for end in ends):  # type: ignore[index]
        return 0.5
    low, here, high = (end[0] for end in ends if end is not None)
    return (here - low) / (high - low) if low <= here < high else 0.5


def _drawn(key: str, values: Sequence[Value] | SweepRange, u: NDArray[np.float64]) -> list[Value]:
    """Values at ``u`` in [0, 1), with six digits and the unit of the range."""
    if not isinstance(values, SweepRange):
        return [values[int(len(values) * x)] for x in u]
    (low, unit), (high, _) = (number_and_unit(end) or (math.nan, "") for end in (values.low, values.high))
    if is_whole_number(NAMED.get(key, tied_keys(key)[0][1])):
        return [int(low + math.floor((high - low + 1.0) * x)) for x in u]
    numbers = [float(f"{low + (high - low) * x:.6g}") for x in u]
    return [f"{number:.6g} {unit}" if unit else number for number in numbers]


def sweep_points(path: Path, table: Mapping[str, Any]) -> list[Point]:
    """Every point of a study file's [sweep] as a whole study, checked as the file itself is; first the study as it is.

    Parameters
    ----------
    path : of the study file, for messages and for the files it names
    table : its content

    Raises
    ------
    StudyError
        If there is no [sweep], or a value makes a study that cannot be used: names point, parameter and key.
    """
    study = study_of(path, table)
    if study.sweep is None:
        rule = "is missing: it says what to vary"
        raise StudyError(path, "sweep", "", rule, 'add e.g. [sweep] with strip_thickness = ["0.5 mm", "0.6 mm"]')
    base = {key: value for key, value in table.items() if key != "sweep"}
    points = [Point(number=0, values={}, study=study_of(path, base))] if study.sweep.base else []
    for number, values in enumerate(design_points(study.sweep), start=1):
        points.append(study_point(path, base, number, values))
    return points


def end_points(path: Path, table: Mapping[str, Any]) -> list[Point]:
    """Points of [sweep] that hold the first and the last value of every parameter, checked as `sweep_points` does.

    All points if they are no more than `_MOST_ENDS`; else for each parameter the first point with its smallest or first
    value and the first with its largest or last one, of at most so many points. Each is a point that is run, so that
    one which cannot be used is a study that cannot be swept. Empty without a [sweep].
    """
    study = study_of(path, table)
    if study.sweep is None:
        return []
    base = {key: value for key, value in table.items() if key != "sweep"}
    if study.sweep.design == "search":
        require_keys(path, base, study.sweep)
        return []
    every = design_points(study.sweep)
    places = range(len(every)) if len(every) <= _MOST_ENDS else _ends(study.sweep, every)[:_MOST_ENDS]
    return [study_point(path, base, place + 1, every[place]) for place in places]


def require_keys(path: Path, base: Mapping[str, Any], section: SweepSection) -> None:
    """Refuse a parameter whose key a value cannot be put at; StudyError names it."""
    for key, value in drawn_values(section, np.full((1, len(section.parameters)), 0.5))[0].items():
        _set_parameter(path, copy.deepcopy(dict(base)), key, value, base)


def _ends(section: SweepSection, every: Sequence[Mapping[str, Value]]) -> list[int]:
    """Places of the first points with an end of a parameter, without repeats."""
    places: dict[int, None] = {}
    for key, values in section.parameters.items():
        held = [point[key] for point in every]
        if isinstance(values, SweepRange):
            numbers = [(number_and_unit(value) or (0.0, ""))[0] for value in held]
            places |= dict.fromkeys(numbers.index(end(numbers)) for end in (min, max))
        else:
            places |= dict.fromkeys(held.index(value) for value in (values[0], values[-1]) if value in held)
    return list(places)


def beyond_reach(study: Study, points: Sequence[Point]) -> list[str]:
    """Deflections of [sweep] that the file names and no curve of its models reaches, a line each."""
    if study.sweep is None or "brush" in study.sweep.models or "deflections" not in study.sweep.model_fields_set:
        return []
    studies = [study, *(point.study for point in points)]
    reach = max(
        one.ancf.max_deflection if model == "ancf" and one.ancf is not None else one.fe.max_deflection
        for one in studies
        for model in study.sweep.models
    )
    return [
        f"sweep.deflections[{i}] = {1e3 * deflection:g} mm lies beyond the largest max_deflection, {1e3 * reach:g} mm; "
        "no load is found there"
        for i, deflection in enumerate(study.sweep.deflections)
        if deflection > reach * (1.0 + 1e-9)
    ]


def probes(path: Path, table: Mapping[str, Any], key: str, values: Sequence[Value]) -> list[Point]:
    """The study with each of the ``values`` of one parameter, else as it is; raises StudyError as `sweep_points`."""
    base = {name: value for name, value in table.items() if name != "sweep"}
    return [study_point(path, base, number, {key: value}) for number, value in enumerate(values, start=1)]


def study_point(path: Path, base: Mapping[str, Any], number: int, values: Mapping[str, Value]) -> Point:
    """A study file's table, without [sweep], with the values of one point; raises StudyError as `sweep_points`."""
    shown = ", ".join(f"{key} = {value!r}" for key, value in values.items())
    table = copy.deepcopy(dict(base))
    try:
        set_parameters(path, table, values, base)
        study = study_of(path, table)
        if "orientation_step" in values:
            study = _all_around(study)
        temperature = _temperature(path, study, values.get("temperature"))
    except StudyError as error:
        key = f"[sweep] point {number} ({shown}): {error.key}"
        raise StudyError(path, key, error.value, error.rule, error.hint) from error
    return Point(number=number, values=values, study=study, temperature=temperature)


def set_parameters(path: Path, table: dict[str, Any], values: Mapping[str, Value], base: Mapping[str, Any]) -> None:
    """Change a table, which was the ``base``, as a point's values ask for it; StudyError names a key that is none."""
    for key, value in sorted(values.items(), key=lambda item: _PUT.get(item[0], int(item[0] in NAMED))):
        _set_parameter(path, table, key, value, base)


def _temperature(path: Path, study: Study, value: Value | None) -> float | None:
    """Temperature of a point [K], one at which every material of the wheel is known."""
    if value is None:
        return None
    try:
        temperature = to_si(value, "K")
        for material in materials_by_part(study).values():
            material.at(temperature)
    except PydanticCustomError as error:
        context = error.context or {}
        raise StudyError(path, "temperature", value, str(context["rule"]), str(context["hint"])) from error
    except InputError as error:
        raise StudyError(path, "temperature", value, f"{error.what} {error.rule}", error.hint) from error
    return temperature


def _set_parameter(path: Path, table: dict[str, Any], key: str, value: Value, base: Mapping[str, Any]) -> None:
    """Change a point's content, which was the ``base``'s, as one parameter asks for it."""
    if key == "temperature":
        return
    if key == "strip_thickness":
        for part in _strips(table):
            part["thickness"] = value
            for one in _TAPER & part.keys():
                del part[one]
    elif key == "strip_scale":
        _scale(table, value)
    elif key == "orientation_step":
        table["full"] = table.get("full", {}) | {"orientation_step": value}
    elif key == "orientation":
        _turn(table, value)
    elif key == "obstacle":
        try:
            table["fe"] |= {"obstacle": obstacle_words(value)}
        except InputError as error:
            raise StudyError(path, key, value, f"{error.what} {error.rule}", error.hint) from error
    elif key == "plates":
        table["ancf"] |= _replated(base["ancf"], value)
    else:
        for sign, name in tied_keys(key):
            _set_key(path, table, name, value if sign > 0.0 else _negative(path, name, value))


_TAPER = {"thickness_middle", "thickness_hub"}
"""Thickness of springs elsewhere than at the rim, where it varies."""


def _strips(table: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Tables of the parts that have a strip's thickness."""
    wheel = table.get("wheel", {})
    parts = (wheel.get("tire"), *wheel.get("springs", ()), wheel.get("sidewall_springs"), wheel.get("lattice"))
    return [part for part in parts if part is not None]


def _scale(table: Mapping[str, Any], factor: Value) -> None:
    """Thickness of rim and springs times a factor."""
    for part in _strips(table):
        for key in ("thickness", *(_TAPER & part.keys())):
            number = number_and_unit(part.get(key))
            if number is not None and isinstance(factor, int | float) and not isinstance(factor, bool):
                part[key] = f"{number[0] * factor:.9g} {number[1]}".rstrip()


def _negative(path: Path, key: str, value: Value) -> Value:
    number = number_and_unit(value)
    if number is None:
        raise StudyError(path, key, value, "has no negative", "tie it without a minus sign")
    return f"{-number[0]:.9g} {number[1]}" if number[1] else -number[0]


def _all_around(study: Study) -> Study:
    """With the orientations of a whole period, by `full.orientation_step`."""
    around = tuple(math.radians(o) for o in steps_around(study))
    return study.model_copy(update={"fe": study.fe.model_copy(update={"orientations": around})})


def _turn(table: dict[str, Any], value: Value) -> None:
    """Only this orientation, wherever the study names one of those it computes."""
    many, one = {"orientations": [value]}, {"orientation": value}
    for name, change in (("fe", many), ("ancf", many), ("mesh_study", many), ("environment", one)):
        if name in table:
            table[name] |= change
    table.get("mesh_study", {}).pop("orientation", None)
    table.get("reference", {}).get("slope", {}).pop("orientations", None)


def _replated(ancf: Mapping[str, Any], value: Value) -> dict[str, Any]:
    """Other plates around the rim, with the same contact stiffness of the whole rim: each plate has as many points."""
    if isinstance(value, bool) or not isinstance(value, int) or not 0 < value < 1e9:
        return {"circumferential_plates": value}  # refused where the point is checked
    stiffness = to_si(ancf["contact_stiffness"], "N/m") * ancf["circumferential_plates"] / value
    return {"circumferential_plates": value, "contact_stiffness": stiffness}


def _set_key(path: Path, table: dict[str, Any], key: str, value: Value) -> None:
    """Put a value at a dotted key; tables that are not written in the file are made, lists are not made longer."""
    *parents, last = parts_of(key) or [0]
    if is_table(parents) and not is_key(key):
        near = nearest_key([*parents, last])
        hint = f"use {near}, if that is meant" if near else "correct its spelling"
        raise StudyError(path, key, value, "is not a known key", hint)
    at: Any = table
    for place, part in enumerate(parents):
        missing = isinstance(at, dict) and isinstance(part, str) and part not in at
        if missing and not isinstance([*parents, last][place + 1], int):
            at[part] = {}
        try:
            at = at[part]
        except (KeyError, IndexError, TypeError):
            raise StudyError(path, key, value, "names no key of the study", "correct its spelling") from None
    in_list = isinstance(at, list) and isinstance(last, int) and last < len(at)
    if not in_list and (not isinstance(at, dict) or not isinstance(last, str)):
        raise StudyError(path, key, value, "names no key of the study", "give a dotted key such as fe.friction")
    if isinstance(at[last] if in_list else at.get(last), dict | list):
        hint = 'name one of its keys, e.g. "wheel.springs[0].count"; orientations are varied by orientation'
        raise StudyError(path, key, value, "is a table or a list, not one value", hint)
    at[last] = value
