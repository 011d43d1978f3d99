"""The samples of [input_uncertainty]: a Latin hypercube of a sweep, each point a whole study with the sampled runs.

Verified by tests/unit/test_workbench_input_uncertainty.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.errors import StudyError
from workbench.study.input_uncertainty import CUT, InputUncertaintySection, UncertainInput
from workbench.study.key_units import is_whole_number
from workbench.study.model import Study
from workbench.study.quantities import number_and_unit, to_si
from workbench.study.sweep import SweepSection, Value, tied_keys
from workbench.study.sweep_points import (
    Point,
    drawn_values,
    latin_hypercube,
    study_point,
    written_at,
)

__all__ = ["as_sampled", "as_sweep", "input_ends", "input_points", "input_values", "normal_places"]

_SECTION = "input_uncertainty"
_SI = ("m", "rad", "Pa", "N", "kg/m**3", "N/m**3", "K")
_NEEDED = ("name", "title", "wheel", "materials", "mesh", "fe")
"""Sections of a study file that the section model computes with; a whole file takes ten times as long to read."""


def as_sweep(path: Path, section: InputUncertaintySection, base: Mapping[str, Any]) -> SweepSection:
    """The section as a sweep: the ends of every input, about the values of a study file's table.

    Raises
    ------
    StudyError
        If the study's own value lies outside a range, or a deviation has no value in its unit to be about.
    """
    ranges = {key: _ends(path, key, one, base) for key, one in section.inputs.items()}
    own = {"design": "latin-hypercube", "samples": section.samples, "seed": section.seed, "models": ("section",)}
    return SweepSection.model_validate(ranges | own)


def _ends(path: Path, key: str, one: UncertainInput, base: Mapping[str, Any]) -> dict[str, Any]:
    """Low and high of one input, as a sweep has them."""
    found = number_and_unit(written_at(key, base))
    _require_alike(path, key, one, base)
    if one.deviation is None:
        ends = [number_and_unit(end) for end in (one.low, one.high)]
        low, high = (end or (0.0, "") for end in ends)
        if found is not None and not _within(found, low, high):
            hint = f"widen it so that it holds {written_at(key, base)}"
            raise StudyError(path, f"{_SECTION}.{key}", f"{one.low} to {one.high}", "misses the study's value", hint)
        return {"low": one.low, "high": one.high}
    deviation, unit = number_and_unit(one.deviation) or (0.0, "")
    if found is None or any(number_and_unit(written_at(name, base)) is None for _, name in tied_keys(key)):
        hint = "correct the key's spelling, or state its value there"
        raise StudyError(
            path, f"{_SECTION}.{key}.deviation", one.deviation, "is about no value of the study file", hint
        )
    if found[1] != unit:
        hint = f"write both in one unit; the study has {written_at(key, base)!r}"
        rule = "must be in the unit of the value it is about"
        raise StudyError(path, f"{_SECTION}.{key}.deviation", one.deviation, rule, hint)
    ends_of = [found[0] + sign * CUT * deviation for sign in (-1.0, 1.0)]
    low_end, high_end = (f"{end:.9g} {unit}" if unit else end for end in ends_of)
    if not all(math.isfinite(end) for end in ends_of):
        rule, hint = "is far larger than the value it is about", f"the study has {written_at(key, base)}"
        raise StudyError(path, f"{_SECTION}.{key}.deviation", one.deviation, rule, hint)
    if low_end == high_end:
        rule, hint = "is too small beside the value it is about", f"the study has {written_at(key, base)}; leave it out"
        raise StudyError(path, f"{_SECTION}.{key}.deviation", one.deviation, rule, hint)
    return {"low": low_end, "high": high_end}


def _require_alike(path: Path, key: str, one: UncertainInput, base: Mapping[str, Any]) -> None:
    """Refuse a deviation of what is counted, and keys drawn together whose values in the study differ."""
    keys = [name for _, name in tied_keys(key)]
    if is_whole_number(keys[0]) and (
        one.deviation is not None or any(not isinstance(end, int) for end in (one.low, one.high))
    ):
        rule, hint = "counts something", "give low and high as whole numbers"
        raise StudyError(path, f"{_SECTION}.{key}", one.words, rule, hint)
    if all(sign > 0.0 for sign, _ in tied_keys(key)):
        told_at = [value for name in keys if (value := written_at(name, base)) is not None]
        if len({number_and_unit(value) for value in told_at}) > 1:
            told = ", ".join(str(value) for value in told_at)
            rule, hint = f"are drawn as one and the study has {told}", "draw each by itself, or let the study have one"
            raise StudyError(path, f"{_SECTION}.{key}", one.words, rule, hint)


def _within(found: tuple[float, str], low: tuple[float, str], high: tuple[float, str]) -> bool:
    """Whether the study's value lies between both ends, whatever their units; yes for ends of another kind."""
    if found[1] == low[1] == high[1]:
        return low[0] <= found[0] <= high[0]
    for unit in _SI:
        with suppress(ValueError):
            value, least, most = (to_si(f"{n!r} {text}" if text else n, unit) for n, text in (found, low, high))
            return least <= value <= most
    return True


