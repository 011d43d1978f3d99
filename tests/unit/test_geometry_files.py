"""Files another program opens: MSH, VTU, STEP, the summary; and gmsh sessions that leave no trace."""

from __future__ import annotations

import json
import math
import subprocess
import sys
import threading
from collections import Counter
from itertools import chain
from pathlib import Path

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.mesh import TaggedMesh
from geometry.build import build_mesh
from geometry.closed_form import closed_form_volume
from geometry.gmsh_session import gmsh_session
from geometry.inp import write_inp
from geometry.measures import mesh_volume
from geometry.msh import write_msh
from geometry.step import write_step
from geometry.summary import summarize_mesh
from geometry.vtu import write_vtu
from geometry.wheel import exomars, exomars_hoops

WHEEL = exomars()


@pytest.fixture(scope="module")
def mesh() -> TaggedMesh:
    return build_mesh(WHEEL, element_size=20e-3, parts="flexible")


def test_importing_geometry_imports_neither_gmsh_nor_meshio() -> None:
    code = "import sys, geometry; sys.exit(any(m in sys.modules for m in ('gmsh', 'meshio', 'vtkmodules')))"
    root = Path(__file__).parents[2]
    assert subprocess.run([sys.executable, "-c", code], cwd=root, check=False).returncode == 0


def test_inp_has_twenty_nodes_in_the_order_of_its_elements(mesh: TaggedMesh, tmp_path: Path) -> None:
    """Every edge node stands between its edge's ends: vertices, then bottom, top and upright edges."""
    path = tmp_path / "new" / "wheel.inp"
    write_inp(mesh, path, node_sets={"chosen": np.array([0, 1])})
    blocks = _inp_blocks(path)
    points = {int(row[0]): np.array(row[1:]) for row in blocks["*NODE, NSET=ALL_NODES"]}
    tire = np.array(blocks["*ELEMENT, TYPE=C3D20R, ELSET=TIRE"]).reshape(-1, 21)
    assert len(tire) == np.sum(mesh.cell_tags == mesh.parts["tire"])
    ends = [*((k, (k + 1) % 4) for k in range(4)), *((4 + k, 4 + (k + 1) % 4) for k in range(4))]
    ends += [(k, k + 4) for k in range(4)]
    for cell in tire[::7, 1:].astype(int):
        for k, (a, b) in enumerate(ends):
            start, end, middle = (points[cell[n]] for n in (a, b, 8 + k))
            off = np.linalg.norm(middle - 0.5 * (start + end)) / np.linalg.norm(end - start)
            assert off < 0.05, (
                k,
                off,
            )  # an arc's sagitta; a wrong node is off by 0.5 or more
    assert blocks["*NSET, NSET=CHOSEN"] == [[1.0, 2.0]]
    assert len(blocks["*NSET, NSET=TIRE_OUTER"]) > 1


def _inp_blocks(path: Path) -> dict[str, list[list[float]]]:
    """Numbers of each line, by keyword line; an element's three lines are joined."""
    blocks: dict[str, list[list[float]]] = {}
    for line in path.read_text().splitlines():
        if line.startswith("*"):
            current = blocks.setdefault(line, [])
        else:
            current.append([float(number) for number in line.strip(",").split(",")])
    return {
        name: [[*chain(*rows[k : k + 3])] for k in range(0, len(rows), 3)] if name.startswith("*ELEMENT") else rows
        for name, rows in blocks.items()
    }


def test_inp_refuses_eight_node_hexahedra(tmp_path: Path) -> None:
    linear = build_mesh(WHEEL, element_size=30e-3, parts="flexible", order=1)
    with pytest.raises(InputError, match="20-node"):
        write_inp(linear, tmp_path / "linear.inp")


def test_msh_has_named_groups_and_the_same_cells(mesh: TaggedMesh, tmp_path: Path) -> None:
    path = tmp_path / "new" / "wheel.msh"
    write_msh(mesh, path)
    with gmsh_session("read") as gmsh:
        gmsh.merge(str(path))
        groups = {(d, gmsh.model.getPhysicalName(d, t)): t for d, t in gmsh.model.getPhysicalGroups()}
        counts = {}
        for (dim, name), tag in groups.items():
            (entity,) = gmsh.model.getEntitiesForPhysicalGroup(dim, tag)
            counts[dim, name] = len(gmsh.model.mesh.getElements(dim, entity)[1][0])
        jacobian = gmsh.model.mesh.getElementQualities(gmsh.model.mesh.getElementsByType(12)[0], "minSJ")
    assert counts == {(3, n): int(np.sum(mesh.cell_tags == t)) for n, t in mesh.parts.items()} | {
        (2, n): int(np.sum(mesh.facet_tags == t)) for n, t in mesh.faces.items()
    }
    assert min(jacobian) > 0.9


