"""Every fault of a mesh from another program is told with the cell or node, the rule and what to do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from contracts.errors import InputError
from geometry.hexahedra import VTK_FROM_GMSH, mirror_order
from geometry.inp import TWENTY_NODES
from geometry.own_mesh.file_mesh import CellBlock, FileMesh
from geometry.own_mesh.roles import Placement, Roles
from geometry.own_mesh.wheel_checks import parts_of_faces
from geometry.own_mesh.wheel_mesh import wheel_of_file
from tests.ring_wheel import AROUND, MILLIMETRES, ROLES, ring_wheel

type Damage = Callable[[FileMesh], FileMesh]


def _cells(mesh: FileMesh, change: Callable[[np.ndarray], np.ndarray]) -> FileMesh:
    (block,) = mesh.blocks
    return replace(mesh, blocks=[replace(block, nodes=change(block.nodes.copy()))])


def _other_order(places: tuple[int, ...]) -> Damage:
    return lambda mesh: _cells(mesh, lambda nodes: nodes[:, list(places)])


def _inverted(mesh: FileMesh) -> FileMesh:
    def mirror(nodes: np.ndarray) -> np.ndarray:
        nodes[5] = nodes[5][mirror_order(27)]
        return nodes

    return _cells(mesh, mirror)


def _inside_out(mesh: FileMesh) -> FileMesh:
    return _cells(mesh, lambda nodes: nodes[:, mirror_order(27)])


def _loose(mesh: FileMesh) -> FileMesh:
    """The rim on nodes of its own, at the places of the hub's."""
    (block,) = mesh.blocks
    nodes = block.nodes.copy()
    nodes[AROUND:] += len(mesh.points)
    facets = dict(mesh.facets)
    facets["tread"] = [faces + len(mesh.points) for faces in facets["tread"]]
    return replace(
        mesh,
        points=np.vstack([mesh.points, mesh.points]),
        node_numbers=np.arange(2 * len(mesh.points)),
        blocks=[replace(block, nodes=nodes)],
        facets=facets,
    )


def _nan(mesh: FileMesh) -> FileMesh:
    points = mesh.points.copy()
    points[17, 1] = np.nan
    return replace(mesh, points=points)


def _far_middle(mesh: FileMesh) -> FileMesh:
    (block,) = mesh.blocks
    points = mesh.points.copy()
    points[block.nodes[3, 8]] = points[block.nodes[3, 0]]
    return replace(mesh, points=points)


def _facets(name: str, faces: object) -> Damage:
    return lambda mesh: replace(mesh, facets={**mesh.facets, name: [np.array(faces, dtype=np.int64)]})


def _inner_face(mesh: FileMesh) -> FileMesh:
    (block,) = mesh.blocks
    shared = np.intersect1d(block.nodes[0, :8], block.nodes[AROUND, :8])
    assert len(shared) == 4
    return replace(mesh, facets={**mesh.facets, "tread": [shared[None]]})


def _block(kind: str, nodes: int = 6) -> Damage:
    def add(mesh: FileMesh) -> FileMesh:
        more = CellBlock(kind=kind, nodes=np.zeros((1, nodes), dtype=np.int64), numbers=np.array([77]))
        return replace(mesh, blocks=[*mesh.blocks, more])

    return add


def _groups(**groups: object) -> Damage:
    return lambda mesh: replace(mesh, groups={k: np.array(v, dtype=np.int64) for k, v in groups.items()})


