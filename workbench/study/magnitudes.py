"""Whether a study's numbers can be: each held against the table of ranges before anything is built from it.

And which gates a study has made easier than the project's own. Verified by tests/unit/test_workbench_magnitudes.py and
tests/end_to_end/test_report.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel
from pydantic_core import PydanticCustomError

from contracts.errors import InputError
from contracts.ranges import Key, Oddity, RangeTable, dotted, oddities, range_table
from workbench.study.ancf_wheel import without_ancf_wheel
from workbench.study.key_units import nameless
from workbench.study.laws import other_law
from workbench.study.model import DATA, Study
from workbench.study.off_soil import without_soil
from workbench.study.own_mesh import material_names, own_mesh
from workbench.study.quantities import to_si
from workbench.study.sections import ToleranceSection
from workbench.study.wheel_design import wheel_design

__all__ = [
    "GATES",
    "above_zero",
    "impossible",
    "loosened",
    "number_in_si",
    "numbers_of",
    "of_the_file",
    "require_possible",
    "study_ranges",
    "unusual",
    "unusual_curve",
    "warnings_of",
]

_MOST = 12
"""Warnings told one by one; a unit mistaken once may make many."""
_OF_THE_THESIS = {"reach_deflection": -1.0, "reach_load": -1.0}
"""What the wheel of the thesis alone is asked for."""
GATES = _OF_THE_THESIS | {
    **{"ancf_preset": 1.0, "flexible_mass": 1.0, "mesh_mass": 1.0, "min_scaled_jacobian": -1.0},
    **{"fe_energy": 1.0, "mesh_uncertainty": 1.0, "surface_distance": 1.0},
    **{"ancf_wheel_largest": 1.0, "ancf_wheel_mean": 1.0, "ancf_wheel_stress": 1.0, "ancf_wheel_shape": 1.0},
    "soil_models": 1.0,
}
"""Tolerances of gates, and of what the wheel is asked for -> 1 where a larger number is easier to meet, else -1."""

_NEEDED = {
    **{"ancf_preset": "ancf.thesis_preset", "flexible_mass": "ancf.thesis_preset", "surface_distance": "ancf"},
    **{
        "mesh_uncertainty": "mesh_study",
        "stress_uncertainty": "mesh_study",
        "hub_compliance": "hub_study",
        "soil_models": "soil and ancf_wheel",
        "soil_bench": "soil",
        "ancf_fit": "ancf_fit",
        "ancf_wheel_largest": "ancf_wheel",
        "ancf_wheel_mean": "ancf_wheel",
        "ancf_wheel_stress": "ancf_wheel",
        "ancf_wheel_shape": "ancf_wheel and fe.keep_points",
    },
}
"""Tolerances of checks that only some studies ask for -> the sections and keys that do."""


def study_ranges() -> RangeTable:
    """The table of ranges of the study file."""
    return range_table(DATA / "ranges.toml")


def numbers_of(study: Study) -> dict[Key, float]:
    """Every number of a study by its path, SI, defaults included."""
    return dict(_numbers((), study))


def _numbers(key: Key, value: Any) -> Iterator[tuple[Key, float]]:
    inner: Mapping[str | int, Any] = {}
    if isinstance(value, BaseModel):
        inner = dict(value)
    elif isinstance(value, Mapping):
        inner = value
    elif isinstance(value, tuple):
        inner = dict(enumerate(value))
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield key, float(value) if abs(value) < 1e308 else math.inf
    for part, content in inner.items():
        yield from _numbers((*key, part), content)


def impossible(study: Study) -> Oddity | None:
    """The first number that no wheel has; None if there is none."""
    return next((odd for odd in oddities(numbers_of(study), study_ranges()) if odd.impossible), None)


def unusual(study: Study) -> tuple[str, ...]:
    """Numbers that are unusual where they stand, a line each."""
    odd = [o for o in oddities(numbers_of(study), study_ranges()) if not o.impossible]
    lines = [f"{dotted(o.key)}{f' = {o.value}' * bool(o.value)} {o.rule}; {o.hint}" for o in odd]
    if len(lines) <= _MOST:
        return tuple(lines)
    return (*lines[:_MOST], f"{len(lines) - _MOST} more numbers are unusual")


def loosened(study: Study) -> tuple[str, ...]:
    """Each of these tolerances that is easier to meet than by default, in words."""
    given, own = study.tolerances, ToleranceSection()
    found = []
    for key, sign in GATES.items():
        value, usual = getattr(given, key), getattr(own, key)
        if (
            _asked(study, key)
            and sign * (value - usual) > 1e-9 * usual
            and (key not in _OF_THE_THESIS or study.of_the_thesis)
        ):
            found.append(f"tolerances.{key} = {value:g} is looser than the project's own {usual:g}")
    return tuple(found)


def of_the_file(study: Study) -> tuple[str, ...]:
    """What is unusual about a study file: numbers, reasons for no key, what has no effect."""
    return (*unusual(study), *nameless(study), *_idle(study))


def _idle(study: Study) -> Iterator[str]:
    """Materials that nothing names; tolerances of checks that are not in the report, words that cannot be asked."""
    used = {*material_names(study).values(), *(study.environment.variants if study.environment else ())}
    swept = [*(study.sweep.parameters.values() if study.sweep else ())]
    swept += study.optimise.variables.values() if study.optimise else ()
    used |= {value for values in swept if isinstance(values, tuple) for value in values if isinstance(value, str)}
    for name in study.materials:
        if name not in used:
            yield f"materials.{name} is of no part of the wheel and has no effect; remove it, or use it"
    for key in sorted(study.tolerances.model_fields_set):
        if not _asked(study, key):
            yield f"tolerances.{key} has no effect: its check needs {_NEEDED[key]}"
    if study.ancf_wheel is not None and (lacking := without_ancf_wheel(study)) is not None:
        yield f"[ancf_wheel] has no effect: its model does not have {lacking}; remove it, or the other"
    if study.soil is not None and (odd := without_soil(study)) is not None:
        yield f"[soil] has no effect: {odd[0]} {odd[2]}; {odd[3]}"
    if own_mesh(study) is None:
        yield from _beyond_the_wheel(study)
    if study.input_uncertainty is not None and (other := other_law(study)) is not None:
        yield f"[input_uncertainty] has no effect: the section model that samples it does not have {' = '.join(other)}"
    tires = study.ancf is not None and study.ancf.thesis_preset and study.brush is not None
    if study.of_the_thesis and not (tires and len(study.parametric.springs) > 1):
        needs = "[ancf] with thesis_preset, [brush] and two sets of springs"
        yield f"reference.thesis_words judges no stiffness: the thesis' words need {needs}"


def _beyond_the_wheel(study: Study) -> Iterator[str]:
    """An obstacle that lies too far ahead of the hub, or behind it, for the wheel to touch it."""
    obstacle = study.fe.obstacle
    if not (ahead := getattr(obstacle, "position", 0.0)):
        return
    wheel = wheel_design(study)
    reach = wheel.tire.outer_radius + (0.0 if wheel.grousers is None else wheel.grousers.height)
    half = getattr(obstacle, "radius", 0.5 * getattr(obstacle, "width", 0.0))
    if abs(ahead) - half > reach:
        rule = f"lies beyond the wheel, which reaches {1e3 * reach:g} mm from its hub: it stands on level ground"
        yield f"fe.obstacle.position = {1e3 * ahead:g} mm: the {obstacle.shape.replace('_', ' ')} {rule}"


def _asked(study: Study, tolerance: str) -> bool:
    """Whether the report has the check of a tolerance, as far as a section of the study decides it."""
    return all(_has(study, name) for name in _NEEDED.get(tolerance, "fe").split(" and "))


def _has(study: Study, name: str) -> bool:
    """Whether a study has a section, or one of its switches is on."""
    section, _, key = name.partition(".")
    found = getattr(study, section)
    return bool(getattr(found, key, False)) if key else found is not None


def warnings_of(study: Study) -> tuple[str, ...]:
    """What a report says of its study: all that is unusual about its file, gates easier than the project's own."""
    return (*unusual(study), *loosened(study), *nameless(study), *_idle(study))


