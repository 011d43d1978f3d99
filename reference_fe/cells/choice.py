"""Which loops assemble which parts."""

from __future__ import annotations

from collections.abc import Mapping

from contracts.errors import InputError
from contracts.material_laws import Law, NeoHookean, StVenantKirchhoff, law_values
from contracts.materials import Material
from reference_fe import dolfinx_api as api
from reference_fe.cells.discretisation import Discretisation
from reference_fe.cells.general_cells import GeneralCells
from reference_fe.cells.kirchhoff_cells import KirchhoffCells
from reference_fe.material.elastic_fields import cell_moduli
from reference_fe.material.hyperelastic import MaterialLaw
from reference_fe.problem.domain import Domain

__all__ = ["compiled_groups", "form_laws"]


def compiled_groups(
    domain: Domain, V: api.Expr, materials: Mapping[str, Material], laws: Mapping[str, Law], choice: Discretisation
) -> tuple[KirchhoffCells | None, GeneralCells | None]:
    """St. Venant-Kirchhoff cells and all others; both None where UFL forms take every cell.

    Forms do so on planar meshes, where ``choice`` asks for them, and for plain Newton in St. Venant-Kirchhoff material.
    """
    kirchhoff = {part: materials[part] for part, law in laws.items() if isinstance(law, StVenantKirchhoff)}
    others = {part: law for part, law in laws.items() if part not in kirchhoff}
    if domain.dim == 2 or not choice.compiled or not (others or choice.mixed_integration_points):
        return None, None
    first, second = None, None
    if kirchhoff:
        cells = domain.cells_of(kirchhoff)
        first = KirchhoffCells(domain, V, cells, cell_moduli(domain, kirchhoff, cells), choice.gauss_points)
    if others:
        second = GeneralCells(domain, V, materials, others, choice.gauss_points)
    return first, second


def form_laws(laws: Mapping[str, Law]) -> dict[str, MaterialLaw]:
    """Part -> its law as UFL knows it; InputError for one that UFL forms do not have."""
    known = {StVenantKirchhoff: MaterialLaw.ST_VENANT_KIRCHHOFF, NeoHookean: MaterialLaw.NEO_HOOKEAN}
    for part, law in laws.items():
        if type(law) not in known:
            rule = "is assembled by compiled loops only"
            raise InputError(f"law of {part}", law_values(law)["kind"], rule, "leave Discretisation.compiled at True")
    return {part: known[type(law)] for part, law in laws.items()}
