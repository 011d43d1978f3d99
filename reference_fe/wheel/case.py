"""The wheel's load case and what solving it gives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.errors import IncrementRecord, InputError
from contracts.hub_travel import HubTravel
from reference_fe.contact.obstacle import ContactMethod
from reference_fe.contact.obstacles import Obstacle, Plane
from reference_fe.material.hyperelastic import MaterialLaw
from reference_fe.solver.newton import NewtonSettings

__all__ = ["HUB_PARTS", "NO_STRIPS", "FieldSnapshot", "NamedFaces", "WheelLoadCase", "WheelResult"]

HUB_PARTS = ("outer_hub", "cone", "impact_springs", "inner_hub")
NO_STRIPS = ("tread", "grousers", "lattice_joints", *HUB_PARTS)
"""Parts that no bending strip is made of: rim, springs and a lattice's walls are."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NamedFaces:
    """Face groups of a mesh that geometry did not build, by what they do.

    Attributes
    ----------
    ground : those that may touch the obstacle
    held : those that are held, beside the rigid parts
    pairs : those that may touch each other, the first is held off the second

    Verified by tests/end_to_end/test_own_mesh.py.
    """

    ground: tuple[str, ...]
    held: tuple[str, ...] = ()
    pairs: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelLoadCase:
    """One orientation of the wheel pressed on a plane or another rigid obstacle.

    Attributes
    ----------
    orientation_deg : circumferential position that faces the ground [deg]
    deflections : wanted points of the curve, rise of the obstacle along its ground's normal from first touch [m]
    maximum_load : the run ends at the first point with at least this load [N]
    snapshot_loads : loads of the full wheel at which fields are kept [N]
    keep_points : whether fields are kept at every point of the curve too
    rigid_parts : parts held rigid, of those the mesh has; if the inner hub is not among them, its bore is held instead
    inner_contact : whether springs, rim and hubs hold each other off; else they pass through each other
    law : stored energy
    obstacle : what the wheel is pressed on; its s axis points forward, turned by its yaw about the ground's normal
    camber_deg : angle by which the obstacle is turned about the forward direction [deg]; positive lifts its left side
    contact_method : penalty or augmented Lagrangian, see `contact.obstacle.ContactMethod`
    contact_stiffness : penalty stiffness per undeformed area [N/m^3]; None is `contact.facets.local_stiffness`
    soil : modulus [N/m^(n+2)] and exponent of soil in place of rigid ground, or None
    friction : Coulomb coefficient on the obstacle [-]
    unload : whether the ground then goes back, through the same deflections until it leaves the wheel
    travel : what follows the last deflection, if anything does; over the ground it needs friction, off the middle
        plane the whole width
    inner_contact_stiffness : the same between the wheel's own parts [N/m^3]
    contact_ramp : gap at which the contact pressure begins [m], see `contact.law.ramped_pressure`
    gauss_points : Gauss points along the curved axis and the others of a cell, see `Discretisation`; a planar mesh
        takes the first two
    transverse_constraint : planar mesh only, part -> how it is held across the plane, see `plane_state`
    newton : tolerance and iteration limit
    faces : what face groups do; None goes by the names that `geometry.build` gives them
    """

    orientation_deg: float
    deflections: tuple[float, ...]
    maximum_load: float = float("inf")
    snapshot_loads: tuple[float, ...] = ()
    keep_points: bool = False
    rigid_parts: tuple[str, ...] = HUB_PARTS
    inner_contact: bool = True
    law: MaterialLaw = MaterialLaw.ST_VENANT_KIRCHHOFF
    obstacle: Obstacle = field(default_factory=Plane)
    camber_deg: float = 0.0
    contact_method: ContactMethod = ContactMethod.PENALTY
    contact_stiffness: float | None = 1e11
    soil: tuple[float, float] | None = None
    friction: float = 0.0
    unload: bool = False
    travel: HubTravel | None = None
    inner_contact_stiffness: float = 1e11
    contact_ramp: float = 5e-6
    gauss_points: tuple[int, ...] = (2, 3, 3)
    transverse_constraint: Mapping[str, float] = field(default_factory=dict)
    newton: NewtonSettings = field(default_factory=NewtonSettings)
    faces: NamedFaces | None = None

    def __post_init__(self) -> None:
        if not np.isfinite(self.orientation_deg):
            raise InputError("orientation", f"{self.orientation_deg} deg", "must be finite", "give degrees, e.g. 15")
        if not abs(self.camber_deg) < 90.0:
            raise InputError("camber", f"{self.camber_deg} deg", "must lie between -90 and 90 deg", "e.g. 10")
        if not self.maximum_load > 0.0:
            raise InputError("maximum load", f"{self.maximum_load:g} N", "must be > 0", "300 N covers the reference")
        if self.travel is not None and self.travel.slides and not self.friction > 0.0:
            rule = "must be > 0 for a wheel that moves over the ground: without, nothing resists"
            raise InputError("friction coefficient", f"{self.friction:g}", rule, "0.6 is the thesis'")
        if self.travel is not None and self.travel.start != self.deflections[-1]:
            rule = f"must be the last deflection, {1e3 * self.deflections[-1]:g} mm"
            raise InputError("start of a travel", f"{1e3 * self.travel.start:g} mm", rule, "press it to there")
        if self.travel is not None and self.unload:
            raise InputError("unloading", "", "does not go with a travel of the hub", "ask for one of them")
        if self.soil is not None and self.unload:
            rule = "presses by its depth alone and would come back whole, where soil leaves a rut"
            raise InputError("unloading", "on soil", rule, "ask for one of them")


@dataclass(frozen=True, slots=True, kw_only=True)
class FieldSnapshot:
    """Fields at one load.

    Attributes
    ----------
    load : load of the full wheel [N]
    deflection : rise of the plane from first touch [m]
    displacement : (n_points, dim) at the mesh's nodes [m], wheel frame
    von_mises : (n_points,) Cauchy von Mises stress averaged at the nodes [Pa]; 0 on rigid parts
    principal_stress : (n_points, 3) Cauchy principal stresses at the nodes [Pa], descending; None where not kept
    """

    load: float
    deflection: float
    displacement: NDArray[np.float64]
    von_mises: NDArray[np.float64]
    principal_stress: NDArray[np.float64] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelResult:
    """Curve, increments and fields of one orientation.

    Attributes
    ----------
    curve : load of the full wheel against the plane's rise from first touch; columns as in `solve_wheel`
    unloading : curve of the way back, if the load case has one and came to turn: from the permanent set, the deflection
        at which no load is left, or partial
    travelled : rows behind it, if the load case has a travel: ``control`` [m] of the travel and the curve's columns
    increments : every attempted increment, in order
    snapshots : fields at the chosen loads that were reached
    points : fields at the points of the curve behind first touch, without principal stresses, if the load case keeps
        them
    dofs : number of displacement unknowns
    distance_at_touch : distance of hub and plane at first touch [m]
    wall_s : wall time of the solve [s]
    """

    curve: StiffnessCurve
    unloading: StiffnessCurve | None = None
    travelled: tuple[Mapping[str, float], ...] = ()
    increments: tuple[IncrementRecord, ...]
    snapshots: tuple[FieldSnapshot, ...]
    points: tuple[FieldSnapshot, ...]
    dofs: int
    distance_at_touch: float
    wall_s: float
