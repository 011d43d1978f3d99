"""Exodus files: blocks, side sets and node sets by name, in the classic format and, with netCDF4, on HDF5."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.io import netcdf_file

from contracts.errors import InputError
from geometry.measures import mesh_volume
from geometry.own_mesh.files import read_mesh_file
from geometry.own_mesh.roles import Roles
from geometry.own_mesh.wheel_mesh import wheel_of_file
from tests.ring_wheel import AROUND, MILLIMETRES, ring_volume, ring_wheel

HEX20 = (*range(8), 8, 11, 13, 9, 10, 12, 14, 15, 16, 18, 19, 17)
"""gmsh's node at each place of Exodus' 20-node hexahedron: edges below, upright, above."""
HEX27 = (*HEX20, 26, 20, 25, 22, 23, 21, 24)
"""And of its 27 nodes: the body's, below, above, left, right, front, back."""
ROLES = Roles(parts={"hub": ("hub",), "rim": ("rim",)}, hub=("bore_nodes",), ground=("tread",))


def write_classic(path: Path, nodes: int = 20, names: bool = True) -> None:
    """The disc in two blocks, the bore as a node set, the tread as a side set: x+ of the second block's cells."""
    mesh = ring_wheel(nodes)
    cells = mesh.blocks[0].nodes[:, list({20: HEX20, 27: HEX27}.get(nodes, range(8)))] + 1
    with netcdf_file(str(path), "w") as file:
        sizes = {"num_nodes": len(mesh.points), "num_dim": 3, "len_name": 33, "num_el_blk": 2}
        sizes |= {"num_node_sets": 1, "num_side_sets": 1, "of_bore": len(mesh.node_sets["bore_nodes"])}
        for name, size in (sizes | {"around": AROUND, "per_cell": nodes}).items():
            file.createDimension(name, size)
        for k, axis in enumerate("xyz"):
            file.createVariable(f"coord{axis}", "d", ("num_nodes",))[:] = mesh.points[:, k]
        for k, block in enumerate(np.split(cells, 2), start=1):
            variable = file.createVariable(f"connect{k}", "i", ("around", "per_cell"))
            variable[:] = block
            variable.elem_type = f"HEX{nodes}"
        file.createVariable("eb_prop1", "i", ("num_el_blk",))[:] = [10, 20]
        file.createVariable("node_ns1", "i", ("of_bore",))[:] = mesh.node_sets["bore_nodes"] + 1
        file.createVariable("elem_ss1", "i", ("around",))[:] = AROUND + 1 + np.arange(AROUND)
        file.createVariable("side_ss1", "i", ("around",))[:] = 2
        for what, texts, size in (
            ("eb", ("hub", "rim"), "num_el_blk"),
            ("ns", ("bore_nodes",), "num_node_sets"),
            ("ss", ("tread",), "num_side_sets"),
        ):
            if names:
                padded = [list(text.ljust(33, "\0")) for text in texts]
                file.createVariable(f"{what}_names", "c", (size, "len_name"))[:] = np.array(padded, dtype="S1")


@pytest.mark.parametrize("nodes", [8, 20, 27])
def test_blocks_and_sets_are_found_by_name(tmp_path: Path, nodes: int) -> None:
    path = tmp_path / "wheel.exo"
    write_classic(path, nodes)
    file = read_mesh_file(path)
    assert {name: len(cells) for name, cells in file.groups.items()} == {"hub": AROUND, "rim": AROUND}
    mesh = wheel_of_file(file, ROLES, MILLIMETRES)
    assert sum(mesh_volume(mesh).values()) == pytest.approx(ring_volume(), rel=0.05 if nodes == 8 else 2e-4)
    for name, radius in (("tread", 0.1), ("bore_nodes", 0.04)):
        facets = mesh.facets[mesh.facet_tags == mesh.faces[name]]
        assert len(facets) == AROUND
        assert np.hypot(*mesh.points[facets[:, :4]][..., [0, 2]].reshape(-1, 2).T) == pytest.approx(radius)


def test_27_nodes_are_gmshs(tmp_path: Path) -> None:
    write_classic(tmp_path / "wheel.exo", 27)
    assert np.array_equal(
        read_mesh_file(tmp_path / "wheel.exo").blocks[0].nodes, ring_wheel(27).blocks[0].nodes[:AROUND]
    )


def test_without_names_there_are_numbers(tmp_path: Path) -> None:
    write_classic(tmp_path / "wheel.e", names=False)
    file = read_mesh_file(tmp_path / "wheel.e")
    assert list(file.groups) == ["10", "20"]
    assert set(file.face_names) == {"1"}


def test_on_hdf5_it_is_the_same(tmp_path: Path) -> None:
    netcdf = pytest.importorskip("netCDF4")
    write_classic(tmp_path / "classic.exo")
    with netcdf.Dataset(str(tmp_path / "classic.exo")) as old, netcdf.Dataset(str(tmp_path / "new.exo"), "w") as new:
        for name, dimension in old.dimensions.items():
            new.createDimension(name, len(dimension))
        for name, variable in old.variables.items():
            copied = new.createVariable(name, variable.dtype, variable.dimensions)
            copied.setncatts({key: variable.getncattr(key) for key in variable.ncattrs()})
            copied[:] = variable[:]
    files = [read_mesh_file(tmp_path / name) for name in ("classic.exo", "new.exo")]
    assert np.array_equal(files[0].points, files[1].points)
    assert all(np.array_equal(a.nodes, b.nodes) for a, b in zip(files[0].blocks, files[1].blocks, strict=True))
    assert {name: faces.tolist() for name, faces in files[0].cell_faces.items()} == {
        name: faces.tolist() for name, faces in files[1].cell_faces.items()
    }


def test_hdf5_without_its_library_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "netCDF4", None)
    (tmp_path / "wheel.exo").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
    with pytest.raises(InputError, match="cannot be read without the library netCDF4"):
        read_mesh_file(tmp_path / "wheel.exo")


def test_a_side_that_no_cell_has_is_told(tmp_path: Path) -> None:
    path = tmp_path / "wheel.exo"
    write_classic(path)
    with netcdf_file(str(path), "a") as file:
        file.variables["side_ss1"][:] = 7
    with pytest.raises(InputError, match="side set with side 7"):
        read_mesh_file(path)
