"""Edges of springs on the rim, of springs and cone on an elastic hub: energy, forces and tangent by penalties.

Verified by tests/unit/test_ancf_wheel_static.py and tests/unit/test_ancf_wheel_hub.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.thin_plates.plates import ThinPlates
from ancf_reduced.thin_plates.shape_functions import shape_tables
from ancf_reduced.wheel.draft import TieLine
from ancf_reduced.wheel.kernels import find_tie_forces, tie_terms
from contracts.errors import MeshError

__all__ = ["Ties"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
_POINTS = 4
_STIFFNESS = 1e3
"""Of a tie, in t E / length of the spring's plate [-]."""


_APART, _TURNED = 5e-5, 1e-3
"""Off where an edge is tied, at rest: more is a mistake [m, -]."""


class Ties:
    """What ties of plates need at every state.

    Raises
    ------
    MeshError
        For an edge that does not lie where it is tied, or not at its angle: cubics of two radii leave 1e-5 m and 1e-4.

    Attributes
    ----------
    numbers : (n, 96) coordinates of the spring's and the rim's plate
    """

    def __init__(self, plates: ThinPlates, ties: TieLine) -> None:
        self._plates = plates
        self.numbers: Index = np.concatenate([plates.numbers[ties.spring], plates.numbers[ties.rim]], axis=1)
        at, weight = np.polynomial.legendre.leggauss(_POINTS)
        own, on = (
            np.stack([shape_tables(plates.sizes[k], *place.T)[:, :3] for k, place in zip(which, along, strict=True)])
            for which, along in (
                (which, ends[:, :1] + (0.5 + 0.5 * at)[:, None] * (ends[:, 1:] - ends[:, :1]))
                for which, ends in ((ties.spring, ties.edge), (ties.rim, ties.ends))
            )
        )
        each = np.arange(len(ties.spring))
        leaving = np.stack([own[:, :, 0], own[each, :, 1 + ties.leaving]], axis=2)
        layers = [plates.layers[k][0] for k in ties.spring]
        stiff = _STIFFNESS * np.array([layer.material.young_modulus * layer.thickness for layer in layers])
        sizes = plates.sizes[ties.spring]
        length, width = sizes[each, ties.leaving], sizes[each, 1 - ties.leaving]
        share = 0.5 * weight[None] * width[:, None]
        self._weights = share * (stiff / length)[:, None], share * ties.turning[:, None]
        alone = ties.spring, ties.rim, ties.offset, leaving, on, ties.square
        rest, ones = np.zeros((*share.shape, 4)), np.ones(share.shape)
        still = 0.0 * plates.reference
        find_tie_forces(plates.reference, still, plates.plates, (*alone, 0.0 * rest), (ones, ones), rest)
        apart, turned = np.abs(rest[..., :3]).max(initial=0.0), np.abs(rest[..., 3]).max(initial=0.0)
        if apart > _APART or turned > _TURNED:
            told = f"{1e3 * apart:.3g} mm, {turned:.3g} rad"
            raise MeshError(f"edges of springs or cone lie {told} off where they are tied: report this wheel")
        self._ties = *alone, rest

    def terms(self, q: Array, mixed: Array) -> tuple[float, Array, Array]:
        """Energy [J], forces (n, 32, 3) and tangents (n, 32, 3, 32, 3) at nodes q; ``mixed`` as `after` gives them."""
        count = len(self.numbers)
        force, blocks = np.zeros((count, 32, 3)), np.zeros((count, 32, 3, 32, 3))
        energy = tie_terms(q, self._plates.plates, self._ties, self._weights, mixed, force, blocks)
        return energy, force, blocks

    def after(self, q: Array, step: Array) -> Array:
        """Forces (n, points, 4) after a step of the nodes from q, linearised."""
        found = np.empty((*self._weights[0].shape, 4))
        find_tie_forces(q, step, self._plates.plates, self._ties, self._weights, found)
        return found
