"""From a wheel design to thin plates: rim, springs, welds, grousers, what the hub and the plane of symmetry hold.

Every part is a grid of plates on its middle surface; its first axis runs along the strip, its second along the axle.
A weld is a second layer of the rim's plates, a grouser another; a spring begins at the end of its weld, where its edge
follows the rim's at half of both thicknesses; it turns there, and on the hub's weld, as far as the material below gives
way (`ancf_reduced.wheel.joints`). Rim and springs are divided as the solid mesh divides them: at weld ends, flanks of
grousers, edges of bands. Verified by tests/unit/test_ancf_wheel_mesh.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.sparse import csc_array

from ancf_reduced.thin_plates.plates import Layer, ThinPlates
from ancf_reduced.wheel.faces import APART, FacePoints, Strips, ground_points, inner_points
from ancf_reduced.wheel.joints import RIGID_RATIO, foot_stiffness, turning_stiffness
from ancf_reduced.wheel.supports import HubEnd, free_basis, hub_stiffness
from contracts.errors import InputError
from geometry.build import mesh_size
from geometry.parts import SpringSet
from geometry.resolution import MeshSize, Ring, axial_bands, axial_levels, rim_ring
from geometry.rules import require_positive_length
from geometry.springs import leg_sides, polar, spring_leg, station_angles, weld_angle
from geometry.wheel import WheelDesign

__all__ = ["AncfWheel", "TieLine", "build_ancf_wheel"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
_AXLE = np.array([0.0, 1.0, 0.0])
_LEAST_PER_LEG = 8
_LEAST_WIDTH = 0.5
"""Of a plate, in thicknesses: narrower ones are beams, and badly conditioned."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TieLine:
    """Where the first edges of springs follow the rim, one row per plate of a spring.

    Attributes
    ----------
    spring, rim : (n,) plates; the edge is u = 0 of both
    offset : (n,) of the spring's middle from the rim's, along the rim's normal [m]
    turning : (n,) moment by angle and width that the weld's end has against turning [N/rad]
    """

    spring: Index
    rim: Index
    offset: Array
    turning: Array


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


@dataclass(slots=True)
class _Draft:
    levels: Array
    nodes: list[Array] = field(default_factory=list)
    plates: list[Index] = field(default_factory=list)
    sizes: list[Array] = field(default_factory=list)
    layers: list[tuple[Layer, ...]] = field(default_factory=list)
    parts: list[str] = field(default_factory=list)
    strips: list[int] = field(default_factory=list)
    facing: list[float] = field(default_factory=list)
    count: int = 0
    plate_count: int = 0

    def add_strip(
        self, part: str, line: tuple[Array, Array], steps: Array, columns: range, front: Array
    ) -> tuple[Index, Index]:
        """A strip along ``line``, points and unit tangents (m, 2) in the section; closed if it has as many steps.

        columns : axial intervals it covers; front : normal (2,) of its front at its beginning. Returns numbers of its
        nodes (m, n + 1) and plates (steps, n).
        """
        points, tangents = line
        y = self.levels[columns.start : columns.stop + 1]
        m, n = len(points), len(y)
        new = np.zeros((m, n, 4, 3))
        new[:, :, 0, [0, 2]], new[:, :, 0, 1] = points[:, None], y
        new[:, :, 1, [0, 2]], new[:, :, 2] = tangents[:, None], _AXLE
        numbers = self.count + np.arange(m * n).reshape(m, n)
        ahead = np.arange(1, len(steps) + 1) % m
        behind = np.arange(len(steps))
        corners = [numbers[i][:, j] for i in (behind, ahead) for j in (slice(None, -1), slice(1, None))]
        self.nodes.append(new.reshape(-1, 4, 3))
        self.plates.append(np.stack(corners, axis=-1).reshape(-1, 4))
        grid = np.meshgrid(steps, np.diff(y), indexing="ij")
        self.sizes.append(np.stack(grid, axis=-1).reshape(-1, 2))
        plates = self.plate_count + np.arange(len(steps) * (n - 1)).reshape(len(steps), n - 1)
        self.parts += [part] * plates.size
        self.strips += [self.strips[-1] + 1 if self.strips else 0] * plates.size
        self.facing += [float(np.sign(tangents[0, 0] * front[1] - tangents[0, 1] * front[0]))] * plates.size
        self.count += m * n
        self.plate_count += plates.size
        return numbers, plates


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
    design : spring sets between rim and outer hub; sidewall springs are refused
    element_size : largest length of a plate along strips and around the rim [m]; a leg has eight plates at least
    axial_size : largest length along the axle [m]
    half_width : the half y >= 0, symmetry at y = 0
    factor : at least 1; counts along strips and along the axle are multiplied by it and rounded up
    ground_spacing : largest distance around the rim of points that may touch the ground [m]; ground of radius R between
        two that are s apart is s^2 / (8 R) deeper than they tell

    Raises
    ------
    InputError
        For sidewall springs, bands that are not symmetric where half of the wheel is asked for, sizes that are not
        positive, and bands so narrow that plates between them were narrower than they are thick.
    """
    if design.sidewall_springs is not None:
        rule = "stand in planes of their own: the wheel has no ANCF model yet"
        raise InputError("sidewall springs", design.sidewall_springs.name, rule, "use the solid model")
    if not (math.isfinite(factor) and factor >= 1.0):
        raise InputError("factor", f"{factor:g}", "must be >= 1", "1 is the mesh of the sizes given")
    require_positive_length("ground spacing", ground_spacing)
    size = replace(mesh_size(design, element_size, axial_size, 1, None), factor=factor)
    bands = axial_bands(design, size, axial_levels(design, "flexible", half_width))
    levels = np.concatenate([[bands[0][0]], *(np.linspace(a, b, n + 1)[1:] for a, b, n in bands)])
    _require_wide(design, levels)
    draft = _Draft(levels=levels)
    ring = rim_ring(design, size)
    breaks, rim_plates, ground = _add_rim(draft, design, ring, ground_spacing)
    ties, ends = list[TieLine](), list[HubEnd]()
    for springs in design.spring_sets:
        _add_springs(draft, design, springs, size, (ring, breaks, rim_plates), (ties, ends))
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
    thinnest = min(design.tire.thickness, *(springs.thickness for springs in design.spring_sets))
    k = int(np.diff(levels).argmin())
    low, high = 1e3 * levels[k : k + 2]
    if high - low < 1e3 * _LEAST_WIDTH * thinnest:
        rule = (
            f"leave {high - low:.3g} mm between them, less than {_LEAST_WIDTH:g} of a thickness {1e3 * thinnest:g} mm"
        )
        raise InputError("edges of bands", f"at y = {low:.6g} and {high:.6g} mm", rule, "make them equal or move one")


def _columns(draft: _Draft, bands: Iterable[tuple[float, float]]) -> list[range]:
    """Axial intervals of every band that lies in the drawn width."""
    found = []
    for low, high in bands:
        middle = 0.5 * (draft.levels[1:] + draft.levels[:-1])
        inside = np.flatnonzero((middle > low) & (middle < high))
        if len(inside):
            found.append(range(int(inside[0]), int(inside[-1]) + 1))
    return found


def _add_rim(draft: _Draft, design: WheelDesign, ring: Ring, apart: float) -> tuple[Index, Index, FacePoints]:
    """Returns the rim's first row of plates after each break of the ring, all its plates, and the ground's points."""
    tire, fins = design.tire, design.grousers
    middle = 0.5 * (tire.inner_radius + tire.outer_radius)
    angles = np.concatenate([ring.angle(i) + ring.step(i) * np.arange(n) / n for i, n in enumerate(ring.counts)])
    steps = np.repeat([ring.step(i) / n for i, n in enumerate(ring.counts)], ring.counts)
    of = np.repeat(np.arange(len(ring.angles)), ring.counts)
    points = np.array([polar(middle, a) for a in angles])
    tangents = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    (columns,) = _columns(draft, [(-0.5 * tire.width, 0.5 * tire.width)])
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
    return first, plates, FacePoints(**fields)


def _turned(angle: float) -> float:
    """An angle in [-pi, pi) [rad]."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def _weld_layers(draft: _Draft, design: WheelDesign, ring: Ring) -> dict[tuple[int, int], tuple[Layer, ...]]:
    """Layers that welds add to the rim, by interval of the ring and of the axle."""
    found = dict[tuple[int, int], tuple[Layer, ...]]()
    for springs in design.spring_sets:
        height = 0.5 * (design.tire.thickness + springs.thickness)
        layer = Layer(material=springs.material, thickness=springs.thickness, height=height)
        half = 0.5 * weld_angle(springs, design.tire.inner_radius)
        for station in station_angles(springs):
            for i in ring.span(station - half, station + half):
                for columns in _columns(draft, springs.bands):
                    found |= {(i, j): (*found.get((i, j), ()), layer) for j in columns}
    return found