def normal_places(u: NDArray[np.float64]) -> NDArray[np.float64]:
    """Places in [0, 1) between both cuts of a normal distribution, of ``u`` (n,) in [0, 1) drawn alike.

    With Phi the distribution function and c = `CUT`: (c + Phi^-1(Phi(-c) + u (Phi(c) - Phi(-c)))) / 2c.
    """
    from scipy.special import ndtr, ndtri  # a second of every command's start

    at_cut = ndtr(-CUT)
    found = (CUT + ndtri(at_cut + u * (1.0 - 2.0 * at_cut))) / (2.0 * CUT)
    return np.clip(found, 0.0, np.nextafter(1.0, 0.0))


def input_values(path: Path, section: InputUncertaintySection, base: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Values of every sample, as a study file would have them; each input's in n pieces equally likely, one in each."""
    sweep = as_sweep(path, section, base)
    u = latin_hypercube(sweep)
    for place, one in enumerate(section.inputs.values()):
        if one.deviation is not None:
            u[:, place] = normal_places(u[:, place])
    return list(drawn_values(sweep, u))


def input_points(path: Path, table: Mapping[str, Any], section: InputUncertaintySection) -> list[Point]:
    """The study as it is (point 0) and every sample, with the runs of the section.

    Raises
    ------
    StudyError
        As `as_sweep`, and if a sample makes a study that cannot be used: names point, input and key.
    """
    base = _needed(table, section)
    values = [{}, *input_values(path, section, base)]
    points = [_point(path, base, number, chosen) for number, chosen in enumerate(values)]
    return [replace(point, study=as_sampled(point.study, section)) for point in points]


def _point(path: Path, base: Mapping[str, Any], number: int, values: Mapping[str, Value]) -> Point:
    try:
        return study_point(path, base, number, values)
    except StudyError as error:
        key = error.key.replace("[sweep] point", f"[{_SECTION}] sample")
        raise StudyError(path, key, error.value, error.rule, error.hint) from error


def input_ends(
    path: Path, table: Mapping[str, Any], section: InputUncertaintySection
) -> dict[str, tuple[Study, Study]]:
    """The study at both ends of every input, each alone, with the runs of the section.

    Raises
    ------
    StudyError
        As `as_sweep`, and where an end makes a study that cannot be used: names input, value and rule.
    """
    base = _needed(table, section)
    sweep = as_sweep(path, section, base)
    places = np.array([[0.0], [0.5], [np.nextafter(1.0, 0.0)]]).repeat(len(section.inputs), 1)
    drawn, ends = drawn_values(sweep, places), {}
    for key in section.inputs:
        try:
            points = [study_point(path, base, 0, {key: values[key]}) for values in drawn]
        except StudyError as error:
            inner = error.key.removeprefix("[sweep] point 0").removeprefix(", ").strip()
            rule = f"cannot be: {inner + ': ' if inner and inner != key else ''}{error.rule}"
            hint = f"narrow what is drawn of {key}: {error.hint}"
            raise StudyError(path, f"[{_SECTION}] {key}", error.value, rule, hint) from error
        low, _, high = (as_sampled(point.study, section) for point in points)
        ends[key] = low, high
    return ends


def _needed(table: Mapping[str, Any], section: InputUncertaintySection) -> dict[str, Any]:
    """What the section model computes with, pressed as far as the samples are."""
    needed = {key: value for key, value in table.items() if key in _NEEDED}
    return needed | {"fe": dict(needed.get("fe", {})) | {"max_deflection": section.max_deflection}}


def as_sampled(study: Study, section: InputUncertaintySection) -> Study:
    """A study with the runs that are sampled."""
    runs = {
        "orientations": section.orientations,
        "max_deflection": section.max_deflection,
        "points": section.points,
        "max_load": section.max_load,
        "snapshot_loads": (),
        "keep_points": False,
    }
    return study.model_copy(update={"fe": study.fe.model_copy(update=runs), "mesh_study": None})