@pytest.mark.parametrize("order", [1, 2])
def test_vtu_opens_with_its_parts_and_volume(order: int, tmp_path: Path) -> None:
    import pyvista

    mesh = build_mesh(WHEEL, element_size=20e-3, parts="flexible", order=order)
    write_vtu(mesh, tmp_path / "wheel.vtu")
    grid = pyvista.read(tmp_path / "wheel.vtu")
    assert grid.n_cells == len(mesh.cells)
    assert np.array_equal(grid.cell_data["part"], mesh.cell_tags)
    assert set(grid.celltypes) == {12 if order == 1 else 29}
    volume = grid.compute_cell_sizes(length=False, area=False)["Volume"]
    assert volume.min() > 0.0
    assert volume.sum() == pytest.approx(sum(mesh_volume(mesh).values()), rel=0.03)


def test_step_holds_every_part_with_its_volume(tmp_path: Path) -> None:
    """Read back in millimetres: solids by product name, volumes against closed form to 1e-6."""
    path, wheel = tmp_path / "wheel.step", exomars_hoops()
    write_step(wheel, path)
    names = [line.split("'")[1] for line in path.read_text().splitlines() if "= PRODUCT(" in line][1:]
    assert Counter(names) == {
        "tire": 1,
        "grousers": 12,
        "springs_outer": 6,
        "springs_inner": 3,
        "outer_hub": 1,
        "cone": 2,
        "impact_springs": 6,
        "inner_hub": 1,
    }
    found = dict.fromkeys(wheel.materials, 0.0)
    with gmsh_session("read") as gmsh:
        gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
        solids = gmsh.model.occ.importShapes(str(path))
        for name, solid in zip(names, solids, strict=True):
            found[name] += gmsh.model.occ.getMass(*solid)
    assert found == pytest.approx({n: v * 1e9 for n, v in closed_form_volume(wheel, False).items()}, rel=1e-6)


def test_step_holds_leaves_with_their_volume(tmp_path: Path) -> None:
    """By tetrahedra, to 0.1 %: OpenCASCADE's own integral is a per cent off on long faces of splines."""
    write_step(WHEEL, tmp_path / "wheel.step")
    text = (tmp_path / "wheel.step").read_text(encoding="utf-8")
    names = [line.split("'")[1] for line in text.splitlines() if "= PRODUCT(" in line][1:]
    assert names.count("springs_outer") == 12  # six, each in two halves
    with gmsh_session("read") as gmsh:
        gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
        solids = gmsh.model.occ.importShapes(str(tmp_path / "wheel.step"))
        leaf = solids[names.index("springs_outer")]
        gmsh.model.occ.remove([one for one in solids if one != leaf], recursive=True)
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("Mesh.MeshSizeMax", 3.0)
        gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 100)
        gmsh.model.mesh.generate(3)
        _, points, _ = gmsh.model.mesh.getNodes()
        _, _, (nodes,) = gmsh.model.mesh.getElements(3)
    a, b, c, d = np.moveaxis(points.reshape(-1, 3)[nodes.astype(int).reshape(-1, 4) - 1], 1, 0)
    volume = np.abs(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)).sum() / 6.0
    assert volume == pytest.approx(closed_form_volume(WHEEL, False)["springs_outer"] * 1e9 / 12.0, rel=1e-3)


def test_step_writes_nothing_to_standard_output(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    write_step(WHEEL, tmp_path / "wheel.step")
    assert capfd.readouterr().out == ""


def test_summary_is_json_with_masses(mesh: TaggedMesh) -> None:
    summary = json.loads(json.dumps(summarize_mesh(mesh, WHEEL).as_dict()))
    density = WHEEL.materials["tire"].density
    assert summary["half_width"] is True
    assert summary["hash"] == mesh.hash()
    assert summary["quality"]["n_cells"] == len(mesh.cells) == sum(p["cells"] for p in summary["parts"].values())
    assert summary["parts"]["tire"]["mass"] == pytest.approx(mesh_volume(mesh)["tire"] * density)
    assert summary["total_mass"] == pytest.approx(sum(p["mass"] for p in summary["parts"].values()))
    assert 0.0 < summary["worst_volume_error"] < 1e-3
    assert sum(summary["facets"].values()) == len(mesh.facets)
    assert all(math.isfinite(value) for value in summary["quality"].values())


def test_a_thread_gives_the_same_mesh(mesh: TaggedMesh) -> None:
    result: list[str] = []
    worker = threading.Thread(
        target=lambda: result.append(build_mesh(WHEEL, element_size=20e-3, parts="flexible").hash())
    )
    worker.start()
    worker.join()
    assert result == [mesh.hash()]


def test_a_session_restores_what_it_found() -> None:
    import gmsh

    with pytest.raises(RuntimeError, match="inside"), gmsh_session("fails"):
        raise RuntimeError("inside")
    assert not gmsh.isInitialized()
    gmsh.initialize(interruptible=False)
    try:
        gmsh.model.add("mine")
        gmsh.option.setNumber("Mesh.Algorithm", 8)
        with pytest.raises(RuntimeError, match="inside"), gmsh_session("fails"):
            raise RuntimeError("inside")
        assert gmsh.model.getCurrent() == "mine"
        assert gmsh.option.getNumber("Mesh.Algorithm") == 8
        assert "fails" not in gmsh.model.list()
    finally:
        gmsh.finalize()
