"""Welds of springs on a ring of an ANCF wheel: layers of the ring's plates.

Verified by tests/unit/test_ancf_wheel_mesh.py and tests/unit/test_ancf_wheel_hub.py.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.thin_plates.plates import Layer
from ancf_reduced.wheel.draft import Draft
from geometry.parts import SpringSet
from geometry.resolution import Ring
from geometry.sidewall import SidewallSprings
from geometry.springs import station_angles, weld_angle

__all__ = ["Weld", "weld_layers", "welds_of"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Weld:
    """What a set of springs covers of a ring.

    Attributes
    ----------
    springs : whose material and thickness the layer has
    stations : (n,) circumferential positions of its middles [rad]
    half : half of the angle it covers [rad]
    bands : axial bands [m]
    inside : whether it lies on the ring's inner surface
    """

    springs: SpringSet | SidewallSprings
    stations: NDArray[np.float64]
    half: float
    bands: Sequence[tuple[float, float]]
    inside: bool = True


def welds_of(springs: SpringSet, radius: float, *, inside: bool) -> Weld:
    """Of a spring set; radius : of the surface its weld length is measured on [m]."""
    half = 0.5 * weld_angle(springs, radius)
    return Weld(springs=springs, stations=station_angles(springs), half=half, bands=springs.bands, inside=inside)


def weld_layers(
    draft: Draft, ring: Ring, thickness: float, welds: Iterable[Weld]
) -> dict[tuple[int, int], tuple[Layer, ...]]:
    """Layers that welds add to a ring of a thickness [m], by interval of the ring and of the axle."""
    found = dict[tuple[int, int], tuple[Layer, ...]]()
    for weld in welds:
        height = 0.5 * (thickness + weld.springs.thickness) * (1.0 if weld.inside else -1.0)
        layer = Layer(material=weld.springs.material, thickness=weld.springs.thickness, height=height)
        for station in weld.stations:
            for i in ring.span(station - weld.half, station + weld.half):
                for columns in draft.columns(weld.bands):
                    found |= {(i, j): (*found.get((i, j), ()), layer) for j in columns}
    return found
