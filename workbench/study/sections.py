"""Sections of a study file other than the wheel: materials, mesh, solvers, brush, comparison.

Every model is frozen and refuses unknown keys. All values are SI after parsing. Verified by
tests/unit/test_workbench_study.py.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import (
    AfterValidator,
    Field,
    StrictBool,
    StrictInt,
    ValidatorFunctionWrapHandler,
    field_validator,
    model_validator,
)
from pydantic_core import PydanticCustomError

from workbench.study.contact import ObstacleSection, PlaneSection
from workbench.study.quantities import Angle, Bedding, Density, Force, Length, Number, Pressure, Stiffness, Viscosity
from workbench.study.section import Positive, Section, in_key

__all__ = [
    "AncfSection",
    "BrushSection",
    "CurveSection",
    "Drop",
    "Factor",
    "FeSection",
    "MeshSection",
    "ToleranceSection",
    "VerificationSection",
]

NotNegative = Field(ge=0.0)
_LARGEST_WHEEL_LOAD = 250.0


def _all_different(orientations: tuple[float, ...]) -> tuple[float, ...]:
    """Refuse an orientation given twice: it would be computed twice under one name."""
    seen: set[float] = set()
    for angle in orientations:
        shown = round(math.degrees(angle), 6)
        if shown in seen:
            context = {"rule": f"holds {shown:g} deg twice", "hint": "give each orientation once"}
            raise PydanticCustomError("quantity", "{rule}; {hint}", context)
        seen.add(shown)
    return orientations


Orientations = Annotated[
    tuple[Annotated[Angle, Field(ge=0.0, lt=2.0 * math.pi)], ...], Field(min_length=1), AfterValidator(_all_different)
]
Drop = Annotated[Length, Positive]
Factor = Annotated[Number, Field(ge=1.0, le=6.0)]
GaussPoints = Annotated[StrictInt, Field(ge=1, le=10)]


class MeshSection(Section):
    """Mesh of the wheel: element lengths along strips and along the axle [m], counts, geometry order, symmetry.

    Every count of elements along strips and along the axle is then multiplied by ``factor`` and rounded up.
    """

    element_size: Annotated[Length, Positive]
    axial_size: Annotated[Length, Positive]
    thickness_elements: Annotated[StrictInt, Field(ge=1, le=8)] = 1
    order: Literal[1, 2] = 2
    factor: Factor = 1.0
    half_width: StrictBool = True
    refinement: dict[str, Annotated[Length, Positive]] = Field(default_factory=dict)


class FeSection(Section):
    """Continuum finite element runs: orientations [rad], deflections [m], loads [N] of the full wheel."""

    orientations: Orientations
    max_deflection: Drop
    points: Annotated[StrictInt, Field(ge=2, le=500)]
    max_load: Annotated[Force, Positive]
    snapshot_loads: tuple[Annotated[Force, Positive], ...] = ()
    keep_points: StrictBool = False
    """Whether fields are kept at every point of the curves too, for the viewer to play."""
    material_law: Literal["st_venant_kirchhoff", "neo_hookean"] = "st_venant_kirchhoff"
    contact_stiffness: Annotated[Bedding, Positive] | None = 1e11
    """None, written "auto", takes it from the local stiffness of the mesh."""
    contact_method: Literal["penalty", "augmented_lagrangian"] = "penalty"
    friction: Annotated[Number, NotNegative] = 0.0
    obstacle: ObstacleSection = PlaneSection()
    camber: Angle = 0.0
    inner_contact: StrictBool = True
    """Whether springs, rim and hubs hold each other off; else they pass through each other."""
    relative_tolerance: Annotated[Number, Positive] = 1e-8
    hub: Literal["rigid", "elastic"] = "rigid"
    """Rigid: the outer hub is held. Elastic: hubs, cone and impact springs deform; the inner hub's bore is held."""

    @field_validator("contact_stiffness", mode="wrap")
    @classmethod
    def _automatic(cls, value: object, check: ValidatorFunctionWrapHandler) -> object:
        return None if value == "auto" else check(value)

    @property
    def judged_load(self) -> float:
        """Load up to which strength is judged [N]: 250, the largest of the thesis' sweep (Samarini 2020, section 3.2),
        or what the runs are to carry if that is less."""
        return min(_LARGEST_WHEEL_LOAD, self.max_load)

    @property
    def turned(self) -> bool:
        """Whether the ground is turned out of the wheel's plane of symmetry."""
        return bool(self.camber or getattr(self.obstacle, "yaw", 0.0))


class VerificationSection(Section):
    """Whether the report runs the benchmarks of finite elements and plates, which do not depend on the study."""

    enabled: StrictBool = True


