"""Elastic constants of a problem's parts as fields over its mesh, solid or planar."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.material_laws import Law, StVenantKirchhoff, law_values
from contracts.materials import Material
from reference_fe import dolfinx_api as api
from reference_fe.material.hyperelastic import thermal_moduli
from reference_fe.material.law_constants import small_strain_lame
from reference_fe.material.plane_state import PLANE_STRAIN, planar_lambda
from reference_fe.problem.domain import Domain

__all__ = ["ElasticFields", "cell_moduli", "elastic_fields"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ElasticFields:
    """Constants on each cell.

    Attributes
    ----------
    lame : lambda and mu [Pa]; of a planar mesh lambda_p, see `plane_state`
    stretch : free thermal stretch theta [-]: one number where nothing expands, else a field
    transverse : strain across the plane over the trace of the strain in it [-]; None for a solid mesh
    """

    lame: tuple[api.Function, api.Function]
    stretch: api.Expr
    transverse: api.Function | None


def elastic_fields(
    domain: Domain, materials: Mapping[str, Material], constraint: Mapping[str, float], laws: Mapping[str, Law]
) -> ElasticFields:
    """Fields of the named parts' materials; ``constraint`` says how a planar part is held across the plane.

    It runs from 0, plane stress, to 1, plane strain [-], see `plane_state`; parts left out are in plane strain. Of laws
    other than St. Venant-Kirchhoff the constants are those at small strain.

    Raises
    ------
    InputError
        For a constraint on a solid mesh or an unknown part, and for a law without a planar form.

    Verified by tests/verification/test_fe_section.py.
    """
    domain.part_tags(constraint)
    if constraint and domain.dim == 3:
        raise InputError("transverse constraint", "given", "belongs to a planar mesh", "leave it out")
    for part, law in laws.items():
        if domain.dim == 2 and not isinstance(law, StVenantKirchhoff):
            rule = "has no planar form here: only St. Venant-Kirchhoff keeps its form between plane stress and strain"
            raise InputError(f"law of {part}", law_values(law)["kind"], rule, "use st_venant_kirchhoff or a solid mesh")
    space = api.fem.functionspace(domain.mesh, ("DG", 0))
    lam, mu, transverse = (api.fem.Function(space) for _ in range(3))
    for part, material in materials.items():
        cells, (solid, shear) = domain.cells_of([part]), small_strain_lame(material, laws[part])
        planar = planar_lambda(material, constraint.get(part, PLANE_STRAIN)) if domain.dim == 2 else solid
        lam.x.array[cells], mu.x.array[cells] = planar, shear
        transverse.x.array[cells] = planar / solid - 1.0 if solid else 0.0
    stretch = _stretch(domain, materials, space)
    return ElasticFields(lame=(lam, mu), stretch=stretch, transverse=transverse if domain.dim == 2 else None)


def cell_moduli(domain: Domain, materials: Mapping[str, Material], cells: NDArray[np.int32]) -> NDArray[np.float64]:
    """Lambda, mu and thermal stress offset of each of the parts' ``cells`` (ascending), (n_cells, 3) [Pa]."""
    moduli = np.empty((len(cells), 3))
    for part, material in materials.items():
        rows = np.searchsorted(cells, domain.cells_of([part]))
        moduli[rows] = thermal_moduli(material.lame_lambda, material.lame_mu, material.thermal_stretch)
    return moduli


def _stretch(domain: Domain, materials: Mapping[str, Material], space: api.Expr) -> api.Expr:
    if all(material.thermal_strain == 0.0 for material in materials.values()):
        return 1.0
    stretch = api.fem.Function(space)
    stretch.x.array[:] = 1.0
    for part, material in materials.items():
        stretch.x.array[domain.cells_of([part])] = material.thermal_stretch
    return stretch
