"""From a wheel design to thin plates: rim, springs, welds, grousers, what the hub and the plane of symmetry hold.

Every part is a grid of plates on its middle surface; its first axis runs along the strip, its second along the axle.
A weld is a second layer of the rim's plates, a grouser another; a spring begins at the end of its weld, where its edge
follows the rim's at half of both thicknesses; it turns there, and on the hub's weld, as far as the material below gives
way (`ancf_reduced.wheel.joints`). Rim and springs are divided as the solid mesh divides them: at weld ends, flanks of
grousers, edges of bands. Verified by tests/unit/test_ancf_wheel_mesh.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from ancf_reduced.thin_plates.plates import Layer, ThinPlates
from ancf_reduced.wheel.draft import Draft, Rim, TieLine
from ancf_reduced.wheel.faces import APART, FacePoints, Strips, ground_points, inner_points
from ancf_reduced.wheel.joints import foot_stiffness
from ancf_reduced.wheel.springs import add_legs, add_sidewall
from ancf_reduced.wheel.supports import free_basis, hub_stiffness
from contracts.errors import InputError
from geometry.build import mesh_size
from geometry.parts import SpringSet
from geometry.resolution import Ring, axial_bands, axial_levels, rim_ring, sidewall_angles
from geometry.rules import require_positive_length
from geometry.sidewall import SidewallSprings, weld_half_angle
from geometry.springs import polar, station_angles, weld_angle
from geometry.wheel import WheelDesign

__all__ = ["AncfWheel", "TieLine", "build_ancf_wheel"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
_LEAST_WIDTH = 0.5
"""Of a plate, in thicknesses: narrower ones are beams, and badly conditioned."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AncfWheel:
    """A wheel of thin plates.

    Attributes
    ----------
    plates : the network
    parts : (n_plates,) name of each plate's part
    ties : springs on the rim
    strips : the strip of each plate
    ground : what may touch the ground
    faces : what may touch the hub and other parts of the wheel
    hub : radius and half width of the cylinder that springs may touch [m]
    basis : (12 n_nodes, n_free) coordinates less their reference by the free ones: supports leave no others
    held : (n_free, n_free) stiffness of the hub's welds against turning [N m/m^2 and alike]
    sides : 2 for half a wheel, whose loads count twice; else 1
    """

    plates: ThinPlates
    parts: NDArray[np.str_]
    ties: TieLine
    strips: Strips
    ground: FacePoints
    faces: FacePoints
    hub: tuple[float, float]
    basis: csc_array
    held: csc_array
    sides: float

    def coordinates(self, free: Array) -> Array:
        """Nodes (n_nodes, 4, 3) of free coordinates (n_free,)."""
        return np.asarray(self.plates.reference + (self.basis @ free).reshape(self.plates.reference.shape))


def build_ancf_wheel(
    design: WheelDesign,
    *,
    element_size: float = 16e-3,
    axial_size: float = 18e-3,
    half_width: bool = True,
    factor: float = 1.0,
    ground_spacing: float = APART,
) -> AncfWheel:
    """Divide a wheel into thin plates, its outer hub rigid.

    Parameters
    ----------
    design : spring sets between rim and outer hub, and sidewall springs
    element_size : largest length of a plate along strips and around the rim [m]; a leg has eight plates at least
    axial_size : largest length along the axle [m]
    half_width : the half y >= 0, symmetry at y = 0
    factor : at least 1; counts along strips and along the axle are multiplied by it and rounded up
    ground_spacing : largest distance around the rim of points that may touch the ground [m]; ground of radius R between
        two that are s apart is s^2 / (8 R) deeper than they tell

    Raises
    ------
    InputError
        For bands that are not symmetric where half of the wheel is asked for, sizes that are not positive, and bands
        so narrow that plates between them were narrower than they are thick.
    """
    if not (math.isfinite(factor) and factor >= 1.0):
        raise InputError("factor", f"{factor:g}", "must be >= 1", "1 is the mesh of the sizes given")
    require_positive_length("ground spacing", ground_spacing)
    size = replace(mesh_size(design, element_size, axial_size, 1, None), factor=factor)
    bands = axial_bands(design, size, axial_levels(design, "flexible", half_width))
    levels = np.concatenate([[bands[0][0]], *(np.linspace(a, b, n + 1)[1:] for a, b, n in bands)])
    _require_wide(design, levels)
    draft = Draft(levels=levels)
    rim, ground = _add_rim(draft, design, rim_ring(design, size), ground_spacing)
    for springs in design.spring_sets:
        add_legs(draft, design, springs, size, rim)
    if design.sidewall_springs is not None:
        add_sidewall(draft, design, design.sidewall_springs, size, rim)
    ties, ends = draft.ties, draft.ends
    nodes = np.concatenate(draft.nodes)
    plates = ThinPlates(nodes, np.concatenate(draft.plates), np.concatenate(draft.sizes), draft.layers)
    strips = Strips(
        strip=np.array(draft.strips),
        facing=np.array(draft.facing),
        bare=np.array([all(layer.height <= 0.0 for layer in layers) for layers in draft.layers]),
    )
    basis = free_basis(nodes, ends, symmetric=half_width)
    return AncfWheel(
        plates=plates,
        parts=np.array(draft.parts),
        ties=TieLine(**{name: np.concatenate([getattr(tie, name) for tie in ties]) for name in TieLine.__slots__}),
        strips=strips,
        ground=ground,
        faces=inner_points(strips, plates.sizes, np.array([layers[0].thickness for layers in draft.layers])),
        hub=(design.outer_hub.outer_radius, 0.5 * design.outer_hub.width),
        basis=basis,
        held=csc_array(basis.T @ hub_stiffness(plates, ends) @ basis),
        sides=2.0 if half_width else 1.0,
    )


