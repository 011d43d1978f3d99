"""Sections of a study file about contact with the ground: its shape, and the study of the penalty.

Verified by tests/unit/test_workbench_contact.py.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from workbench.study.quantities import Angle, Length
from workbench.study.section import Positive, Section, in_key

__all__ = ["ObstacleSection", "PenaltyStudySection", "PlaneSection"]


def _require_round(edge_radius: float, most: float, of: str) -> None:
    """Refuse an edge radius [m] that a body's sizes leave no room for."""
    if edge_radius > most:
        raise in_key("edge_radius", f"{1e3 * edge_radius:g} mm", f"must not exceed the {of}", "give a smaller one")


class PlaneSection(Section):
    """Flat ground."""

    shape: Literal["plane"] = "plane"
    """Flat ground."""


class StepSection(Section):
    """A block's edge before the wheel: height over the lower ground, edge radius, place ahead of the hub [m], yaw."""

    shape: Literal["step"]
    """A block's edge."""
    height: Annotated[Length, Positive]
    """Over the lower ground [m]."""
    edge_radius: Annotated[Length, Positive]
    """Of the rounded edge, at most the height [m]."""
    position: Length = 0.0
    """Ahead of the hub [m]."""
    yaw: Angle = 0.0
    """About the vertical [rad]."""

    @model_validator(mode="after")
    def _round_its_edge_alone(self) -> Self:
        _require_round(self.edge_radius, self.height, "height")
        return self


class CleatSection(Section):
    """A bar across the ground: height, width and edge radius, place of its middle ahead of the hub [m], yaw."""

    shape: Literal["cleat"]
    """A bar."""
    height: Annotated[Length, Positive]
    """Of its top over the ground [m]."""
    width: Annotated[Length, Positive]
    """From side to side [m]."""
    edge_radius: Annotated[Length, Positive]
    """Of both rounded edges, at most the height and half the width [m]."""
    position: Length = 0.0
    """Of its middle, ahead of the hub [m]."""
    yaw: Angle = 0.0
    """Of the bar against the lateral [rad]."""

    @model_validator(mode="after")
    def _round_its_edges_alone(self) -> Self:
        _require_round(self.edge_radius, min(self.height, 0.5 * self.width), "height and half the width")
        return self


class RockSection(Section):
    """A half-round rock: radius, place of its axis ahead of the hub [m], yaw of the axis against the lateral [rad]."""

    shape: Literal["half_round_rock"]
    """A half-round rock."""
    radius: Annotated[Length, Positive]
    """Of the rock [m]."""
    position: Length = 0.0
    """Of its axis, ahead of the hub [m]."""
    yaw: Angle = 0.0
    """Of its axis against the lateral [rad]."""


ObstacleSection = Annotated[PlaneSection | StepSection | CleatSection | RockSection, Field(discriminator="shape")]


class PenaltyStudySection(Section):
    """How far the load depends on the contact penalty, at one orientation [rad] and deflection [m]."""

    orientation: Annotated[Angle, Field(ge=0.0, lt=2.0 * math.pi)]
    """Any [rad]."""
    deflection: Annotated[Length, Positive] = 0.010
    """Where loads are compared [m]."""
