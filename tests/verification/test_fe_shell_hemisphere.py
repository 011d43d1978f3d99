"""Claim: one layer of quadratic hexahedra follows the hemisphere with an 18 degree hole, pulled and pushed at its
equator, within 3 % along the path and 2 % at full load, both with 27 nodes and the default quadrature (on a fine mesh)
and with 20 nodes and 2 x 2 x 3 points (on a coarse one); the error falls with the mesh.

Source: Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569, section 3.4, in contracts/published; the model is
reference_fe/verification/hemisphere.py. Tolerances as the project's target; the table is a mesh of 4-node shells
itself, and our finest meshes stay 0.3 % (20 nodes) to 1 % (27 nodes) below it at full load.
The default rule has two points along one axis only, so that on a doubly curved shell the other still locks: it needs
32 cells along the meridian, where the 20-node element needs 16 (the negative control shows the lock on that mesh).
"""

from __future__ import annotations

import functools

import numpy as np
import pytest
from numpy.typing import NDArray

from reference_fe.problem.static_problem import Discretisation, ElementFamily
from reference_fe.verification.hemisphere import QUARTERS, TWENTY_NODES, hemisphere_path, hemisphere_table
from reference_fe.verification.load_path import relative_error

DEFAULT = Discretisation()
pulled = functools.cache(hemisphere_path)


def errors(
    cells: tuple[int, int], discretisation: Discretisation, targets: tuple[float, ...] = QUARTERS
) -> NDArray[np.float64]:
    return np.abs(relative_error(pulled(cells, discretisation, targets), hemisphere_table()))


@pytest.mark.long
def test_twenty_nodes_follow_the_published_path() -> None:
    all_points = tuple(hemisphere_table()[:, 0].tolist())
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
    [
        pytest.param(((8, 8), (16, 16), (32, 32)), TWENTY_NODES, marks=pytest.mark.long, id="20 nodes"),
        pytest.param(((8, 16), (16, 32)), DEFAULT, id="27 nodes"),
    ],
)
def test_the_error_falls_with_the_mesh(meshes: tuple[tuple[int, int], ...], discretisation: Discretisation) -> None:
    """Each halving of the cells takes at least half of the larger deflection's error at full load."""
    error = [errors(cells, discretisation)[-1, 1] for cells in meshes]
    assert np.all(np.diff(np.log2(error)) < -1.0)


def test_one_increment_reaches_the_full_load() -> None:
    """From rest to the full load in one increment, and the same end as through four, to 1e-6."""
    one, four = pulled((8, 8), TWENTY_NODES, (1.0,)), pulled((8, 8), TWENTY_NODES, QUARTERS)
    assert one.increments == 1
    np.testing.assert_allclose(one.deflection[-1], four.deflection[-1], rtol=1e-6)


@pytest.mark.long
@pytest.mark.parametrize("family", list(ElementFamily))
def test_full_integration_locks(family: ElementFamily) -> None:
    """Negative control: three points along every axis fail the check on the mesh where 20 nodes pass it."""
    choice = Discretisation(family=family, gauss_points=(3, 3, 3))
    assert errors((16, 16), choice, (0.5, 1.0)).max() > 0.1


@pytest.mark.slow
def test_one_reduced_axis_is_not_enough_on_a_coarse_mesh() -> None:
    """Negative control: the default rule on the mesh where 20 nodes pass is still 7 % too stiff."""
    assert errors((16, 16), DEFAULT, (0.5, 1.0)).max() > 0.05
