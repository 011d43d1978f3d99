"""Sections of a study file other than the wheel: materials, mesh, solvers, brush, comparison, rover and its ground.

Every model is frozen and refuses unknown keys. All values are SI after parsing. Verified by
tests/unit/test_workbench_study.py, tests/unit/test_workbench_rover_inputs.py and
tests/unit/test_workbench_rover_ancf.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
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

from ancf_reduced.tire.preset import ContactDamping, TirePreset
from rover_dynamics.tires.brush_tire import BrushTireParameters
from workbench.study.contact import ObstacleSection, PlaneSection
from workbench.study.declared import reads
from workbench.study.quantities import Angle, Bedding, Force, Length, Number
from workbench.study.section import Positive, Section, in_key

__all__ = [
    "AncfSection",
    "AncfWheelSection",
    "BrushSection",
    "Drop",
    "Factor",
    "FeSection",
    "GroundSection",
    "MeshSection",
    "RoverSection",
    "ToleranceSection",
    "VerificationSection",
    "runs_on_ancf_tires",
]

NotNegative = Field(ge=0.0)


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


class MeshSection(Section):
    """Mesh of the wheel: element lengths along strips and along the axle [m], counts, geometry order, symmetry.

    Every count of elements along strips and along the axle is then multiplied by ``factor`` and rounded up.
    """

    element_size: Annotated[Length, Positive]
    """Length of elements along strips and around rings [m]."""
    axial_size: Annotated[Length, Positive]
    """Length of elements along the axle [m]."""
    edge_size: Annotated[Length, Positive] | None = None
    """Length along the axle of the elements at the edges of strips [m], where they curl; ``axial_size`` without it."""
    thickness_elements: Annotated[StrictInt, Field(ge=1, le=8)] = 1
    """Elements through a strip."""
    order: Literal[1, 2] = 2
    """Of the geometry: 1 straight, 2 curved hexahedra."""
    factor: Factor = 1.0
    """Counts of elements along strips and axle are multiplied by it [-]."""
    half_width: StrictBool = True
    """Whether half the wheel is meshed, on the symmetry about its mid-plane; loads are those of the whole."""
    refinement: dict[str, Annotated[Length, Positive]] = Field(default_factory=dict)
    """Part -> its own length of elements [m]."""


class FeSection(Section):
    """Continuum finite element runs: orientations [rad], deflections [m], loads [N] of the full wheel."""

    orientations: Orientations
    """What faces the ground, from the lowest point towards the front [rad]; a curve each."""
    max_deflection: Drop
    """How far the hub drops from first touch [m]."""
    points: Annotated[StrictInt, Field(ge=2, le=500)]
    """Of a curve, in equal steps."""
    max_load: Annotated[Force, Positive]
    """A run ends at its first point with this load of the whole wheel [N]."""
    snapshot_loads: tuple[Annotated[Force, Positive], ...] = ()
    """Loads at which fields are kept [N]."""
    keep_points: StrictBool = False
    """Whether fields are kept at every point of the curves too, for the viewer to play."""
    material_law: Literal["st_venant_kirchhoff", "neo_hookean"] = "st_venant_kirchhoff"
    """Of every part whose material has no law of its own."""
    contact_stiffness: Annotated[Bedding, Positive] | None = 1e11
    """None, written "auto", takes it from the local stiffness of the mesh."""
    contact_method: Literal["penalty", "augmented_lagrangian"] = "penalty"
    """How the ground holds the wheel off."""
    friction: Annotated[Number, NotNegative] = 0.0
    """Coulomb's coefficient on the ground of the static runs [-]."""
    unload: StrictBool = False
    """Whether the ground then goes back until it leaves the wheel: a curve of its own, with what set remains."""
    obstacle: ObstacleSection = PlaneSection()
    """What the wheel is pressed on."""
    camber: Angle = 0.0
    """Of the ground about the forward direction [rad]; needs half_width = false."""
    inner_contact: StrictBool = True
    """Whether springs, rim and hubs hold each other off; else they pass through each other."""
    relative_tolerance: Annotated[Number, Positive] = 1e-8
    """Of an increment: residual over support and contact forces [-]."""
    hub: Literal["rigid", "elastic"] = "rigid"
    """Rigid: the outer hub is held. Elastic: hubs, cone and impact springs deform; the inner hub's bore is held."""

    @field_validator("contact_stiffness", mode="wrap")
    @classmethod
    def _automatic(cls, value: object, check: ValidatorFunctionWrapHandler) -> object:
        return None if value == "auto" else check(value)

    @property
    def turned(self) -> bool:
        """Whether the ground is turned out of the wheel's plane of symmetry."""
        return bool(self.camber or getattr(self.obstacle, "yaw", 0.0))


class VerificationSection(Section):
    """Whether the report runs the benchmarks of finite elements and plates, which do not depend on the study."""

    enabled: StrictBool = True
    """Whether the benchmarks are run."""


@reads(TirePreset)
class AncfSection(Section):
    """The thesis' ANCF tire: dimensions [m], material, contact grid, orientations [rad], deflections [m]."""

    phase: Angle = 0.0
    """Of the first spoke, from the lowest point towards the front [rad]."""
    orientations: Orientations
    """As of [fe] [rad]; a curve each."""
    max_deflection: Drop
    """How far the hub drops from the datum radius [m]."""
    points: Annotated[StrictInt, Field(ge=2, le=500)]
    """Of a curve, in equal steps."""
    thesis_preset: StrictBool = False
    """True states that these are the thesis' numbers: the curve is then held against its known table."""
    contact_damping: ContactDamping | None = None
    """What damps a contact point under the rover; without it "as_printed" with thesis_preset, else "hunt_crossley"."""
    surfaces: Annotated[str, Field(min_length=1)] | None = None
    """STEP file of the mid-surfaces of rim and spokes, in place of cylinder and planes; relative to the study file."""

    @model_validator(mode="after")
    def _phase_is_the_file_s(self) -> AncfSection:
        if self.surfaces is not None and self.phase != 0.0:
            rule = "must be 0 with surfaces, whose file says where the spokes stand"
            raise in_key("phase", f"{math.degrees(self.phase):g} deg", rule, "turn the surfaces in the file")
        return self


