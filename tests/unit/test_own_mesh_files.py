"""Mesh files of other programs: what is in them is read, what is no such file is one message."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.errors import InputError
from geometry.gmsh_session import gmsh_session
from geometry.inp import TWENTY_NODES
from geometry.measures import mesh_volume
from geometry.msh import write_msh
from geometry.own_mesh.files import read_mesh_file
from geometry.own_mesh.roles import Placement, Roles
from geometry.own_mesh.wheel_mesh import wheel_of_file
from geometry.vtu import write_vtu
from tests.ring_wheel import AROUND, MILLIMETRES, ROLES, ring_deck, ring_volume, ring_wheel

METRES = Placement(unit=1.0)


@pytest.fixture
def msh(tmp_path: Path) -> Path:
    """The disc as gmsh writes it, in metres."""
    write_msh(wheel_of_file(ring_wheel(), ROLES, MILLIMETRES), tmp_path / "wheel.msh")
    return tmp_path / "wheel.msh"


@pytest.mark.parametrize("kind", ["wheel.msh", "binary.msh", "version2.msh", "wheel.med"])
def test_files_of_gmsh_hold_parts_and_faces_by_name(msh: Path, kind: str) -> None:
    path = msh.with_name(kind)
    if path != msh:
        with gmsh_session("test") as gmsh:
            gmsh.merge(str(msh))
            gmsh.option.setNumber("Mesh.Binary", float(kind == "binary.msh"))
            gmsh.option.setNumber("Mesh.MshFileVersion", 2.2 if kind == "version2.msh" else 4.1)
            gmsh.write(str(path))
            gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
    file = read_mesh_file(path)
    assert {name: len(cells) for name, cells in file.groups.items()} == {"hub": AROUND, "rim": AROUND}
    assert set(file.face_names) == {"tread", "bore", "other_faces"}
    mesh = wheel_of_file(file, ROLES, METRES)
    ours = wheel_of_file(ring_wheel(), ROLES, MILLIMETRES)
    assert np.sort(mesh.points[mesh.cells].reshape(-1, 81), axis=0) == pytest.approx(
        np.sort(ours.points[ours.cells].reshape(-1, 81), axis=0), abs=1e-15
    )


@pytest.mark.parametrize("nodes", [8, 20])
@pytest.mark.parametrize("faces", ["TREAD", "tread_nodes"])
def test_decks_hold_sets_and_surfaces(tmp_path: Path, nodes: int, faces: str) -> None:
    path = tmp_path / "wheel.inp"
    path.write_text(ring_deck(nodes))
    roles = Roles(parts=ROLES.parts, hub=("bore",), ground=(faces,))
    mesh = wheel_of_file(read_mesh_file(path), roles, MILLIMETRES)
    assert sum(mesh_volume(mesh).values()) == pytest.approx(ring_volume(), rel=0.05 if nodes == 8 else 2e-4)
    for name, radius in ((faces, 0.1), ("bore", 0.04)):
        facets = mesh.facets[mesh.facet_tags == mesh.faces[name]]
        assert len(facets) == AROUND
        assert np.hypot(*mesh.points[facets[:, :4]][..., [0, 2]].reshape(-1, 2).T) == pytest.approx(radius)


def test_sets_by_ranges_and_by_other_sets(tmp_path: Path) -> None:
    path = tmp_path / "wheel.inp"
    more = "*ELSET, ELSET=Lower, GENERATE\n1001, 1005, 2\n*ELSET, ELSET=both\nlower, 1020\n"
    path.write_text(ring_deck(8).replace("*STEP", f"{more}*STEP"))
    assert read_mesh_file(path).groups["both"].tolist() == [0, 2, 4, 19]


def test_files_of_vtk_hold_parts_by_number_and_faces_by_points(tmp_path: Path) -> None:
    import meshio  # type: ignore[import-untyped]

    mesh = ring_wheel(20)
    (block,) = mesh.blocks
    tags = np.repeat([7, 8], AROUND)
    points = {name: np.isin(np.arange(len(mesh.points)), nodes).astype(int) for name, nodes in mesh.node_sets.items()}
    cells = [("hexahedron20", block.nodes[:, list(TWENTY_NODES)])]
    for ending in ("vtu", "vtk"):
        path = tmp_path / f"wheel.{ending}"
        meshio.write_points_cells(str(path), mesh.points, cells, point_data=points, cell_data={"part": [tags]})
        roles = Roles(parts={"hub": ("7",), "rim": ("8",)}, hub=("bore_nodes",), ground=("tread_nodes",))
        found = wheel_of_file(read_mesh_file(path), roles, MILLIMETRES)
        assert sum(mesh_volume(found).values()) == pytest.approx(ring_volume(), rel=2e-4)


def test_our_own_vtu_is_read_in_its_order(tmp_path: Path) -> None:
    mesh = wheel_of_file(ring_wheel(), ROLES, MILLIMETRES)
    write_vtu(mesh, tmp_path / "wheel.vtu")
    file = read_mesh_file(tmp_path / "wheel.vtu")
    assert file.points[file.blocks[0].nodes] == pytest.approx(mesh.points[mesh.cells])


DECK = "*NODE\n1,0,0,0\n*ELEMENT, TYPE=C3D8, ELSET=a\n"
BROKEN: dict[str, tuple[str, bytes, str]] = {
    "no ending": ("wheel", b"", "is of no format that is read: .msh, .med"),
    "a script as .msh": ("wheel.msh", b'SystemCall "touch owned";', "is no .msh file: it begins otherwise"),
    "garbage as .msh": ("wheel.msh", bytes(range(256)), "is no .msh file"),
    "nodes cut off": ("wheel.msh", b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 2 3", "cannot be read"),
    "garbage as .med": ("wheel.med", b"\x89HDF\r\n\x1a\n" + bytes(200), "cannot be read"),
    "garbage as .vtu": ("wheel.vtu", b"<VTKFile type=", "cannot be read"),
    "garbage as .vtk": ("wheel.vtk", bytes(range(256)), "cannot be read"),
    "Exodus": ("wheel.exo", b"CDF\x01" + bytes(50), "has no coordinates in space"),
    "bytes as .inp": ("wheel.inp", bytes(range(256)), "is not UTF-8 text"),
    "words as .inp": ("wheel.inp", b"hello\nworld", "has no keyword such as"),
    "two coordinates": ("wheel.inp", b"*NODE\n1,2,3\n", "from line 1 on, .NODE .a node needs"),
    "no number": ("wheel.inp", b"*NODE\n1,0,0,zero\n", "from line 1 on, .NODE"),
    "an absent node": ("wheel.inp", f"{DECK}1, 1,2,3,4,5,6,7,8\n".encode(), "names node 2, which it does not have"),
    "too few nodes": ("wheel.inp", f"{DECK}1, 1,1,1\n".encode(), "has element 1 of type C3D8 with 3 nodes"),
    "an absent set": ("wheel.inp", b"*ELSET, ELSET=a\nb\n", "there is no set b"),
    "another file": ("wheel.inp", b"*INCLUDE, INPUT=nodes.inp\n", "INCLUDE .this keyword is not read"),
    "an assembly": ("wheel.inp", b"*INSTANCE, NAME=a\n*INSTANCE, NAME=b\n", "is an assembly of 2 instances"),
    "a surface of nothing": ("wheel.inp", b"*SURFACE, NAME=s\nrim, S9\n", "rim, S9, which is no face"),
}


@pytest.mark.parametrize("what", BROKEN)
def test_what_is_no_mesh_file_is_one_message(tmp_path: Path, what: str, monkeypatch: pytest.MonkeyPatch) -> None:
    name, content, words = BROKEN[what]
    monkeypatch.chdir(tmp_path)
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=words):
        read_mesh_file(tmp_path / name)
    assert not (tmp_path / "owned").exists(), "a script in a mesh file was run"


def test_a_file_cut_off_is_one_message(msh: Path) -> None:
    msh.write_bytes(msh.read_bytes()[: msh.stat().st_size // 2])
    with pytest.raises(InputError, match="cannot be read"):
        read_mesh_file(msh)


def test_no_file_a_folder_and_a_file_too_large(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="does not exist"):
        read_mesh_file(tmp_path / "none.msh")
    (tmp_path / "folder.msh").mkdir()
    with pytest.raises(InputError, match="is a folder"):
        read_mesh_file(tmp_path / "folder.msh")
    with (tmp_path / "large.msh").open("wb") as file:
        file.truncate(3_000_000_000)
    with pytest.raises(InputError, match="is larger than 2000 MB"):
        read_mesh_file(tmp_path / "large.msh")
