"""The section of a study file on temperature. Verified by tests/unit/test_workbench_environment.py."""

from __future__ import annotations

import itertools
import math
from typing import Annotated

from pydantic import AfterValidator, Field, StrictInt
from pydantic_core import PydanticCustomError

from workbench.study.quantities import Angle, Temperature
from workbench.study.section import Section
from workbench.study.sections import Drop

__all__ = ["EnvironmentSection"]


def _increasing(temperatures: tuple[float, ...]) -> tuple[float, ...]:
    """Sort, and refuse a temperature given twice."""
    ordered = tuple(sorted(temperatures))
    for colder, warmer in itertools.pairwise(ordered):
        if warmer - colder < 1e-6:
            rule = f"holds {warmer - 273.15:g} C twice"
            raise PydanticCustomError("quantity", "{rule}; {hint}", {"rule": rule, "hint": "give each once"})
    return ordered


class EnvironmentSection(Section):
    """The wheel at other temperatures [K] than 20 C, at one orientation [rad], on the study's mesh.

    ``points`` is the number of points of these curves, of those of the curve at 20 C up to ``max_deflection`` [m] (that
    of the FE if not given). ``variants`` names materials that in turn replace that of every part: the wheel of another
    metal, at 20 C and the lowest temperature.
    """

    temperatures: Annotated[tuple[Temperature, ...], Field(min_length=1), AfterValidator(_increasing)]
    """Of the whole wheel [K]."""
    orientation: Annotated[Angle, Field(ge=0.0, lt=2.0 * math.pi)]
    """One of fe.orientations [rad]."""
    max_deflection: Drop | None = None
    """Of these curves [m]; that of [fe] without it."""
    points: Annotated[StrictInt, Field(ge=2, le=500)] = 8
    """Of these curves."""
    variants: tuple[Annotated[str, Field(min_length=1)], ...] = ()
    """Names of materials that in turn replace that of every part."""