def unusual_curve(deflection: NDArray[np.float64], load: NDArray[np.float64]) -> tuple[str, ...]:
    """What is unusual in a curve from elsewhere: its largest deformation [m] and load [N], loads that pull."""
    largest = {"deflection": float(np.max(np.abs(deflection))), "load": float(np.max(np.abs(load)))}
    numbers: dict[Key, float] = {("curve", name): value for name, value in largest.items() if value > 0.0}
    told = [f"largest {odd.key[-1]} = {odd.value} {odd.rule}; {odd.hint}" for odd in oddities(numbers, study_ranges())]
    if (pull := float(np.min(load))) < -0.01 * largest["load"]:
        told.append(f"smallest load = {pull:g} N pulls; loads are positive where the ground pushes the wheel")
    return tuple(told)


def number_in_si(what: str, text: str, unit: str, shown: str | None = None) -> float:
    """A number with its unit, as `to_si`; raises InputError about ``what``, whose value is ``shown``, else the text."""
    try:
        return to_si(text, unit)
    except PydanticCustomError as error:
        context = error.context or {}
        raise InputError(what, shown or text, str(context["rule"]), str(context["hint"])) from error


def above_zero(what: str, text: str, unit: str, like: str, example: str) -> float:
    """A number of the command line [SI] above zero; raises InputError for others, as `require_possible` too."""
    value = number_in_si(what, text, unit, repr(text))
    if not value > 0.0:
        raise InputError(what, repr(text), "must be greater than zero", f"write it like {example!r}")
    require_possible(what, value, like)
    return value


def require_possible(what: str, value: float, like: str) -> None:
    """Raise InputError for a number [SI] of the command line that its key ``like`` in a study could not have."""
    key = tuple(like.split("."))
    for odd in oddities({key: value}, study_ranges()):
        if odd.impossible:
            raise InputError(what, odd.value, odd.rule, odd.hint)
