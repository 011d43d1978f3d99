"""Cells and nodes counted before a mesh is built: those of the mesh that is built, and a limit that holds at once."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from contracts.errors import InputError
from geometry.build import build_mesh, mesh_size
from geometry.counting import LARGEST_MESH, count_planar, count_solid
from geometry.planar import build_planar_mesh
from geometry.wheel import exomars_hoops

SIZES: dict[str, Any] = {"element_size": 0.016, "axial_size": 0.04, "thickness_elements": 1, "refinement": None}


@pytest.mark.parametrize(
    ("choice", "order", "factor"),
    [("half", 2, 1.0), ("half", 1, 1.0), ("half", 2, 1.5), ("whole", 2, 1.0), ("thick", 2, 1.0), ("edges", 2, 2.0)],
)
def test_the_count_is_that_of_the_mesh(choice: str, order: int, factor: float) -> None:
    """Cells exactly, nodes to 8 %; all parts with the cone as well."""
    design, sizes = exomars_hoops(), SIZES | ({"thickness_elements": 2} if choice == "thick" else {})
    sizes |= {"edge_size": 4e-3} if choice == "edges" else {}
    half, parts = choice != "whole", "all" if choice == "whole" else "flexible"
    size = replace(mesh_size(design, **sizes), factor=factor)
    count = count_solid(design, size, order, parts, half_width=half)  # type: ignore[arg-type]
    mesh = build_mesh(design, **sizes, order=order, factor=factor, parts=parts, half_width=half)  # type: ignore[arg-type]
    assert count.cells == len(mesh.cells)
    assert count.nodes == pytest.approx(len(mesh.points), rel=0.08)


def test_the_count_of_a_section() -> None:
    mesh = build_planar_mesh(exomars_hoops(), element_size=0.01)
    count = count_planar(exomars_hoops(), mesh_size(exomars_hoops(), 0.01, None, 1, None), 2)
    assert count.cells == len(mesh.cells)
    assert count.nodes == pytest.approx(len(mesh.points), rel=0.08)


@pytest.mark.parametrize("size", [1e-5, 1e-9, 1e-15])
def test_billions_of_cells_are_refused_before_gmsh_starts(size: float, monkeypatch: pytest.MonkeyPatch) -> None:
    def never(name: str) -> None:
        raise AssertionError(f"gmsh was started for {name}")

    monkeypatch.setattr("geometry.build.gmsh_session", never)
    monkeypatch.setattr("geometry.planar.gmsh_session", never)
    with pytest.raises(InputError, match=rf"element_size = .* mm .* cells, at most {LARGEST_MESH}"):
        build_mesh(exomars_hoops(), element_size=size)
    if size < 1e-8:
        with pytest.raises(InputError, match="cells, at most"):
            build_planar_mesh(exomars_hoops(), element_size=size)


def test_a_huge_factor_is_refused() -> None:
    with pytest.raises(InputError, match="cells, at most"):
        build_mesh(exomars_hoops(), element_size=0.016, factor=1e6)
