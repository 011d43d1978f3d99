"""The numbers of an ANCF tire: a rim of curved plates on radial spokes."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated, Literal, get_args

from ancf_reduced.contact.layout import ContactLayout
from contracts.declared import (
    Angle,
    In,
    PositiveDensity,
    PositiveLength,
    PositivePressure,
    PositiveStiffness,
    Whole,
    require_declared,
)
from contracts.errors import InputError

__all__ = ["HUB_REACH", "RIM", "SPOKE", "ContactDamping", "TirePreset", "refined_preset", "thesis_preset"]

GaussPoints = Annotated[int, Whole(1, 10)]
ContactDamping = Literal["as_printed", "hunt_crossley", "none"]
RIM, SPOKE = "rim", "spoke"
"""Names of a tire's parts."""
HUB_REACH = 1e-6
"""How far beyond the hub radius a node still belongs to the hub [m]: files round."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TirePreset:
    """A cylinder of plates carried by radial plates, as in thesis section 3.3.

    Attributes
    ----------
    outer_radius : R, nominal radius of the outer face [m]; the rim's mid-surface has R - rim_thickness/2
    datum_radius : distance of the hub from the ground at zero deflection [m]; R if None. A fitted R may differ from it
    hub_radius : where the spokes begin [m]; they end at the rim's mid-surface
    width : axial width [m]
    rim_thickness, spoke_thickness : t [m]
    circumferential_plates : plates around the rim, a multiple of ``spokes``
    spokes : radial spokes, evenly spaced
    phase : where the first spoke stands [rad]; rim nodes turn with it
    plates_per_spoke : plates along each spoke; one in the thesis, which locks in bending (see `refined_preset`)
    young_modulus : E [Pa]
    poisson_ratio : nu [-]
    density : rho [kg/m^3]
    contact_stiffness : k per contact point [N/m]
    contact_damping : what damps a contact point under the rover. ``"hunt_crossley"``: in proportion to its penetration;
        ``"as_printed"``: the thesis' constant c / k = 0.1 s; ``"none"``
    contact_points : points per rim plate, along the circumference and across the width
    contact_layout : ``"edges"``: points at i/(n-1), so rows at a node count for both plates; ``"centres"``: (i+1/2)/n
    quadrature : Gauss points along x1, x2, x3

    Raises
    ------
    InputError
        For a value out of its range.

    Verified by tests/unit/test_ancf_tire_preset.py.
    """

    outer_radius: PositiveLength
    datum_radius: PositiveLength | None = None
    hub_radius: PositiveLength
    width: PositiveLength
    rim_thickness: PositiveLength
    spoke_thickness: PositiveLength
    circumferential_plates: Annotated[int, Whole(3, 96)]
    spokes: Annotated[int, Whole(1, 96)]
    phase: Angle = 0.0
    plates_per_spoke: Annotated[int, Whole(1, 32)] = 1
    young_modulus: PositivePressure
    poisson_ratio: Annotated[float, In("", above=-1.0, below=0.5)]
    density: PositiveDensity
    contact_stiffness: PositiveStiffness
    contact_points: tuple[Annotated[int, Whole(2, 100)], Annotated[int, Whole(2, 100)]]
    contact_layout: ContactLayout = "edges"
    contact_damping: ContactDamping = "hunt_crossley"
    quadrature: tuple[GaussPoints, GaussPoints, GaussPoints] = (5, 5, 3)

    def __post_init__(self) -> None:
        require_declared(self)
        if self.datum_radius is not None and not self.hub_radius < self.datum_radius < math.inf:
            rule = f"must be finite and above the hub's, {1e3 * self.hub_radius:g} mm"
            raise InputError(
                "datum radius", f"{1e3 * self.datum_radius:g} mm", rule, "leave it out", key="datum_radius"
            )
        if self.hub_radius >= self.rim_radius - 0.5 * self.rim_thickness:
            limit = 1e3 * (self.rim_radius - 0.5 * self.rim_thickness)
            rule = f"must be below the rim's inner radius, {limit:g} mm"
            raise InputError(
                "hub radius", f"{1e3 * self.hub_radius:g} mm", rule, "give a smaller hub", key="hub_radius"
            )
        if self.circumferential_plates % self.spokes:
            raise InputError(
                "circumferential plates",
                f"{self.circumferential_plates} with {self.spokes} spokes",
                "must be a multiple of the spokes",
                "give 4, 8, 12, ... plates for 4 spokes",
                key="circumferential_plates",
            )
        if self.contact_layout not in ("edges", "centres"):
            raise InputError(
                "contact layout", self.contact_layout, "must be edges or centres", "use edges", key="contact_layout"
            )
        if self.contact_damping not in get_args(ContactDamping):
            rule = f"must be one of {', '.join(get_args(ContactDamping))}"
            raise InputError(
                "contact damping", self.contact_damping, rule, "leave it out: hunt_crossley", key="contact_damping"
            )

    @property
    def zero_radius(self) -> float:
        """Distance of the hub from the ground at zero deflection [m]."""
        return self.outer_radius if self.datum_radius is None else self.datum_radius

    @property
    def rim_radius(self) -> float:
        """Radius of the rim's mid-surface, R - t/2 [m]."""
        return self.outer_radius - 0.5 * self.rim_thickness


def thesis_preset() -> TirePreset:
    """The thesis' 8-plate tire (section 3.3); the dimensions it does not print are those of theory notes, section 7.

    E = 280 kPa, nu = 0, rho = 1500 kg/m^3, k = 1000 N/m and 100 points per plate are printed in thesis section 3.3;
    R = 142.5 mm and width 120 mm are the published wheel's; t = 25 mm, hub radius 50 mm, the points' layout (edges
    included) and 5 x 5 x 3 Gauss points are this project's choice.

    Verified by tests/verification/test_ancf_tire_table.py.
    """
    return TirePreset(
        outer_radius=0.1425,
        hub_radius=0.050,
        width=0.120,
        rim_thickness=0.025,
        spoke_thickness=0.025,
        circumferential_plates=4,
        spokes=4,
        plates_per_spoke=1,
        young_modulus=280.0e3,
        poisson_ratio=0.0,
        density=1500.0,
        contact_stiffness=1000.0,
        contact_points=(10, 10),
        contact_layout="edges",
        contact_damping="as_printed",
        quadrature=(5, 5, 3),
    )


def refined_preset(preset: TirePreset, circumferential_plates: int, plates_per_spoke: int = 1) -> TirePreset:
    """The same tire with a finer mesh and the same contact stiffness per area.

    The points per rim plate stay; k per point is scaled by old plates / new plates, so the sum of k stays the same.
    The 4 + 4 plates of the thesis are far from converged (see the test below), and plates shorter than thick soften
    the T-sections (see plate_mesh), so there is no limit of ever finer meshes.

    Verified by tests/verification/test_ancf_tire_refinement.py.
    """
    scale = preset.circumferential_plates / circumferential_plates if circumferential_plates > 0 else 1.0
    return replace(
        preset,
        circumferential_plates=circumferential_plates,
        plates_per_spoke=plates_per_spoke,
        contact_stiffness=preset.contact_stiffness * scale,
    )
