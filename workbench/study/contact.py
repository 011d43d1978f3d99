"""Sections of a study file about contact with the ground: its shape, and the study of the penalty.

Verified by tests/unit/test_workbench_contact.py.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field

from workbench.study.quantities import Angle, Length
from workbench.study.section import Positive, Section

__all__ = ["ObstacleSection", "PenaltyStudySection", "PlaneSection"]


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
    """Of the rounded edge [m]."""
    position: Length = 0.0
    """Ahead of the hub [m]."""
    yaw: Angle = 0.0
    """About the vertical [rad]."""


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


ObstacleSection = Annotated[PlaneSection | StepSection | RockSection, Field(discriminator="shape")]


class PenaltyStudySection(Section):
    """How far the load depends on the contact penalty, at one orientation [rad] and deflection [m]."""

    orientation: Annotated[Angle, Field(ge=0.0, lt=2.0 * math.pi)]
    """Any [rad]."""
    deflection: Annotated[Length, Positive] = 0.010
    """Where loads are compared [m]."""