@reads(BrushTireParameters, "cornering_stiffness")
class BrushSection(Section):
    """The brush-type tire of Table II; slip stiffnesses read as N and N/rad."""

    cornering_stiffness_per_degree: Annotated[Force, Positive]
    """Lateral force per degree of slip angle at zero slip [N]."""


class ToleranceSection(Section):
    """How far a number may lie off; relative unless a unit is named. The gates' defaults are the project's own."""

    initial_tangent: Annotated[Number, Positive] = 0.03
    """Slope against that of [reference], relative [-]."""
    ancf_preset: Annotated[Number, Positive] = 0.01
    """Curves of the thesis' tire against their known table, relative [-]."""
    ancf_fit: Annotated[Number, Positive] = 0.03
    """Fitted ANCF tires against the FE average, relative to the load [-]."""
    flexible_mass: Annotated[Number, Positive] = 0.01
    """Mass of the ANCF plates against Table I, relative [-]."""
    mesh_mass: Annotated[Number, Positive] = 0.001
    """Volume and mass of the mesh against closed form, relative [-]."""
    min_scaled_jacobian: Annotated[Number, Positive] = 0.2
    """Of the worst cell, at least [-]."""
    reach_deflection: Annotated[Length, Positive] = 0.030
    """Each orientation is to come so far [m], or to ``reach_load``."""
    reach_load: Annotated[Force, Positive] = 300.0
    """Each orientation is to carry so much [N], or to come to ``reach_deflection``."""
    fe_energy: Annotated[Number, Positive] = 0.01
    """Work against stored energy, relative [-]."""
    mesh_uncertainty: Annotated[Number, Positive] = 0.05
    """Grid convergence index of the load [-]."""
    stress_uncertainty: Annotated[Number, Positive] = 0.05
    """Grid convergence index of the stress that decides first yield [-]."""
    hub_compliance: Annotated[Number, Positive] = 0.01
    """What elastic hubs change of the load, relative [-]."""
    soil_models: Annotated[Number, Positive] = 0.02
    """ANCF wheel against the solid model at rest on soil: load at the same way of the hub [-]."""
    soil_bench: Annotated[Number, Positive] = 0.1
    """The bench's wheel against the solid model at rest on soil: way of the hub and sinkage [-]."""
    surface_distance: Annotated[Length, Positive] = 1e-12
    """STEP surfaces of the ANCF tire against its plates [m]."""
    section_agreement: Annotated[Number, Positive] = 0.05
    """Planar against solid model, relative [-]."""
    ancf_wheel_largest: Annotated[Number, Positive] = 0.02
    """Load of the ANCF wheel against the solid model, largest at any orientation and point, relative [-]."""
    ancf_wheel_mean: Annotated[Number, Positive] = 0.01
    """The same, mean over orientations and points [-]."""
    ancf_wheel_stress: Annotated[Number, Positive] = 0.05
    """Largest stress of its springs against the solid model, at any orientation and point, relative [-]."""
    ancf_wheel_shape: Annotated[Length, Positive] = 1e-4
    """Distance of its deformed middle surfaces from the solid model's, root of the mean square [m]."""
    model_agreement: Annotated[Number, Positive] = 0.10
    """ANCF, brush and the curves of [reference] against FE: relative L2 difference [-]."""
    orientation_spread: Annotated[Number, Positive] = 0.50
    """(Largest - smallest) / mean load over the orientations [-]."""


class AncfWheelSection(Section):
    """The wheel as thin ANCF plates, held against the solid model at ``fe.orientations``.

    Asked with a rigid hub, the law of St. Venant and Kirchhoff and a stated penalty of the contact.
    """

    element_size: Annotated[Length, Positive] = 16e-3
    """Largest length of a plate along strips and around the rim [m]; a leg has eight plates at least."""
    axial_size: Annotated[Length, Positive] = 18e-3
    """Largest length of a plate along the axle [m]."""


class GroundSection(Section):
    """Coulomb's coefficient between the ground and the rover's tires, of whatever kind.

    Without it the brush tire has the friction of [brush], falling with slip, ANCF tires the thesis' 0.6, and all of
    them 0.6 in the scenario that the thesis drives with it. [fe] friction is that of the static runs.
    """

    friction: Annotated[Number, Positive] | None = None
    """Of every tire under the rover [-]; each tire's own without it."""


class RoverSection(Section):
    """What the rover does on six ANCF tires in the report, beside its runs on brush tires.

    Nothing, the thesis' scenarios and the quick ones of the mission's (about a minute), or all of them, as `workbench
    report --full` does (some minutes more).
    """

    on_ancf_tires: Literal["none", "short", "all"] = "short"
    """Runs on flexible tires beside those on brush tires: none, the thesis' and quick ones, all."""
    brush: Literal["study", "wheel"] = "study"
    """Whose numbers its brush tires have: those of [brush], or the wheel's that `workbench calibrate brush` keeps."""


def runs_on_ancf_tires(rover: RoverSection | None, short: Iterable[str], long: Iterable[str]) -> tuple[str, ...]:
    """Which of the short and the long runs a study asks for."""
    asked = "none" if rover is None else rover.on_ancf_tires
    return {"none": (), "short": tuple(short), "all": (*short, *long)}[asked]
