"""Claim: one layer of quadratic hexahedra follows the hemisphere with an 18 degree hole, pulled and pushed at its
equator, within 3 % along the path and 2 % at full load, both with 27 nodes and the default quadrature (on a fine mesh)
and with 20 nodes and 2 x 2 x 3 points (on a coarse one); the error falls with the mesh.

Source: Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569, section 3.4, table in tests/data/sze2004. R = 10,
h = 0.04, E = 6.825e7, nu = 0.3; two pairs of radial forces of 400, of which a quarter model carries 200 each on its
symmetry planes, spread over the thickness here. Tolerances as the project's target; the table is a mesh of 4-node
shells itself, and our finest meshes stay 0.3 % (20 nodes) to 1 % (27 nodes) below it at full load.
The default rule has two points along one axis only, so that on a doubly curved shell the other still locks: it needs
32 cells along the meridian, where the 20-node element needs 16 (the negative control shows the lock on that mesh).
"""

from __future__ import annotations

import functools

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.materials import Material
from reference_fe.domain import Domain
from reference_fe.static_problem import Discretisation, ElementFamily, StaticProblem
from reference_fe.supports import EdgeLoad, Support
from tests.shell_benchmarks import LoadPath, load_path, published, relative_error
from tests.structured_hexahedra import block_mesh

SHELL = Material(
    name="shell", young_modulus=6.825e7, poisson_ratio=0.3, density=1.0, yield_strength=1e9, source="Sze et al. (2004)"
)
RADIUS, THICKNESS, FORCE = 10.0, 0.04, 200.0
QUARTERS = (0.25, 0.5, 0.75, 1.0)
TWENTY_NODES = Discretisation(family=ElementFamily.SERENDIPITY, gauss_points=(2, 2, 3))
DEFAULT = Discretisation()
WATCHED = [((RADIUS, 0.0, 0.0), (1.0, 0.0, 0.0)), ((0.0, RADIUS, 0.0), (0.0, -1.0, 0.0))]


def hemisphere(cells: tuple[int, int], discretisation: Discretisation) -> StaticProblem:
    """Quarter of the hemisphere, cells around and along the meridian; face x0 in y = 0, x1 in x = 0, y0 the equator."""

    def mapping(X: NDArray[np.float64]) -> NDArray[np.float64]:
        around, up, r = 0.5 * np.pi * X[:, 0], np.deg2rad(72.0) * X[:, 1], RADIUS + THICKNESS * (X[:, 2] - 0.5)
        return np.column_stack([r * np.cos(up) * np.cos(around), r * np.cos(up) * np.sin(around), r * np.sin(up)])

    line_load = FORCE / THICKNESS
    return StaticProblem(
        Domain.from_tagged(block_mesh((*cells, 1), mapping)),
        {"body": SHELL},
        [
            Support(faces=("x0",), components=(1,)),
            Support(faces=("x1",), components=(0,)),
            Support(meetings=(("x0", "y0", "z0"),), components=(2,)),  # one node, against the rise as a whole
        ],
        loads=[
            EdgeLoad(meeting=("x0", "y0"), vector=(line_load, 0.0, 0.0)),
            EdgeLoad(meeting=("x1", "y0"), vector=(0.0, -line_load, 0.0)),
        ],
        discretisation=discretisation,
    )


def table() -> NDArray[np.float64]:
    return published("sze34_hemisphere_18deg_hole")


@functools.cache
def pulled(cells: tuple[int, int], discretisation: Discretisation, targets: tuple[float, ...] = QUARTERS) -> LoadPath:
    return load_path(hemisphere(cells, discretisation), targets, WATCHED)


def errors(
    cells: tuple[int, int], discretisation: Discretisation, targets: tuple[float, ...] = QUARTERS
) -> NDArray[np.float64]:
    return np.abs(relative_error(pulled(cells, discretisation, targets), table()))


@pytest.mark.slow
def test_twenty_nodes_follow_the_published_path() -> None:
    all_points = tuple(table()[:, 0].tolist())
    error = errors((16, 16), TWENTY_NODES, all_points)
    assert error.max() < 0.03
    assert error[-1].max() < 0.02
    assert pulled((16, 16), TWENTY_NODES, all_points).iterations <= 90  # 20 points


@pytest.mark.slow
def test_twenty_seven_nodes_follow_the_published_path() -> None:
    error = errors((16, 32), DEFAULT)
    assert error.max() < 0.03
    assert error[-1].max() < 0.02


@pytest.mark.slow
@pytest.mark.parametrize(
    ("meshes", "discretisation"),
    [(((8, 8), (16, 16), (32, 32)), TWENTY_NODES), (((8, 16), (16, 32)), DEFAULT)],
    ids=["20 nodes", "27 nodes"],
)
def test_the_error_falls_with_the_mesh(meshes: tuple[tuple[int, int], ...], discretisation: Discretisation) -> None:
    """Each halving of the cells takes at least half of the larger deflection's error at full load."""
    error = [errors(cells, discretisation)[-1, 1] for cells in meshes]
    assert np.all(np.diff(np.log2(error)) < -1.0)


def test_one_increment_reaches_the_full_load() -> None:
    """From rest to the full load in one increment, and the same end as through four, to 1e-6."""
    one, four = pulled((8, 8), TWENTY_NODES, (1.0,)), pulled((8, 8), TWENTY_NODES)
    assert one.increments == 1
    np.testing.assert_allclose(one.deflection[-1], four.deflection[-1], rtol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("family", list(ElementFamily))
def test_full_integration_locks(family: ElementFamily) -> None:
    """Negative control: three points along every axis fail the check on the mesh where 20 nodes pass it."""
    choice = Discretisation(family=family, gauss_points=(3, 3, 3))
    assert errors((16, 16), choice, (0.5, 1.0)).max() > 0.1


@pytest.mark.slow
def test_one_reduced_axis_is_not_enough_on_a_coarse_mesh() -> None:
    """Negative control: the default rule on the mesh where 20 nodes pass is still 7 % too stiff."""
    assert errors((16, 16), DEFAULT, (0.5, 1.0)).max() > 0.05