RIM = list(range(AROUND, 2 * AROUND))
FAULTS: dict[str, tuple[Damage, tuple[str, ...]]] = {
    "VTK's order": (_other_order(VTK_FROM_GMSH), ("order of VTK and meshio", "cell 1001 of part hub")),
    "one inverted": (_inverted, ("1 inverted cells of 24", "cell 1006 of part hub", "Jacobian", "must be > 0")),
    "all inside out": (_inside_out, ("24 inverted cells of 24", "cell 1001", "mirror their order")),
    "loose rim": (_loose, ("12 of rim", "do not hang on the hub", "cell 1013", "72 of their nodes", "merge the nodes")),
    "NaN": (_nan, ("1 nodes without finite coordinates", "node 1018")),
    "middle node at a corner": (_far_middle, ("2 cells with a middle node far from", "cell 1003")),
    "a node twice": (
        lambda mesh: _cells(mesh, lambda n: np.vstack([np.where(np.arange(27) == 1, n[0, 0], n[0]), n[1:]])),
        ("1 cells that name a node twice", "cell 1001"),
    ),
    "plane cells": (lambda mesh: replace(mesh, blocks=[], flat=96), ("plane cells (96) alone", "mesh the volume")),
    "nothing": (lambda mesh: replace(mesh, blocks=[]), ("no cells",)),
    "pyramids": (_block("Pyramid 5", 5), ("not solved: Pyramid 5", "cell 77", "27-node hexahedra")),
    "mixed orders": (_block("8-node hexahedra", 8), ("mixes", "27-node hexahedra (cell 1001)", "(cell 77)")),
    "faces of no cell": (_facets("tread", [[0, 1, 2, 3]]), ("tread", "1 faces that are no face", "1001, 1002, 1003")),
    "triangles on hexahedra": (_facets("tread", [[0, 1, 2]]), ("tread", "other than 4 corners")),
    "no face": (_facets("tread", np.zeros((0, 4))), ("tread", "holds no face of the wheel")),
    "inner face": (_inner_face, ("tread", "1 faces between two cells")),
    "no such part": (_groups(hub=range(12), tire=RIM), ("rim", "no group of cells", "hub, tire")),
    "empty part": (_groups(hub=range(24), rim=[]), ("rim", "no group of cells")),
    "cells of two parts": (_groups(hub=range(13), rim=RIM), ("rim", "shares 1 cells with part hub", "cell 1013")),
    "a group of no part": (
        _groups(hub=range(12), rim=RIM[1:], weld=RIM[:1]),
        ("leaves 1 cells without a material", "those of weld", "cell 1013", "add a part"),
    ),
    "cells of no group": (_groups(hub=range(12), rim=RIM[1:]), ("1 cells without a material", "in no group")),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_of_the_file_is_told(fault: str) -> None:
    damage, words = FAULTS[fault]
    with pytest.raises(InputError) as told:
        wheel_of_file(damage(ring_wheel()), ROLES, MILLIMETRES)
    assert [word for word in words if word not in str(told.value)] == [], str(told.value)


def test_the_order_of_other_programs_of_20_nodes_is_told() -> None:
    with pytest.raises(InputError, match=r"order of VTK, Abaqus and meshio.*cell 1001"):
        wheel_of_file(_other_order(TWENTY_NODES)(ring_wheel(20)), ROLES, MILLIMETRES)


ASKED: dict[str, tuple[dict[str, object], tuple[str, ...]]] = {
    "hub": ({"hub": ("axle",)}, ("axle", "no group of faces", "bore, tread")),
    "ground": ({"ground": ("tire",)}, ("tire", "no group of faces", "correct the name")),
    "ground within": ({"hub": ("hub",), "ground": ("bore",)}, ("bore", "end at 40 mm", "part rim reaches 100 mm")),
    "symmetry": ({"symmetry": "bore_nodes", "hub": ("hub",)}, ("symmetry", "must lie in y = 0", "25 mm")),
    "all held": ({"hub": ("rim", "hub")}, ("rim, hub", "hold every cell", "leave a part that can deform")),
    "held where it is pressed": ({"hub": ("rim",)}, ("part = rim", "is held whole", "faces of tread")),
    "shared faces": ({"contact": (("tread_nodes", "bore"),)}, ("shares 12 faces with tread",)),
}


@pytest.mark.parametrize("what", ASKED)
def test_a_name_that_cannot_be_what_it_should_is_told(what: str) -> None:
    roles, words = ASKED[what]
    with pytest.raises(InputError) as told:
        wheel_of_file(ring_wheel(), replace(ROLES, **roles), MILLIMETRES)  # type: ignore[arg-type]
    assert [word for word in words if word not in str(told.value)] == [], str(told.value)


PLACES: dict[str, tuple[Placement, str]] = {
    "metres": (Placement(unit=1.0), r"= 100 m: is that of no wheel.*units"),
    "micrometres": (Placement(unit=1e-6), r"= 0.1 mm: is that of no wheel"),
    "another axle": (Placement(unit=1e-3, axle="x", up="z"), r"50 mm across: do not go around the axle"),
    "another centre": (Placement(unit=1e-3, centre=(0.03, 0.0, 0.0)), r"-130 mm to 70 mm forward: lie off the axle"),
}


@pytest.mark.parametrize("what", PLACES)
def test_a_wheel_of_no_size_or_beside_its_axle_is_told(what: str) -> None:
    placement, words = PLACES[what]
    with pytest.raises(InputError, match=words):
        wheel_of_file(ring_wheel(), ROLES, placement)


def test_faces_are_told_by_the_parts_they_lie_on() -> None:
    whole = ring_wheel()
    side = np.flatnonzero(whole.points[:, 1] == whole.points[:, 1].min())
    mesh = wheel_of_file(
        replace(whole, node_sets={"side": side}), replace(ROLES, contact=(("side", "bore"),)), MILLIMETRES
    )
    assert parts_of_faces(mesh, ["side"]) == ("hub", "rim")
    assert parts_of_faces(mesh, ["tread"]) == ("rim",)
    assert parts_of_faces(mesh, ["bore", "tread"]) == ("hub", "rim")


def test_axes_that_are_one_are_refused() -> None:
    with pytest.raises(InputError, match="must be two of x, y, z"):
        Placement(unit=1e-3, axle="z", up="z")


def test_half_a_wheel_lies_on_one_side() -> None:
    """Negative control: the whole disc with a plane of symmetry that none of its faces lies in, at one end."""
    roles = Roles(parts=ROLES.parts, hub=("bore",), ground=("tread",), symmetry="side")
    whole = ring_wheel()
    side = whole.points[:, 1] == whole.points[:, 1].min()
    mesh = replace(whole, node_sets={"side": np.flatnonzero(side)})
    half = wheel_of_file(mesh, roles, Placement(unit=1e-3, centre=(0.0, -0.025, 0.0)))
    assert half.points[:, 1].min() == pytest.approx(0.0, abs=1e-15)
    assert "symmetry" in half.faces
    with pytest.raises(InputError, match="must lie in y = 0"):
        wheel_of_file(mesh, roles, MILLIMETRES)
