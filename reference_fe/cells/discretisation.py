"""Choice of law, element, quadrature and assembly of a static problem."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from reference_fe.material.hyperelastic import MaterialLaw

__all__ = ["Discretisation", "ElementFamily"]


class ElementFamily(StrEnum):
    """Shape functions of the displacement; the geometry keeps the mesh's own."""

    LAGRANGE = "Lagrange"
    """Full tensor product: 8 functions at degree 1, 27 at degree 2."""
    SERENDIPITY = "S"
    """Without the face and cell functions: 20 at degree 2 (Arnold & Awanou 2011), the industry's 20-node hexahedron."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Discretisation:
    """Choice of law, element and quadrature.

    Attributes
    ----------
    law : of parts whose material leaves it open
    family, degree : shape functions of the displacement, degree 1 or 2
    gauss_points : Gauss points along each of the cell's local axes, two axes for a planar mesh; quadratic cells keep
        full rank as long as all but one have 3 points. 2 along the curved axis (see `orientation.curved_axis_first`)
        cures membrane locking
    mixed_integration_points : store stress, and pressure where a law has one, for the tangent; False is plain Newton
    compiled : assemble the cells of a solid mesh by our own compiled loops (St. Venant-Kirchhoff alone only with mixed
        integration points); False, and everywhere else, by UFL forms, which know St. Venant-Kirchhoff and neo-Hookean:
        same numbers, the tangent takes three to six times as long
    """

    law: MaterialLaw = MaterialLaw.ST_VENANT_KIRCHHOFF
    family: ElementFamily = ElementFamily.LAGRANGE
    degree: int = 2
    gauss_points: tuple[int, ...] = (2, 3, 3)
    mixed_integration_points: bool = True
    compiled: bool = True