def _require_wide(design: WheelDesign, levels: Array) -> None:
    """Refuse edges of bands that lie so close that a plate between them is none."""
    thinnest = min([design.tire.thickness, *(springs.thickness for springs in design.spring_sets)])
    k = int(np.diff(levels).argmin())
    low, high = 1e3 * levels[k : k + 2]
    if high - low < 1e3 * _LEAST_WIDTH * thinnest:
        rule = (
            f"leave {high - low:.3g} mm between them, less than {_LEAST_WIDTH:g} of a thickness {1e3 * thinnest:g} mm"
        )
        raise InputError("edges of bands", f"at y = {low:.6g} and {high:.6g} mm", rule, "make them equal or move one")


def _add_rim(draft: Draft, design: WheelDesign, ring: Ring, apart: float) -> tuple[Rim, FacePoints]:
    """Returns the rim and the ground's points."""
    tire, fins = design.tire, design.grousers
    middle = 0.5 * (tire.inner_radius + tire.outer_radius)
    angles = np.concatenate([ring.angle(i) + ring.step(i) * np.arange(n) / n for i, n in enumerate(ring.counts)])
    steps = np.repeat([ring.step(i) / n for i, n in enumerate(ring.counts)], ring.counts)
    of = np.repeat(np.arange(len(ring.angles)), ring.counts)
    points = np.array([polar(middle, a) for a in angles])
    tangents = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    (columns,) = draft.columns([(-0.5 * tire.width, 0.5 * tire.width)])
    _, plates = draft.add_strip("tire", (points, tangents), middle * steps, columns, -points[0])
    welds = _weld_layers(draft, design, ring)
    inside = dict[int, float]()
    if fins is not None:
        half = math.asin(0.5 * fins.thickness / tire.outer_radius)
        for k in range(fins.count):
            at = fins.phase + 2.0 * math.pi * k / fins.count
            inside |= dict.fromkeys(ring.span(at - half, at + half), at)
    own = Layer(material=tire.material, thickness=tire.thickness)
    for i in of:
        for j in columns:
            fin: tuple[Layer, ...] = ()
            if fins is not None and int(i) in inside:
                height = -0.5 * (tire.thickness + fins.height)
                foot = foot_stiffness(tire.material, tire.thickness, fins.thickness)
                width = fins.thickness
                fin = (Layer(material=fins.material, thickness=fins.height, height=height, rib=width, foot=foot),)
            draft.layers.append((own, *welds.get((int(i), j), ()), *fin))
    ground = [
        ground_points(
            design,
            plates[row],
            draft.sizes[-1].reshape(*plates.shape, 2)[row],
            (_turned(angles[row] - inside[int(i)]), steps[row]) if int(i) in inside else None,
            apart,
        )
        for row, i in enumerate(of)
    ]
    fields = {name: np.concatenate([getattr(g, name) for g in ground]) for name in FacePoints.__slots__}
    first = np.concatenate([[0], np.cumsum(ring.counts)[:-1]])
    return Rim(ring, first, plates), FacePoints(**fields)


def _turned(angle: float) -> float:
    """An angle in [-pi, pi) [rad]."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def _weld_layers(draft: Draft, design: WheelDesign, ring: Ring) -> dict[tuple[int, int], tuple[Layer, ...]]:
    """Layers that welds add to the rim, by interval of the ring and of the axle."""
    found, radius, edge = dict[tuple[int, int], tuple[Layer, ...]](), design.tire.inner_radius, 0.5 * design.tire.width
    welds: list[tuple[SpringSet | SidewallSprings, Array, float, Sequence[tuple[float, float]]]] = [
        (springs, station_angles(springs), 0.5 * weld_angle(springs, radius), springs.bands)
        for springs in design.spring_sets
    ]
    if (sidewall := design.sidewall_springs) is not None:
        ends = (-edge, sidewall.weld_length - edge), (edge - sidewall.weld_length, edge)
        welds.append((sidewall, sidewall_angles(sidewall), weld_half_angle(sidewall, radius), ends))
    for springs, stations, half, bands in welds:
        height = 0.5 * (design.tire.thickness + springs.thickness)
        layer = Layer(material=springs.material, thickness=springs.thickness, height=height)
        for station in stations:
            for i in ring.span(station - half, station + half):
                for columns in draft.columns(bands):
                    found |= {(i, j): (*found.get((i, j), ()), layer) for j in columns}
    return found
