"""Sections of a study file that solve the continuum wheel again: finer meshes, elastic hubs, every orientation.

Verified by tests/unit/test_workbench_study.py.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Annotated, Any

from pydantic import Field, model_validator

from workbench.study.quantities import Angle
from workbench.study.section import Positive, Section, in_key
from workbench.study.sections import Drop, Factor, Orientations

__all__ = ["FullSection", "HubStudySection", "MeshStudySection"]


SMALLEST_STEP = 1.1
"""Of refinement; below it counts of elements, whole numbers, may be the same."""


def _far_apart(key: str, factors: tuple[float, ...]) -> None:
    """Refuse meshes so much alike that their differences say nothing of the error."""
    shown = ", ".join(f"{factor:g}" for factor in factors)
    if any(b < SMALLEST_STEP * a for a, b in pairwise(factors)):
        raise in_key(key, shown, f"must each be {SMALLEST_STEP:g} times the one before or more", "e.g. 1, 2, 3")


class MeshStudySection(Section):
    """Three similar meshes, which give the numerical uncertainty of load and stress at some deflections [m].

    ``factors`` are those of ``mesh.factor``; one of them is that of the curves' mesh. ``orientation`` = one stands for
    ``orientations`` = [one].
    """

    orientations: Orientations
    """Some of fe.orientations [rad]; the least certain of them speaks for all."""
    factors: Annotated[tuple[Factor, ...], Field(min_length=3, max_length=3)] = (1.0, 2.0, 3.0)
    """Three values of mesh.factor, among them that of the curves; whole ones make similar meshes."""
    deflections: Annotated[tuple[Drop, ...], Field(min_length=1)] = (0.010, 0.020, 0.030)
    """Where loads are compared [m]."""

    @model_validator(mode="before")
    @classmethod
    def _one(cls, given: Any) -> Any:
        if isinstance(given, dict) and "orientation" in given and "orientations" not in given:
            return {key: value for key, value in given.items() if key != "orientation"} | {
                "orientations": [given["orientation"]]
            }
        return given

    @model_validator(mode="after")
    def _increasing(self) -> MeshStudySection:
        for key, values in (("factors", self.factors), ("deflections", self.deflections)):
            if not all(b > a for a, b in pairwise(values)):
                shown = ", ".join(f"{v:g}" for v in values)
                raise in_key(key, shown, "must increase", "sort them and give each once")
        _far_apart("factors", self.factors)
        return self


class HubStudySection(Section):
    """What elastic hubs, cone and impact springs add to the load, at one orientation and some deflections [m]."""

    orientation: Annotated[Angle, Field(ge=0.0, lt=2.0 * math.pi)]
    """Any [rad]."""
    deflections: Annotated[tuple[Drop, ...], Field(min_length=1)] = (0.010, 0.020)
    """Where loads are compared [m]."""


class FullSection(Section):
    """What ``workbench report --full`` takes instead: step of orientations [rad], mesh, meshes of the mesh study."""

    orientation_step: Annotated[Angle, Positive] = math.radians(5.0)
    """From 0 to the turn after which the wheel repeats itself [rad]."""
    factor: Factor = 1.0
    """In place of mesh.factor [-]."""
    mesh_study_factors: Annotated[tuple[Factor, ...], Field(min_length=3, max_length=3)] = (1.0, 2.0, 3.0)
    """In place of mesh_study.factors."""

    @model_validator(mode="after")
    def _increasing(self) -> FullSection:
        _far_apart("mesh_study_factors", self.mesh_study_factors)
        return self
