"""Distance of an ANCF wheel's middle surfaces from those of a solid model.

Verified by tests/unit/test_ancf_wheel_shape.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.wheel.closest import PlateFace
from ancf_reduced.wheel.mesh import AncfWheel
from contracts.errors import InputError

__all__ = ["MiddleSurface"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
_ON = 20e-6
"""Distance up to which a node of the solid lies on a middle surface: plates are cubic, its cells quadratic [m]."""
_REACH = 10e-3
"""How far the deformed surfaces may lie apart, about [m]."""


class MiddleSurface:
    """Nodes of a solid that lie on a part's middle surface, and how far from it they are when both are deformed.

    Parameters
    ----------
    wheel : at rest its surfaces are where the solid's are
    part : ``tire`` or a spring set
    nodes : (n, 3) places of the part's nodes at rest [m]

    Raises
    ------
    InputError
        If no node lies on the surface: another wheel's, or cells without nodes there.
    """

    def __init__(self, wheel: AncfWheel, part: str, nodes: Array) -> None:
        self._face = PlateFace(wheel.plates, np.flatnonzero(wheel.parts == part), np.zeros(len(wheel.parts)))
        numbers, apart = self._apart(wheel.plates.reference, nodes)
        self.nodes = numbers[apart < _ON]
        if not len(self.nodes):
            hint = "give the nodes of the same wheel, quadratic and one cell through the thickness"
            raise InputError("nodes", f"{len(nodes)} of {part}", "must lie on its middle surface, some of them", hint)

    def distances(self, q: Array, moved: Array) -> Array:
        """Of deformed nodes (n, 3) from the surface at q (n_nodes, 4, 3), (m,) [m]; nodes past its edges left out."""
        return self._apart(q, moved[self.nodes])[1]

    def _apart(self, q: Array, points: Array) -> tuple[Index, Array]:
        plates = self._face.plates
        numbers, plate, rows = self._face.closest(q, points, _REACH)
        surface = np.einsum("nk,nki->ni", rows[:, 0], q[plates.plates[plate]].reshape(len(plate), 16, 3))
        return numbers, np.asarray(np.linalg.norm(surface - points[numbers], axis=1))
