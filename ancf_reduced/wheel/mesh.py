"""From a wheel design to thin plates: rim, springs, welds, grousers, what the hub and the plane of symmetry hold.

Every part is a grid of plates on its middle surface; its first axis runs along the strip, its second along the axle.
A weld is a second layer of the rim's plates, a grouser another; a spring begins at the end of its weld, where its edge
follows the rim's at half of both thicknesses; it turns there, and on the hub's weld, as far as the material below gives
way (`ancf_reduced.wheel.joints`). Rim and springs are divided as the solid mesh divides them: at weld ends, flanks of
grousers, edges of bands. Verified by tests/unit/test_ancf_wheel_mesh.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from ancf_reduced.thin_plates.plates import Layer, ThinPlates
from ancf_reduced.wheel.draft import Draft, Rim, TieLine
from ancf_reduced.wheel.faces import APART, FacePoints, Strips, ground_points, inner_points
from ancf_reduced.wheel.hub import add_cones, add_hub, add_impact_springs, add_ring
from ancf_reduced.wheel.joints import foot_stiffness
from ancf_reduced.wheel.springs import add_legs, add_sidewall
from ancf_reduced.wheel.supports import free_basis, hub_stiffness
from ancf_reduced.wheel.welds import Weld, weld_layers, welds_of
from contracts.errors import InputError
from geometry.build import mesh_size
from geometry.resolution import Ring, axial_bands, axial_levels, rim_ring, sidewall_angles
from geometry.rules import require_positive_length
from geometry.sidewall import weld_half_angle
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
    ties : springs on the rim; springs and cone on an elastic hub
    strips : the strip of each plate
    ground : what may touch the ground
    faces : what may touch the hub and other parts of the wheel
    hub : radius and half width of the hub's outside [m]
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
    hub: Literal["rigid", "elastic"] = "rigid",
) -> AncfWheel:
    """Divide a wheel into thin plates.

    Parameters
    ----------
    design : spring sets between rim and outer hub, and sidewall springs
    element_size : largest length of a plate along strips and around the rim [m]; a leg has eight plates at least
    axial_size : largest length along the axle [m]
    half_width : the half y >= 0, symmetry at y = 0
    factor : at least 1; counts along strips and along the axle are multiplied by it and rounded up
    ground_spacing : largest distance around the rim of points that may touch the ground [m]; ground of radius R between
        two that are s apart is s^2 / (8 R) deeper than they tell
    hub : elastic: outer hub, cone and impact springs are plates, the inner hub alone is rigid

    Raises
    ------
    InputError
        For bands that are not symmetric where half of the wheel is asked for, sizes that are not positive, bands
        so narrow that plates between them were narrower than they are thick, an elastic hub that nothing holds, a
        lattice, a tread, or springs whose thickness varies.
    """
    for name in ("lattice", "tread"):
        if getattr(design, name) is not None:
            rule = "is no thin plate: this model is made of strips welded on a rim"
            raise InputError(name, f"of {design.name}", rule, "use the solid model or the section model")
    for springs in (*design.spring_sets, *([design.impact_springs] if design.impact_springs is not None else [])):
        if springs.tapered:
            rule = "varies along the strip; this model's plates are even"
            raise InputError(f"thickness of {springs.name}", "", rule, "use the solid model or the section model")
    if not (math.isfinite(factor) and factor >= 1.0):
        raise InputError("factor", f"{factor:g}", "must be >= 1", "1 is the mesh of the sizes given")
    require_positive_length("ground spacing", ground_spacing)
    size = replace(mesh_size(design, element_size, axial_size, 1, None), factor=factor)
    if hub not in ("rigid", "elastic"):
        raise InputError("hub", hub, "is not known", "give rigid or elastic")
    bands = axial_bands(design, size, _levels(design, half_width=half_width, elastic=hub == "elastic"))
    levels = np.concatenate([[bands[0][0]], *(np.linspace(a, b, n + 1)[1:] for a, b, n in bands)])
    _require_wide(design, levels)
    draft = Draft(levels=levels)
    rim, ground = _add_rim(draft, design, rim_ring(design, size), ground_spacing)
    ring = add_hub(draft, design, size) if hub == "elastic" else None
    for springs in design.spring_sets:
        add_legs(draft, springs, size, rim, ring or design.outer_hub.outer_radius)
    if ring is not None:
        add_impact_springs(draft, design, size, ring)
        add_cones(draft, design, size, ring)
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


def _levels(design: WheelDesign, *, half_width: bool, elastic: bool) -> Array:
    """Axial positions at which strips are divided [m]: edges of bands, those of impact springs if they are plates."""
    if not elastic or design.impact_springs is None or design.inner_hub is None:
        return axial_levels(design, "flexible", half_width)
    as_wide = replace(design.inner_hub, width=design.outer_hub.width)  # no level of its own: it is no plate
    return axial_levels(replace(design, cone=None, inner_hub=as_wide), "all", half_width)


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
    place = tire.inner_radius, tire.thickness, tire.width
    rim, angles, steps = add_ring(draft, "tire", ring, place, touches=True)
    of = np.repeat(np.arange(len(ring.angles)), ring.counts)
    welds = weld_layers(draft, ring, tire.thickness, _welds(design))
    inside = dict[int, float]()
    if fins is not None:
        half = math.asin(0.5 * fins.thickness / tire.outer_radius)
        for k in range(fins.count):
            at = fins.phase + 2.0 * math.pi * k / fins.count
            inside |= dict.fromkeys(ring.span(at - half, at + half), at)
    own = Layer(material=tire.material, thickness=tire.thickness)
    for i in of:
        for j in rim.columns:
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
            rim.plates[row],
            draft.sizes[-1].reshape(*rim.plates.shape, 2)[row],
            (_turned(angles[row] - inside[int(i)]), steps[row]) if int(i) in inside else None,
            apart,
        )
        for row, i in enumerate(of)
    ]
    return rim, FacePoints(
        **{name: np.concatenate([getattr(g, name) for g in ground]) for name in FacePoints.__slots__}
    )


def _welds(design: WheelDesign) -> list[Weld]:
    """On the rim."""
    radius, edge = design.tire.inner_radius, 0.5 * design.tire.width
    found = [welds_of(springs, radius, inside=True) for springs in design.spring_sets]
    if (sidewall := design.sidewall_springs) is not None:
        bands = (-edge, sidewall.weld_length - edge), (edge - sidewall.weld_length, edge)
        half = weld_half_angle(sidewall, radius)
        found.append(Weld(springs=sidewall, stations=sidewall_angles(sidewall), half=half, bands=bands))
    return found


def _turned(angle: float) -> float:
    """An angle in [-pi, pi) [rad]."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi
