"""The tagged mesh: a hash that sees every change and nothing else, and refused arrays."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from contracts.errors import MeshError
from contracts.mesh import TaggedMesh

CUBE = np.array([[x, y, z] for z in (0.0, 0.1) for x, y in ((0.0, 0.0), (0.1, 0.0), (0.1, 0.1), (0.0, 0.1))])


def two_cubes() -> TaggedMesh:
    """Two 0.1 m cubes side by side in x with one tagged facet each."""
    points = np.vstack([CUBE, CUBE + np.array([0.1, 0.0, 0.0])])
    return TaggedMesh(
        points=points,
        cells=np.arange(16).reshape(2, 8),
        cell_tags=np.array([1, 2], dtype=np.int32),
        facets=np.array([[0, 1, 2, 3], [12, 13, 14, 15]]),
        facet_tags=np.array([7, 8], dtype=np.int32),
        parts={"rim": 1, "hub": 2},
        faces={"bottom": 7, "top": 8},
    )


def test_order_follows_the_nodes_of_a_cell() -> None:
    assert two_cubes().order == 1
    quadratic = TaggedMesh(
        points=np.random.default_rng(0).random((27, 3)),
        cells=np.arange(27).reshape(1, 27),
        cell_tags=np.array([1], dtype=np.int32),
        facets=np.arange(9).reshape(1, 9),
        facet_tags=np.array([1], dtype=np.int32),
        parts={"rim": 1},
        faces={"bottom": 1},
    )
    assert quadratic.order == 2


def test_hash_is_repeatable_and_hexadecimal() -> None:
    digest = two_cubes().hash()
    assert digest == two_cubes().hash()
    assert len(digest) == 64
    assert set(digest) <= set("0123456789abcdef")


def test_hash_ignores_rounding_noise_storage_and_order_of_names() -> None:
    mesh = two_cubes()
    same: list[dict[str, Any]] = [
        {"points": mesh.points + 1e-14},
        {"points": np.asfortranarray(mesh.points)},
        {"points": np.where(mesh.points == 0.0, -0.0, mesh.points)},
        {"cells": mesh.cells.astype(np.int32)},
        {"cell_tags": mesh.cell_tags.astype(np.int64)},
        {"parts": {"hub": 2, "rim": 1}},
    ]
    for change in same:
        assert replace(mesh, **change).hash() == mesh.hash(), change


def test_hash_sees_every_change() -> None:
    mesh = two_cubes()
    moved = mesh.points.copy()
    moved[3, 2] += 1e-11
    different: list[dict[str, Any]] = [
        {"points": moved},
        {"cells": mesh.cells[::-1]},
        {"cell_tags": mesh.cell_tags[::-1]},
        {"facets": mesh.facets[::-1]},
        {"facet_tags": mesh.facet_tags[::-1]},
        {"parts": {"rim": 2, "hub": 1}},
        {"parts": {"tire": 1, "hub": 2}},
        {"faces": {"bottom": 8, "top": 7}},
    ]
    hashes = {replace(mesh, **change).hash() for change in different}
    assert mesh.hash() not in hashes
    assert len(hashes) == len(different)


def square() -> TaggedMesh:
    """One planar cell of 0.1 m with one tagged edge."""
    return TaggedMesh(
        points=CUBE[:4, :2],
        cells=np.arange(4).reshape(1, 4),
        cell_tags=np.array([1], dtype=np.int32),
        facets=np.array([[0, 1]]),
        facet_tags=np.array([7], dtype=np.int32),
        parts={"rim": 1},
        faces={"bottom": 7},
        widths={"rim": 0.12},
    )


def test_a_planar_mesh_has_widths_that_count() -> None:
    assert (square().dim, square().order, two_cubes().dim) == (2, 1, 3)
    assert replace(square(), widths={"rim": 0.13}).hash() != square().hash()
    for widths, text in (({}, "needs a width"), ({"hub": 0.1}, "needs a width"), ({"rim": 0.0}, "greater than zero")):
        with pytest.raises(MeshError, match=text):
            replace(square(), widths=widths)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"points": CUBE[:, :1]}, "points have shape \\(8, 1\\)"),
        ({"points": CUBE[:, :2]}, "quadrilaterals"),
        ({"widths": {"rim": 0.1, "hub": 0.1}}, "needs a width, and only there"),
        ({"points": np.full((16, 3), np.nan)}, "finite coordinates"),
        ({"cells": np.arange(8).reshape(2, 4)}, "cells have shape \\(2, 4\\)"),
        ({"cells": np.arange(8)}, "cells have shape \\(8,\\)"),
        ({"facets": np.arange(18).reshape(2, 9)}, "facets have shape \\(2, 9\\)"),
        ({"cell_tags": np.array([1], dtype=np.int32)}, "one tag per cell"),
        ({"facet_tags": np.array([7, 8, 8], dtype=np.int32)}, "one per facet"),
        ({"cells": np.arange(1, 17).reshape(2, 8)}, "cells name nodes outside 0..15"),
        ({"cells": np.arange(-1, 15).reshape(2, 8)}, "cells name nodes outside 0..15"),
        ({"facets": np.array([[0, 1, 2, 3], [12, 13, 14, 16]])}, "facets name nodes outside 0..15"),
        ({"cell_tags": np.array([1, 3], dtype=np.int32)}, "a cell tag has no part name"),
        ({"facet_tags": np.array([7, 9], dtype=np.int32)}, "a facet tag has no face name"),
    ],
)
def test_bad_arrays_are_refused(change: dict[str, Any], text: str) -> None:
    with pytest.raises(MeshError, match=text):
        replace(two_cubes(), **change)
