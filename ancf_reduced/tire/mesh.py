"""The airless tire as a network of plates: a client of `plates.mesh` (thesis sections 2.3.3 to 2.3.5 and 3.3)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.contact.grid import ContactGrid, build_contact_grid
from ancf_reduced.motion.reference_node import ReferenceNodeTie, tie_reference_node
from ancf_reduced.plates.mesh import PlateMesh, PlatePatch, build_plate_mesh
from ancf_reduced.plates.model import PlateModel, build_plate_model
from ancf_reduced.plates.shape_functions import THESIS_SHAPE, PlateShape
from ancf_reduced.tire.preset import HUB_REACH, RIM, SPOKE, TirePreset
from contracts.frames import ground_direction_h

__all__ = ["RIM", "SPOKE", "Tire", "arc_tangent_length", "build_tire", "rim_patch", "spoke_patch", "tire_on_mesh"]

FloatArray = NDArray[np.float64]


def arc_tangent_length(angle: float) -> float:
    """Length of r_x1 that makes a cubic with x1 in arc length follow a circular arc: (4/alpha) tan(alpha/4) [-].

    Unit tangents leave a 90 deg arc 1.5 % too small at mid-element; this leaves less than 0.03 %. ``angle`` in rad.

    Verified by tests/unit/test_ancf_tire_mesh.py.
    """
    return float(4.0 / angle * np.tan(angle / 4.0))


def _directions(phi: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Unit vectors at circumferential position phi: radial (outwards), tangent (towards +phi), and -y."""
    radial = ground_direction_h(phi)
    return radial, ground_direction_h(phi + 0.5 * np.pi), np.array([0.0, -1.0, 0.0])


def rim_patch(
    preset: TirePreset, start: float, angle: float, tangent_length: Callable[[float], float] = arc_tangent_length
) -> PlatePatch:
    """One rim plate from phi = start to start + angle [rad]: x1 along the arc, x2 along -y, director outwards.

    x1 is the arc length of the mid-surface; directors have unit length at the nodes and, interpolated bilinearly, are
    shorter between them (the thesis' mesh: kept, see `outer_face_error` in tire_surfaces).
    """
    corners, gradients = np.empty((4, 3)), np.empty((4, 3, 3))
    half = 0.5 * preset.width
    for k, (phi, y) in enumerate([(start, half), (start + angle, half), (start + angle, -half), (start, -half)]):
        radial, tangent, across = _directions(phi)
        corners[k] = preset.rim_radius * radial - y * across
        gradients[k] = np.column_stack([tangent_length(angle) * tangent, across, radial])
    dimensions = np.array([preset.rim_radius * angle, preset.width, preset.rim_thickness])
    return PlatePatch(corners=corners, gradients=gradients, dimensions=dimensions, part=RIM)


def spoke_patch(preset: TirePreset, phi: float, part: int = 0) -> PlatePatch:
    """Plate ``part`` of the spoke at phi [rad], counted from the hub; x1 radially outwards, x2 along -y.

    The spoke goes from the hub radius to the rim's mid-surface, where it shares the rim's nodes (a T-section).
    """
    radial, tangent, across = _directions(phi)
    length = (preset.rim_radius - preset.hub_radius) / preset.plates_per_spoke
    inner = (preset.rim_radius - (preset.plates_per_spoke - part) * length) * radial
    outer = (preset.rim_radius - (preset.plates_per_spoke - part - 1) * length) * radial
    edge = 0.5 * preset.width * across
    return PlatePatch(
        corners=np.array([inner - edge, outer - edge, outer + edge, inner + edge]),
        gradients=np.repeat(np.column_stack([radial, across, -tangent])[None], 4, axis=0),
        dimensions=np.array([length, preset.width, preset.spoke_thickness]),
        part=SPOKE,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Tire:
    """One tire, constant data: mesh, elastic model, contact points, hub tied to the reference node at the hub centre.

    Attributes
    ----------
    preset : the numbers it was built from
    model : plates with material and integration points; ``model.mesh`` has the parts "rim" and "spoke"
    grid : contact points on the rim's outer face
    tie : hub nodes -> reference node (thesis eq. 2.20)

    Verified by tests/unit/test_ancf_tire_mesh.py.
    """

    preset: TirePreset
    model: PlateModel
    grid: ContactGrid
    tie: ReferenceNodeTie

    @property
    def mesh(self) -> PlateMesh:
        """The plates, in the wheel frame."""
        return self.model.mesh


def build_tire(
    preset: TirePreset,
    *,
    shape: PlateShape = THESIS_SHAPE,
    tangent_length: Callable[[float], float] = arc_tangent_length,
) -> Tire:
    """Build a tire in the wheel frame (x forward, y along the axle, z up), spokes at its phase + 0, 360/n, ... deg.

    Parameters
    ----------
    preset : the tire's numbers
    shape, tangent_length : interpolation, and |r_x1| [-] at the rim's nodes from a plate's angle [rad]; arguments so
        that a test can damage them

    Verified by tests/verification/test_ancf_tire_table.py.
    """
    angle = 2.0 * np.pi / preset.circumferential_plates
    starts = preset.phase + angle * np.arange(preset.circumferential_plates)
    rim = [rim_patch(preset, float(start), angle, tangent_length) for start in starts]
    spokes = [
        spoke_patch(preset, preset.phase + 2.0 * np.pi * i / preset.spokes, part)
        for i in range(preset.spokes)
        for part in range(preset.plates_per_spoke)
    ]
    return tire_on_mesh(preset, build_plate_mesh([*rim, *spokes]), shape)


def tire_on_mesh(preset: TirePreset, mesh: PlateMesh, shape: PlateShape = THESIS_SHAPE) -> Tire:
    """A tire on plates of one's own, e.g. from B-spline surfaces (spline_plates); nodes within the hub radius are tied.

    Parameters
    ----------
    preset : material, contact and integration; its outer radius is where deflection counts from, its hub radius [m]
        how far from the axle nodes belong to the hub
    mesh : plates in the wheel frame, the part "rim" with directors outwards
    shape : interpolation

    Raises
    ------
    InputError
        If there is no part "rim", or no node within the hub radius.

    Verified by tests/verification/test_ancf_spline_tire.py.
    """
    hub_nodes = np.flatnonzero(np.hypot(mesh.points[:, 0], mesh.points[:, 2]) <= preset.hub_radius + HUB_REACH)
    grid = build_contact_grid(mesh, mesh.plates_of(RIM), preset.contact_points, preset.contact_layout, shape)
    model = build_plate_model(
        mesh,
        young_modulus=preset.young_modulus,
        poisson_ratio=preset.poisson_ratio,
        density=preset.density,
        quadrature=preset.quadrature,
        shape=shape,
    )
    return Tire(preset=preset, model=model, grid=grid, tie=tie_reference_node(mesh, hub_nodes, np.zeros(3)))
