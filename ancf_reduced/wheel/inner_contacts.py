"""Contact within an ANCF wheel: springs, rim and hub with each other.

Points on the faces of springs are held off the rim's inside, off the hub, and off the springs beside them, with one
penalty stiffness as in the solid model. Verified by tests/unit/test_ancf_wheel_contacts.py.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.wheel.closest import Moved, PlateFace
from ancf_reduced.wheel.contacts import SKIN, HubContact, Near, PlateContact, Points
from ancf_reduced.wheel.hub import HUB
from ancf_reduced.wheel.mesh import AncfWheel

__all__ = ["RIM", "InnerContacts", "inner_contacts"]

Array = NDArray[np.float64]
RIM = 1
"""Number of springs on the rim among an `InnerContacts`' parts."""


class InnerContacts:
    """Springs on the hub, on the rim, and fronts and backs of springs on those of the strips beside them.

    Attributes
    ----------
    counts : points of each contact
    """

    def __init__(self, wheel: AncfWheel, penalty: float) -> None:
        self.parts = inner_contacts(wheel, penalty)
        self.counts = [part.count for part in self.parts]
        self._moved = Moved(wheel.plates, float(np.abs(wheel.faces.height).max(initial=0.0)))

    def near(self, q: Array, forces: Sequence[Array], blocks: Array) -> list[Near]:
        """Contacts within reach of each part, see there."""
        if 2.0 * self._moved(q) > SKIN:
            for part in self.parts:
                part.search(q)
            self._moved.remember(q)
        return [part.near(q, held, blocks) for part, held in zip(self.parts, forces, strict=True)]


def inner_contacts(wheel: AncfWheel, penalty: float) -> list[HubContact | PlateContact]:
    """Springs on the hub, on the rim, and fronts and backs of springs on those of the strips beside them."""
    strips, faces, plates = wheel.strips, wheel.faces, wheel.plates
    thickness = np.array([layers[0].thickness for layers in plates.layers])
    front = 0.5 * thickness * strips.facing
    strip = strips.strip[faces.plate]
    in_front = faces.height * strips.facing[faces.plate] > 0.0
    points = Points(wheel, faces)
    rim = PlateFace(plates, np.flatnonzero((strips.strip == 0) & strips.bare), front)
    found: list[HubContact | PlateContact] = [
        _on_hub(wheel, points, penalty),
        PlateContact(wheel, points, np.flatnonzero(in_front & (strip > 0)), rim, penalty),
    ]
    for one, others in _beside(wheel):
        for side in (1.0, -1.0):
            face = PlateFace(plates, np.flatnonzero(np.isin(strips.strip, others)), side * front)
            of = np.flatnonzero((strip == one) & (in_front == (side > 0.0)))
            found.append(PlateContact(wheel, points, of, face, penalty))
    return found


def _on_hub(wheel: AncfWheel, points: Points, penalty: float) -> HubContact | PlateContact:
    """Springs and rim on a rigid hub, or on an elastic one's outside where no weld lies."""
    bare = [all(layer.height >= 0.0 for layer in layers) for layers in wheel.plates.layers]
    hub = np.flatnonzero((wheel.parts == HUB) & bare)
    if not len(hub):
        return HubContact(wheel, points, penalty)
    thickness = np.array([layers[0].thickness for layers in wheel.plates.layers])
    outside = PlateFace(wheel.plates, hub, -0.5 * thickness)
    return PlateContact(wheel, points, np.arange(len(wheel.faces.plate)), outside, penalty)


def _beside(wheel: AncfWheel) -> list[tuple[int, list[int]]]:
    """Springs' strips, each with those of higher number that lie in one part of the width with it."""
    plates, strip = wheel.plates, wheel.strips.strip
    width = {}
    for k in range(1, int(strip.max()) + 1):
        y = plates.reference[plates.plates[strip == k], 0, 1]
        width[k] = float(y.min()) + 1e-9, float(y.max()) - 1e-9
    found = [
        (a, [b for b in width if b > a and width[a][0] < width[b][1] and width[b][0] < width[a][1]]) for a in width
    ]
    return [(a, others) for a, others in found if others]
