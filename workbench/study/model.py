"""The study: one frozen model of a whole study file.

Verified by tests/unit/test_workbench_study.py.
"""

from __future__ import annotations

import math
import tomllib
from functools import cache
from pathlib import Path
from typing import Annotated

from pydantic import Field, PrivateAttr, model_validator

from contracts.errors import InputError
from workbench.study.contact import PenaltyStudySection
from workbench.study.environment import EnvironmentSection
from workbench.study.fe_studies import FullSection, HubStudySection, MeshStudySection
from workbench.study.fit import AncfFitSection
from workbench.study.input_uncertainty import InputUncertaintySection
from workbench.study.quantities import Force, Length, Stiffness
from workbench.study.section import Positive, Section, in_key
from workbench.study.sections import (
    AncfSection,
    BrushSection,
    CurveSection,
    FeSection,
    GroundSection,
    MeshSection,
    RoverSection,
    ToleranceSection,
    VerificationSection,
)
from workbench.study.sweep import SweepSection
from workbench.study.wheel import WheelStudy

__all__ = ["Band", "BandPoint", "CompareSection", "Study", "stated", "thesis_band"]

DATA = Path(__file__).parents[1] / "data"
LARGEST_WHEEL_LOAD = 250.0


class BandPoint(Section):
    """Deflection [m] at which the average curve should reach a load [N]: between ``low`` and ``high``."""

    load: Annotated[Force, Positive]
    """[N]."""
    low: Annotated[Length, Positive]
    """Smallest deflection at this load [m]."""
    high: Annotated[Length, Positive]
    """Largest deflection at this load [m]."""

    @model_validator(mode="after")
    def _in_order(self) -> BandPoint:
        if self.low > self.high:
            rule, hint = f"must not exceed high = {1e3 * self.high:g} mm", "give the smaller deflection as low"
            raise in_key("low", f"{1e3 * self.low:g} mm", rule, hint)
        return self


class Band(Section):
    """What the average curve is held against: initial tangent [N/m] and deflections at loads, with their source."""

    initial_tangent: Annotated[Stiffness, Positive]
    """Slope of the average curve near first touch [N/m]."""
    points: Annotated[tuple[BandPoint, ...], Field(min_length=1)]
    """Deflections of the average curve at loads."""
    source: Annotated[str, Field(min_length=1)]
    """Where they come from."""


@cache
def thesis_band() -> Band:
    """The band inferred from the thesis, from the package's data file."""
    return Band.model_validate(tomllib.loads((DATA / "stiffness_band.toml").read_text(encoding="utf-8")))


class CompareSection(Section):
    """The user's own curves, if any."""

    curves: tuple[CurveSection, ...] = ()
    """Your own curves."""


def stated[T](section: T | None, name: str) -> T:
    """The section; raises InputError where the study has none of this name."""
    if section is None:
        raise InputError(f"[{name}]", "", "is not in the study", "add it, as in studies/exomars.toml")
    return section


class Study(WheelStudy):
    """A whole study file; SI after parsing. A section that is absent, None here, asks no question.

    Attributes
    ----------
    name, title : short name (file names, summary) and title of the report
    wheel, materials, mesh, fe : the wheel, its materials by name, its mesh, the continuum runs; every study has these
    ancf, brush : the reduced tires
    environment : other temperatures
    mesh_study : the meshes that give the numerical uncertainty of the FE curves
    full : what `workbench report --full` takes instead of the study's orientations and mesh
    rover : what the rover does
    ground : friction under the rover
    hub_study : where the compliance of hubs, cone and impact springs is measured
    penalty_study : where the load is held against other contact penalties
    verification : whether the benchmarks of finite elements and plates are part of the report
    sweep : what `workbench sweep` varies
    input_uncertainty : what is not known of the wheel as it is made; `workbench sample` draws from it
    ancf_fit : ANCF tires fitted to the FE curves
    compare, reference, tolerances : what results are held against
    inferred : key -> why: values that no publication states; the report lists them
    """

    title: Annotated[str, Field(min_length=1)]
    """Of the report."""
    mesh: MeshSection
    fe: FeSection
    mesh_study: MeshStudySection | None = None
    hub_study: HubStudySection | None = None
    penalty_study: PenaltyStudySection | None = None
    verification: VerificationSection | None = None
    full: FullSection = FullSection()
    rover: RoverSection | None = None
    ground: GroundSection = GroundSection()
    ancf: AncfSection | None = None
    ancf_fit: AncfFitSection | None = None
    brush: BrushSection | None = None
    sweep: SweepSection | None = None
    input_uncertainty: InputUncertaintySection | None = None
    compare: CompareSection = CompareSection()
    environment: EnvironmentSection | None = None
    reference: Band | None = None
    tolerances: ToleranceSection = ToleranceSection()
    inferred: dict[str, str] = Field(default_factory=dict)
    """Key -> why: values that no publication states."""
    _kept: Path | None = PrivateAttr(default=None)

    @property
    def kept(self) -> Path | None:
        """Folder beside the study's file with what named commands found; None for a study that was read from none."""
        return self._kept

    def kept_in(self, folder: Path) -> Study:
        """The same study, which keeps its records there."""
        self._kept = folder
        return self

    @property
    def judged_load(self) -> float:
        """Load up to which strength is judged [N]: 250, the largest of the thesis' sweep (Samarini 2020, section 3.2),
        or for any but the thesis' wheel what the runs are to carry if that is less."""
        return LARGEST_WHEEL_LOAD if self.tolerances.reference_wheel else min(LARGEST_WHEEL_LOAD, self.fe.max_load)

    @property
    def judged_deflection(self) -> float:
        """Deflection [m] up to which loads are judged: any of the thesis' wheel, else what the runs are to reach."""
        return math.inf if self.tolerances.reference_wheel else self.fe.max_deflection

    @model_validator(mode="after")
    def _reference_of_its_wheel(self) -> Study:
        """The wheel of the thesis is held against the thesis' band, unless the study states another."""
        if self.reference is None and self.tolerances.reference_wheel:
            return self.model_copy(update={"reference": thesis_band()})
        return self