class AncfSection(Section):
    """The thesis' ANCF tire: dimensions [m], material, contact grid, orientations [rad], deflections [m]."""

    outer_radius: Annotated[Length, Positive]
    datum_radius: Annotated[Length, Positive] | None = None
    hub_radius: Annotated[Length, Positive]
    width: Annotated[Length, Positive]
    rim_thickness: Annotated[Length, Positive]
    spoke_thickness: Annotated[Length, Positive]
    circumferential_plates: Annotated[StrictInt, Field(ge=3, le=96)]
    spokes: Annotated[StrictInt, Field(ge=1, le=96)]
    phase: Angle = 0.0
    plates_per_spoke: Annotated[StrictInt, Field(ge=1, le=32)] = 1
    young_modulus: Annotated[Pressure, Positive]
    poisson_ratio: Annotated[Number, Field(gt=-1.0, lt=0.5)]
    density: Annotated[Density, Positive]
    contact_stiffness: Annotated[Stiffness, Positive]
    contact_points: tuple[Annotated[StrictInt, Field(ge=2, le=100)], Annotated[StrictInt, Field(ge=2, le=100)]]
    contact_layout: Literal["edges", "centres"] = "edges"
    quadrature: tuple[GaussPoints, GaussPoints, GaussPoints] = (5, 5, 3)
    orientations: Orientations
    max_deflection: Drop
    points: Annotated[StrictInt, Field(ge=2, le=500)]
    thesis_preset: StrictBool = False
    """True states that these are the thesis' numbers: the curve is then held against its known table."""
    surfaces: Annotated[str, Field(min_length=1)] | None = None
    """STEP file of the mid-surfaces of rim and spokes, in place of cylinder and planes; relative to the study file."""

    @model_validator(mode="after")
    def _phase_is_the_file_s(self) -> AncfSection:
        if self.surfaces is not None and self.phase != 0.0:
            rule = "must be 0 with surfaces, whose file says where the spokes stand"
            raise in_key("phase", f"{math.degrees(self.phase):g} deg", rule, "turn the surfaces in the file")
        return self


class BrushSection(Section):
    """The brush-type tire of Table II; slip stiffnesses read as N and N/rad."""

    radial_stiffness: Annotated[Stiffness, Positive]
    radial_damping: Annotated[Viscosity, NotNegative]
    longitudinal_slip_stiffness: Annotated[Force, Positive]
    cornering_stiffness_per_degree: Annotated[Force, Positive]
    friction_min: Annotated[Number, Positive]
    friction_max: Annotated[Number, Positive]
    rolling_resistance: Annotated[Number, NotNegative]
    source: Annotated[str, Field(min_length=1)]


class CurveSection(Section):
    """A user's own curve, e.g. digitised from a paper: CSV with ``deflection_m,load_N`` and where it comes from."""

    file: Annotated[str, Field(min_length=1)]
    label: Annotated[str, Field(min_length=1)]
    source: Annotated[str, Field(min_length=1)]
    compare_with: Literal["average", "orientation"] = "average"
    orientation: Annotated[Angle, Field(ge=0.0, lt=2.0 * math.pi)] | None = None

    @model_validator(mode="after")
    def _orientation_if_wanted(self) -> CurveSection:
        if (self.compare_with == "orientation") != (self.orientation is not None):
            rule, hint = 'belongs to compare_with = "orientation", and only there', "give both or neither"
            raise in_key("orientation", self.orientation, rule, hint)
        return self


class ToleranceSection(Section):
    """How far a number may lie off; relative unless a unit is named. The gates' defaults are the project's own."""

    initial_tangent: Annotated[Number, Positive] = 0.03
    initial_tangent_up_to: Annotated[Length, Positive] = 0.005
    initial_tangent_orientations: Orientations | None = None
    """Those of fe.orientations whose mean the slope is taken of; all of them by default."""
    ancf_preset: Annotated[Number, Positive] = 0.01
    ancf_fit: Annotated[Number, Positive] = 0.03
    flexible_mass: Annotated[Number, Positive] = 0.01
    mesh_mass: Annotated[Number, Positive] = 0.001
    min_scaled_jacobian: Annotated[Number, Positive] = 0.2
    reach_deflection: Annotated[Length, Positive] = 0.030
    reach_load: Annotated[Force, Positive] = 300.0
    fe_residual: Annotated[Number, Positive] = 1e-8
    fe_balance: Annotated[Number, Positive] = 1e-6
    fe_energy: Annotated[Number, Positive] = 0.01
    mesh_uncertainty: Annotated[Number, Positive] = 0.05
    hub_compliance: Annotated[Number, Positive] = 0.01
    surface_distance: Annotated[Length, Positive] = 1e-9
    section_agreement: Annotated[Number, Positive] = 0.05
    model_agreement: Annotated[Number, Positive] = 0.10
    iso_rating: Annotated[Number, Positive] = 0.80
    orientation_spread: Annotated[Number, Positive] = 0.50
    reference_wheel: StrictBool = False
    """True states that this wheel is the one the reference describes: slope and reach of its curves are then gates."""

    @property
    def asks_for_reach(self) -> bool:
        """Whether every orientation is to come somewhere: of the reference's wheel, and where a study says where to."""
        return self.reference_wheel or bool({"reach_deflection", "reach_load"} & self.model_fields_set)
