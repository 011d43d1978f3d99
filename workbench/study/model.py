"""The study: one frozen model of a whole study file.

Verified by tests/unit/test_workbench_study.py.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

from pydantic import Discriminator, Field, PrivateAttr, Tag, model_validator

from contracts.errors import InputError
from workbench.study.contact import PenaltyStudySection
from workbench.study.environment import EnvironmentSection
from workbench.study.fe_studies import FullSection, HubStudySection, MeshStudySection
from workbench.study.fit import AncfFitSection
from workbench.study.input_uncertainty import InputUncertaintySection
from workbench.study.optimise import OptimiseSection
from workbench.study.own_mesh_section import OwnMeshSection
from workbench.study.reference import INITIAL, CurveReference, ReferenceSection, told
from workbench.study.section import in_key
from workbench.study.sections import (
    AncfSection,
    AncfWheelSection,
    BrushSection,
    FeSection,
    GroundSection,
    MeshSection,
    RoverSection,
    ToleranceSection,
    VerificationSection,
)
from workbench.study.soil_section import SoilSection
from workbench.study.sweep import SweepSection
from workbench.study.wheel import WheelStudy

__all__ = ["Study", "stated"]

DATA = Path(__file__).parents[1] / "data"
LARGEST_WHEEL_LOAD = 250.0


def stated[T](section: T | None, name: str) -> T:
    """The section; raises InputError where the study has none of this name."""
    if section is None:
        raise InputError(f"[{name}]", "", "is not in the study", "add it, as in studies/exomars.toml")
    return section


def _mesh_kind(table: object) -> str:
    """Which of its two kinds a section [mesh] is."""
    own = "file" in table if isinstance(table, dict) else isinstance(table, OwnMeshSection)
    return "of a file" if own else "of sizes"


class Study(WheelStudy):
    """A whole study file; SI after parsing. A section that is absent, None here, asks no question.

    Attributes
    ----------
    name, title : short name (file names, summary) and title of the report
    wheel, materials, mesh, fe : the wheel, its materials by name, its mesh, the continuum runs; every study has these
    ancf, brush : the reduced tires
    ancf_wheel : the wheel itself as ANCF plates
    environment : other temperatures
    mesh_study : the meshes that give the numerical uncertainty of the FE curves
    full : what `workbench report --full` takes instead of the study's orientations and mesh
    rover : what the rover does
    ground : friction under the rover
    soil : soils that the wheel drives on, one at a time
    hub_study : where the compliance of hubs, cone and impact springs is measured
    penalty_study : where the load is held against other contact penalties
    verification : whether the benchmarks of finite elements and plates are part of the report
    sweep : what `workbench sweep` varies
    optimise : what `workbench optimise` looks for
    input_uncertainty : what is not known of the wheel as it is made; `workbench sample` draws from it
    ancf_fit : ANCF tires fitted to the FE curves
    reference : what the wheel's stiffness is judged by; None: by nothing
    tolerances : how far results may lie off
    inferred : key -> why: values that no publication states; the report lists them
    """

    title: Annotated[str, Field(min_length=1)]
    """Of the report."""
    mesh: Annotated[
        Annotated[MeshSection, Tag("of sizes")] | Annotated[OwnMeshSection, Tag("of a file")], Discriminator(_mesh_kind)
    ]
    fe: FeSection
    mesh_study: MeshStudySection | None = None
    hub_study: HubStudySection | None = None
    soil: SoilSection | None = None
    penalty_study: PenaltyStudySection | None = None
    verification: VerificationSection | None = None
    full: FullSection = FullSection()
    rover: RoverSection | None = None
    ground: GroundSection = GroundSection()
    ancf: AncfSection | None = None
    ancf_fit: AncfFitSection | None = None
    ancf_wheel: AncfWheelSection | None = None
    brush: BrushSection | None = None
    sweep: SweepSection | None = None
    optimise: OptimiseSection | None = None
    input_uncertainty: InputUncertaintySection | None = None
    environment: EnvironmentSection | None = None
    reference: ReferenceSection | None = None
    tolerances: ToleranceSection = ToleranceSection()
    inferred: dict[str, str] = Field(default_factory=dict)
    """Key -> why: values that no publication states."""
    _kept: Path | None = PrivateAttr(default=None)

    @model_validator(mode="after")
    def _has_a_wheel(self) -> Study:
        if self.wheel is None and isinstance(self.mesh, MeshSection):
            raise in_key("wheel", "", "is missing", "add it to the study file, or give its own mesh, mesh.file")
        return self

    @property
    def kept(self) -> Path | None:
        """Folder beside the study's file with what named commands found; None for a study that was read from none."""
        return self._kept

    def kept_in(self, folder: Path) -> Study:
        """The same study, which keeps its records there."""
        self._kept = folder
        return self

    @property
    def of_the_thesis(self) -> bool:
        """Whether the wheel is the one that the thesis speaks of, so that its words are asked of it."""
        return self.reference is not None and self.reference.thesis_words

    @property
    def reference_curves(self) -> tuple[CurveReference, ...]:
        """Whole curves of the reference, if any."""
        return () if self.reference is None else self.reference.curves

    @property
    def reference_told(self) -> str:
        """What its stiffness is judged by, in a few sentences."""
        return told(self.reference)

    @property
    def tangent_up_to(self) -> float:
        """Deflection up to which the initial tangent is taken [m]: that of the reference's slope, or 5 mm."""
        slope = None if self.reference is None else self.reference.slope
        return INITIAL if slope is None else slope.up_to

    @property
    def asks_for_reach(self) -> bool:
        """Whether every orientation is to come somewhere: of the thesis' wheel, and where a study says where to."""
        return self.of_the_thesis or bool({"reach_deflection", "reach_load"} & self.tolerances.model_fields_set)

    @property
    def judged_load(self) -> float:
        """Load up to which strength is judged [N]: 250, the largest of the thesis' sweep (Samarini 2020, section 3.2),
        or for any but the thesis' wheel what the runs are to carry if that is less."""
        return LARGEST_WHEEL_LOAD if self.of_the_thesis else min(LARGEST_WHEEL_LOAD, self.fe.max_load)

    @property
    def judged_deflection(self) -> float:
        """Deflection [m] up to which loads are judged: any of the thesis' wheel, else what the runs are to reach."""
        return math.inf if self.of_the_thesis else self.fe.max_deflection
