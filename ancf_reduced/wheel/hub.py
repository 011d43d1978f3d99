"""An elastic hub of an ANCF wheel: outer hub, impact springs and cone as plates, on a rigid inner hub.

The outer hub is a ring as the rim is; springs end on its outside, impact springs begin on its inside, the cone's edges
meet it at an angle. The inner hub, a short thick ring whose bore the solid model holds, is rigid. Impact springs and
cone touch nothing. Verified by tests/unit/test_ancf_wheel_hub.py and tests/verification/test_ancf_wheel_elastic_hub.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.thin_plates.plates import Layer
from ancf_reduced.wheel.draft import Draft, Rim, TieLine
from ancf_reduced.wheel.joints import turning_stiffness
from ancf_reduced.wheel.springs import add_legs
from ancf_reduced.wheel.supports import HubEnd
from ancf_reduced.wheel.welds import weld_layers, welds_of
from contracts.errors import InputError
from geometry.parts import Cone
from geometry.resolution import MeshSize, Ring, hub_ring
from geometry.springs import polar
from geometry.wheel import WheelDesign

__all__ = ["HUB", "HUB_PARTS", "add_cones", "add_hub", "add_impact_springs", "add_ring"]

Array = NDArray[np.float64]
HUB = "outer_hub"
HUB_PARTS = HUB, "cone", "impact_springs"
"""Parts of an elastic hub that are plates."""
_LEAST_OF_CONE = 2
"""Plates between the hubs."""
_AXLE = np.array([0.0, 1.0, 0.0])


def add_ring(
    draft: Draft, part: str, ring: Ring, size: tuple[float, float, float], *, touches: bool
) -> tuple[Rim, Array, Array]:
    """A ring's plates, their layers still to be given; size : inner radius, thickness and width [m].

    Returns it, and at which angle each of its rows begins and how far it goes [rad].
    """
    inner, thickness, width = size
    middle = inner + 0.5 * thickness
    angles = np.concatenate([ring.angle(i) + ring.step(i) * np.arange(n) / n for i, n in enumerate(ring.counts)])
    steps = np.repeat([ring.step(i) / n for i, n in enumerate(ring.counts)], ring.counts)
    points = np.array([polar(middle, a) for a in angles])
    tangents = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    (columns,) = draft.columns([(-0.5 * width, 0.5 * width)])
    _, plates = draft.add_strip(part, (points, tangents), middle * steps, columns, -points[0], touches=touches)
    first = np.concatenate([[0], np.cumsum(ring.counts)[:-1]])
    return Rim(ring, first, plates, columns, thickness, inner), angles, steps


def add_hub(draft: Draft, design: WheelDesign, size: MeshSize) -> Rim:
    """Draw the outer hub's ring with the welds on both of its surfaces."""
    if design.inner_hub is None or not design.spring_sets:
        what = "no inner hub" if design.inner_hub is None else "no springs between rim and hub"
        rule = "leaves an elastic hub with nothing that holds it, or to hold"
        raise InputError("elastic hub", what, rule, "take a rigid hub")
    hub, ring = design.outer_hub, hub_ring(design, size, "all")
    place = hub.inner_radius, hub.thickness, hub.width
    drawn, _, _ = add_ring(draft, HUB, ring, place, touches=False)
    welds = [welds_of(springs, design.tire.inner_radius, inside=False) for springs in design.spring_sets]
    if design.impact_springs is not None:
        welds.append(welds_of(design.impact_springs, hub.inner_radius, inside=True))
    layers = weld_layers(draft, ring, hub.thickness, welds)
    own = Layer(material=hub.material, thickness=hub.thickness)
    draft.layers += [
        (own, *layers.get((i, j), ())) for i, n in enumerate(ring.counts) for _ in range(n) for j in drawn.columns
    ]
    return drawn


def add_impact_springs(draft: Draft, design: WheelDesign, size: MeshSize, hub: Rim) -> None:
    """Draw the legs between the hubs."""
    assert design.inner_hub is not None
    if design.impact_springs is not None:
        add_legs(draft, design.impact_springs, size, hub, design.inner_hub.outer_radius, touches=False)


def add_cones(draft: Draft, design: WheelDesign, size: MeshSize, hub: Rim) -> None:
    """Draw the cone, and over the full width its mirror image: tied to the outer hub, held by the inner one."""
    if design.cone is None:
        return
    assert design.inner_hub is not None
    for side in (1.0,) if draft.levels[0] > -1e-12 else (1.0, -1.0):
        _add_cone(draft, design.cone, side, (hub, design.inner_hub.outer_radius), size)


def _add_cone(draft: Draft, cone: Cone, side: float, between: tuple[Rim, float], size: MeshSize) -> None:
    hub, inner = between
    ring, bore = hub.ring, hub.inner_radius
    radial, axial = inner - bore, side * (cone.inner_position - cone.outer_position)
    slant = math.hypot(radial, axial)
    count = size.refined(max(_LEAST_OF_CONE, math.ceil(slant / size.of("cone") - 1e-6)))
    angles = np.concatenate([ring.angle(i) + ring.step(i) * np.arange(n) / n for i, n in enumerate(ring.counts)])
    steps = np.repeat([ring.step(i) / n for i, n in enumerate(ring.counts)], ring.counts)
    at = np.linspace(0.0, 1.0, count + 1)
    out = np.stack([np.sin(angles), 0.0 * angles, -np.cos(angles)], axis=-1)
    around = np.stack([np.cos(angles), 0.0 * angles, np.sin(angles)], axis=-1)
    down = (radial * out + axial * _AXLE) / slant
    nodes = np.zeros((len(angles), count + 1, 4, 3))
    nodes[:, :, 0] = (bore + radial * at)[:, None] * out[:, None]
    nodes[:, :, 0, 1] = side * cone.outer_position + axial * at
    nodes[:, :, 1] = (1.0 + radial / bore * at)[:, None] * around[:, None]
    nodes[:, :, 2] = down[:, None]
    nodes[:, :, 3] = radial / (bore * slant) * around[:, None]
    lengths = bore * steps, np.full(count, slant / count)
    numbers, plates = draft.add_grid("cone", nodes, lengths, draft.next_strip(touches=False), 1.0)
    draft.layers += [(Layer(material=cone.material, thickness=cone.thickness),)] * plates.size
    levels = draft.levels[hub.columns.start : hub.columns.stop + 1]
    column = int(np.searchsorted(levels, side * cone.outer_position)) - 1
    v = (side * cone.outer_position - levels[column]) / (levels[column + 1] - levels[column])
    along = np.array([[0.0, 0.0], [1.0, 0.0]]), np.array([[0.0, v], [1.0, v]])
    turning = turning_stiffness(cone.material, cone.thickness, 0.0)
    # The hub's normal points inwards, so that of the slant's unit vector -radial / slant lies along it.
    square = axial / slant, radial / slant
    tied, offset = hub.plates[:, column], 0.5 * hub.thickness
    draft.ties.append(TieLine.of(plates[:, 0], tied, along, offset, turning, leaving=1, square=square))
    frame = np.stack([around, down, np.cross(around, down)], axis=-1)
    draft.ends.append(HubEnd(numbers[:, -1], plates[:, -1], frame, math.inf, leaving=1))
