"""A path must lie on the terrain: height fields end, everything else does not."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.height_field import HeightField
from contracts.terrain import Plane, TerrainUnion
from contracts.terrain_cover import check_covered
from contracts.terrain_ridges import Step

FIELD = HeightField(heights=np.zeros((11, 21)), spacing=(0.5, 0.25), origin=(-1.0, -2.0))
PATH = np.column_stack([np.linspace(0.0, 3.0, 7), np.linspace(-1.0, 2.0, 7)])


def test_paths_on_the_terrain_pass() -> None:
    check_covered(FIELD, PATH, 1.0)
    check_covered(FIELD, np.array([[-1.0, -2.0], [4.0, 3.0]]))
    check_covered(TerrainUnion(parts=(Plane(), Step(rise=0.1, edge_radius=0.01))), 1e6 * PATH, 100.0)


def test_paths_beside_it_are_refused_with_the_place() -> None:
    with pytest.raises(InputError, match=r"= 3, 2 m: must lie 1\.1 m inside the terrain, x -1\.\.4 m, y -2\.\.3 m"):
        check_covered(FIELD, PATH[4:], 1.1)
    with pytest.raises(InputError, match=r"x, y = -1\.5, 0 m"):
        check_covered(TerrainUnion(parts=(Plane(offset=-1.0), FIELD)), np.array([[0.0, 0.0], [-1.5, 0.0]]))


@pytest.mark.parametrize("path", [np.zeros((0, 2)), np.zeros(2), np.zeros((3, 3)), np.full((2, 2), np.nan)])
def test_a_path_must_be_a_list_of_places(path: np.ndarray) -> None:
    with pytest.raises(InputError, match="must be \\(n, 2\\)"):
        check_covered(FIELD, path)
