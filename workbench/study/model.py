"""The study: one frozen model of a whole study file.

Verified by tests/unit/test_workbench_study.py.
"""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import Annotated

from pydantic import Field

from workbench.study.contact import PenaltyStudySection
from workbench.study.environment import EnvironmentSection
from workbench.study.fe_studies import FullSection, HubStudySection, MeshStudySection
from workbench.study.fit import AncfFitSection
from workbench.study.ground import GroundSection
from workbench.study.quantities import Force, Length, Stiffness
from workbench.study.rover import RoverSection
from workbench.study.section import Positive, Section
from workbench.study.sections import (
    AncfSection,
    BrushSection,
    CurveSection,
    FeSection,
    MeshSection,
    ToleranceSection,
    VerificationSection,
)
from workbench.study.sweep import SweepSection
from workbench.study.wheel import WheelStudy

__all__ = ["Band", "BandPoint", "CompareSection", "Study", "thesis_band"]

DATA = Path(__file__).parents[1] / "data"


class BandPoint(Section):
    """Deflection [m] at which the average curve should reach a load [N]: between ``low`` and ``high``."""

    load: Annotated[Force, Positive]
    low: Annotated[Length, Positive]
    high: Annotated[Length, Positive]


class Band(Section):
    """What the average curve is held against: initial tangent [N/m] and deflections at loads, with their source."""

    initial_tangent: Annotated[Stiffness, Positive]
    points: Annotated[tuple[BandPoint, ...], Field(min_length=1)]
    source: Annotated[str, Field(min_length=1)]


@cache
def thesis_band() -> Band:
    """The band inferred from the thesis, from the package's data file."""
    return Band.model_validate(tomllib.loads((DATA / "stiffness_band.toml").read_text(encoding="utf-8")))


class CompareSection(Section):
    """The user's own curves, if any."""

    curves: tuple[CurveSection, ...] = ()


class Study(WheelStudy):
    """A whole study file; SI after parsing.

    Attributes
    ----------
    name, title : short name (file names, summary) and title of the report
    wheel, materials, mesh : the wheel, its materials by name, its mesh
    fe, ancf, brush : the three models' settings
    environment : other temperatures, if the study asks for them
    mesh_study : the meshes that give the numerical uncertainty of the FE curves
    full : what `workbench report --full` takes instead of the study's orientations and mesh
    rover : what the rover does on ANCF tires
    ground : friction under the rover
    hub_study : where the compliance of hubs, cone and impact springs is measured; None to leave it out
    penalty_study : where the load is held against other contact penalties; None to leave it out
    verification : whether the benchmarks of finite elements and plates are part of the report
    sweep : what `workbench sweep` varies; None to have no sweep
    ancf_fit : ANCF tires fitted to the FE curves; None to leave it out
    compare, reference, tolerances : what results are held against
    inferred : key -> why: values that no publication states; the report lists them
    """

    title: Annotated[str, Field(min_length=1)]
    mesh: MeshSection
    fe: FeSection
    mesh_study: MeshStudySection
    hub_study: HubStudySection | None = None
    penalty_study: PenaltyStudySection | None = None
    verification: VerificationSection = VerificationSection()
    full: FullSection = FullSection()
    rover: RoverSection = RoverSection()
    ground: GroundSection = GroundSection()
    ancf: AncfSection
    ancf_fit: AncfFitSection | None = None
    brush: BrushSection
    sweep: SweepSection | None = None
    compare: CompareSection = CompareSection()
    environment: EnvironmentSection | None = None
    reference: Band = Field(default_factory=thesis_band)
    tolerances: ToleranceSection = ToleranceSection()
    inferred: dict[str, str] = Field(default_factory=dict)
