"""A tagged mesh in DOLFINx: parts, faces and their names."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.errors import InputError
from reference_fe.dolfinx_api import facet_midpoints
from reference_fe.problem.domain import Domain
from reference_fe.verification.structured_hexahedra import block_mesh


@pytest.mark.parametrize("order", [1, 2])
def test_parts_and_faces_have_all_their_cells_and_facets(order: int) -> None:
    domain = Domain.from_tagged(block_mesh((3, 2, 4), lambda X: X, order))
    assert len(domain.cells_of(["body"])) == 24
    for face, count in (("x0", 8), ("x1", 8), ("y0", 12), ("y1", 12), ("z0", 6), ("z1", 6)):
        facets = domain.facets_of([face])
        assert len(facets) == count
        middles = facet_midpoints(domain.mesh, facets)
        np.testing.assert_allclose(middles[:, "xyz".index(face[0])], float(face[1]), atol=1e-12)


def test_unknown_names_are_refused() -> None:
    domain = Domain.from_tagged(block_mesh((1, 1, 1), lambda X: X))
    with pytest.raises(InputError, match="rim: is not in the mesh"):
        domain.part_tags(["rim"])
    with pytest.raises(InputError, match="top: is not in the mesh"):
        domain.face_tags(["top"])