def _add_springs(
    draft: _Draft,
    design: WheelDesign,
    springs: SpringSet,
    size: MeshSize,
    rim: tuple[Ring, Index, Index],
    found: tuple[list[TieLine], list[HubEnd]],
) -> None:
    ring, breaks, rim_plates = rim
    ties, ends = found
    (rim_columns,) = _columns(draft, [(-0.5 * design.tire.width, 0.5 * design.tire.width)])
    gap = design.outer_hub.outer_radius, design.tire.inner_radius
    half = 0.5 * weld_angle(springs, design.tire.inner_radius)
    offset = 0.5 * (design.tire.thickness + springs.thickness)
    layer = Layer(material=springs.material, thickness=springs.thickness)
    turning = [
        turning_stiffness(springs.material, springs.thickness, ratio)
        for ratio in (springs.thickness / design.tire.thickness, RIGID_RATIO)
    ]
    for station in station_angles(springs):
        for side in leg_sides(springs):
            leg = spring_leg(springs, gap, station, side)
            count = size.refined(max(_LEAST_PER_LEG, math.ceil(leg.length / size.of(springs.name) - 1e-6)))
            along = np.column_stack([-leg.normals[[0, -1], 1], leg.normals[[0, -1], 0]])
            along *= np.sign(along[0] @ (leg.points[1] - leg.points[0]))
            arc = np.linspace(0.0, leg.length, len(leg.points))
            line = CubicSpline(arc, leg.points, bc_type=((1, along[0]), (1, along[1])))
            at = np.linspace(0.0, leg.length, count + 1)
            tangents = line(at, 1) / np.linalg.norm(line(at, 1), axis=1)[:, None]
            first = breaks[ring.index(station + side * half)]
            for columns in _columns(draft, springs.bands):
                steps = np.full(count, leg.length / count)
                numbers, plates = draft.add_strip(springs.name, (line(at), tangents), steps, columns, leg.normals[0])
                draft.layers += [(layer,)] * plates.size
                on_rim = rim_plates[first, columns.start - rim_columns.start : columns.stop - rim_columns.start]
                same = np.ones(len(on_rim))
                tie = TieLine(spring=plates[0], rim=on_rim, offset=offset * same, turning=turning[0] * same)
                ties.append(tie)
                ends.append(HubEnd(numbers[-1], plates[-1], station + side * half, turning[1]))
