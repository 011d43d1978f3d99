"""A wheel's own mesh as a user gives it, and our own mesh read back.

Claim: our mesh written as .msh or .inp and read as the wheel's own gives the load that the study's wheel gives on the
same mesh. Tolerance: 1e-10 of the load, what the deck's 13 digits leave (6e-11 measured); 1e-11 for the .msh file.
Negative control: without the pairs that touch, or with another part held, the load is another.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from contracts.curves import read_curve
from contracts.materials import Material
from contracts.mesh import TaggedMesh
from geometry.build import build_mesh
from geometry.checks import check_mesh
from geometry.gmsh_session import gmsh_session
from geometry.inp import write_inp
from geometry.msh import write_msh
from geometry.own_mesh.files import read_mesh_file
from geometry.own_mesh.roles import Placement, Roles
from geometry.own_mesh.wheel_mesh import wheel_of_file
from reference_fe.wheel.case import NamedFaces, WheelLoadCase
from reference_fe.wheel.pressed import solve_wheel
from tests.end_to_end.small_study import ROOT, run, said, tiny_study
from tests.ring_wheel import MILLIMETRES, ring_deck, ring_wheel
from tests.ring_wheel import ROLES as DISC
from workbench.study.reading import read_study
from workbench.study.wheel_design import wheel_design

SPIRAL = ROOT / "studies/spiral.toml"

PAIRS = (
    ("springs_front", "tire_inner"),
    ("springs_front", "outer_hub_outer"),
    ("springs_back", "outer_hub_outer"),
    ("springs_front", "springs_front"),
    ("springs_back", "springs_back"),
    ("tire_inner", "outer_hub_outer"),
)
ROLES = Roles(
    parts={name: (name,) for name in ("tire", "grousers", "springs", "outer_hub")},
    hub=("outer_hub",),
    ground=("tire_outer", "grouser_outer"),
    contact=PAIRS,
    symmetry="symmetry",
)
FACES = NamedFaces(ground=ROLES.ground, pairs=PAIRS)
CASE = WheelLoadCase(orientation_deg=0.0, deflections=(0.003, 0.006))


@pytest.fixture(scope="module")
def ours(tmp_path_factory: pytest.TempPathFactory) -> tuple[TaggedMesh, Path]:
    """The tiny study's mesh, and the folder with its files."""
    folder = tmp_path_factory.mktemp("own")
    (folder / "tiny.toml").write_text(tiny_study(), encoding="utf-8")
    design = wheel_design(read_study(folder / "tiny.toml"))
    mesh = build_mesh(design, element_size=0.024, axial_size=0.060, parts="flexible")
    write_msh(mesh, folder / "wheel.msh")
    write_inp(mesh, folder / "wheel.inp")
    return mesh, folder


def _loads(mesh: TaggedMesh, folder: Path, case: WheelLoadCase) -> np.ndarray:
    materials = wheel_design(read_study(folder / "tiny.toml")).materials
    return solve_wheel(mesh, materials, case).curve.load


@pytest.fixture(scope="module")
def known(ours: tuple[TaggedMesh, Path]) -> np.ndarray:
    return _loads(*ours, CASE)


@pytest.mark.parametrize(("name", "tolerance"), [("wheel.msh", 1e-11), ("wheel.inp", 1e-10)])
def test_our_own_mesh_read_back_carries_the_same_load(
    ours: tuple[TaggedMesh, Path], known: np.ndarray, name: str, tolerance: float
) -> None:
    mesh = wheel_of_file(read_mesh_file(ours[1] / name), ROLES, Placement(unit=1.0))
    check_mesh(mesh)
    found = _loads(mesh, ours[1], replace(CASE, rigid_parts=("outer_hub",), faces=FACES))
    assert found == pytest.approx(known, rel=tolerance)
    assert found[-1] > 50.0


def test_negative_control_another_hub_carries_another_load(ours: tuple[TaggedMesh, Path], known: np.ndarray) -> None:
    """The bore held in place of the whole ring: the ring bends, the load falls."""
    roles = replace(ROLES, hub=("outer_hub_bore",))
    mesh = wheel_of_file(read_mesh_file(ours[1] / "wheel.msh"), roles, Placement(unit=1.0))
    faces = replace(FACES, held=("outer_hub_bore",))
    found = _loads(mesh, ours[1], replace(CASE, rigid_parts=(), faces=faces))
    assert 1e-4 < 1.0 - found[-1] / known[-1] < 0.1


STUDY = """
name = "disc"
title = "A disc of rubber"
[mesh]
file = "disc.inp"
units = "mm"
hub = ["bore"]
ground = ["tread"]
[mesh.parts]
hub = { material = "rubber" }
rim = { material = "rubber" }
[materials.rubber]
young_modulus = "5 MPa"
poisson_ratio = 0.4
density = "1100 kg/m^3"
yield_strength = "2 MPa"
source = "made up"
[fe]
orientations = ["0 deg"]
max_deflection = "1 mm"
points = 8
max_load = "300 N"
snapshot_loads = ["20 N"]
"""


@pytest.fixture
def disc(tmp_path: Path) -> Path:
    (tmp_path / "disc.inp").write_text(ring_deck(20))
    (tmp_path / "disc.toml").write_text(STUDY)
    return tmp_path / "disc.toml"


def test_the_commands_on_a_deck(disc: Path) -> None:
    store = disc.parent / "store"
    done = said("check", disc)
    assert done.returncode == 0, done.stderr
    done = run("mesh", disc, "--out", disc.parent / "mesh", "--store", store)
    assert done.returncode == 0, done.stderr
    summary = json.loads((disc.parent / "mesh" / "summary.json").read_text())
    assert summary["outer_radius"] == pytest.approx(0.1)
    assert summary["parts"]["rim"]["cells"] == 12
    written = {path.name for path in (disc.parent / "mesh").iterdir() if path.name[0] != "."}
    assert written == {"solved.msh", "solved.vtu", "summary.json", "wheel.png"}
    done = run("report", disc, "--out", disc.parent / "report", "--store", store)
    assert done.returncode == 0, done.stderr
    page = (disc.parent / "report" / "report.html").read_text()
    assert "comes from another program (disc.inp): 24 hexahedra" in page
    assert "nan" not in page.replace("finance", "").lower().split("<script")[0]
    curve = read_curve(disc.parent / "report" / "curves" / "fe_phi000.csv", model="fe")
    assert curve.load[-1] > 20.0
    assert curve.columns["force_imbalance"].max() < 1e-6


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"mm"', '"m"', "mesh.units: radius of the ground faces = 100 m: is that of no wheel"),
        ('["tread"]', '["bore"]', "mesh.hub = bore: names what mesh.ground names too"),
        ('hub = ["bore"]', 'hub = ["axle"]', "mesh.hub: group of faces = axle: is no group of faces"),
        ('rim = { material = "rubber" }', "", "mesh.parts: leaves 12 cells without a material, those of"),
        ("disc.inp", "none.inp", "none.inp: does not exist"),
        ("disc.inp", "disc.toml", "mesh.file = 'disc.toml': .toml is not read"),
    ],
)
def test_a_fault_is_one_message_and_status_2(disc: Path, old: str, new: str, words: str) -> None:
    disc.write_text(STUDY.replace(old, new, 1))
    done = said("check", disc)
    assert done.returncode == 2
    assert len([line for line in done.stderr.splitlines() if "workbench: error:" in line]) == 1
    assert words in " ".join(done.stderr.split())


@pytest.mark.parametrize("file", ["spiral.inp", "spoked.step"])
def test_a_shipped_study_is_begun_elsewhere_with_its_mesh(tmp_path: Path, file: str) -> None:
    done = said("new", tmp_path / "mine.toml", "--from", file.partition(".")[0])
    assert done.returncode == 0, done.stderr
    assert said("check", tmp_path / "mine.toml").returncode == 0
    assert str(ROOT / "studies" / file) in (tmp_path / "mine.toml").read_text()


def test_solids_are_listed_before_a_wrong_name_is_told(tmp_path: Path) -> None:
    done = said("new", tmp_path / "mine.toml", "--from", "spoked")
    assert done.returncode == 0, done.stderr
    text = (tmp_path / "mine.toml").read_text()
    (tmp_path / "mine.toml").write_text(text.replace('radius = "100 mm"', 'radius = "125 mm"'))
    done = said("check", tmp_path / "mine.toml")
    assert done.returncode == 2
    assert "mesh.faces.tread: rule = radius 125 mm: holds for no face" in " ".join(done.stderr.split())
    assert "of rim: cylinder, radius 100 mm, position 0 to 20 mm" in " ".join(done.stdout.split())


@pytest.mark.long
def test_a_wheel_of_solids_is_solved(tmp_path: Path) -> None:
    done = said("new", tmp_path / "mine.toml", "--from", "spoked")
    assert done.returncode == 0, done.stderr
    text = (tmp_path / "mine.toml").read_text()
    short = text.replace('max_deflection = "1.5 mm"', 'max_deflection = "0.5 mm"').replace("points = 6", "points = 2")
    (tmp_path / "mine.toml").write_text(short)
    options = ("--orientation", "0", "--out", tmp_path / "out", "--store", tmp_path / "store")
    done = run("stiffness", tmp_path / "mine.toml", *options)
    assert done.returncode == 0, done.stderr
    curve = read_curve(tmp_path / "out" / "curves" / "fe_phi000.csv", model="fe")
    assert curve.load[-1] > 20.0
    assert curve.columns["force_imbalance"].max() < 1e-6
    assert curve.columns["force_left_N"][-1] == 0.0, "half a wheel stands for the whole"


def _tetrahedra(folder: Path, order: int) -> Path:
    """The disc in some 260 tetrahedra of gmsh's, hub and rim, bore and tread by name."""
    with gmsh_session("disc") as gmsh:
        occ = gmsh.model.occ
        outer, hub, bore = (occ.addCylinder(0, -25, 0, 0, 50, 0, r) for r in (100, 70, 40))
        ring, _ = occ.cut([(3, hub)], [(3, bore)])
        occ.fragment([(3, outer)], ring)
        occ.synchronize()
        boxes = {one: gmsh.model.getBoundingBox(*one) for dim in (2, 3) for one in gmsh.model.getEntities(dim)}
        reach = {one: box[3] for one, box in boxes.items()}
        wide = {tag: box[4] - box[1] > 40 for (dim, tag), box in boxes.items() if dim == 2}
        for name, (low, high) in {"hub": (50, 80), "rim": (80, 110)}.items():
            gmsh.model.addPhysicalGroup(3, [t for (d, t), r in reach.items() if d == 3 and low < r < high], name=name)
        for name, (low, high) in {"bore": (30, 50), "tread": (90, 110)}.items():
            chosen = [t for (d, t), r in reach.items() if d == 2 and low < r < high and wide[t]]
            gmsh.model.addPhysicalGroup(2, chosen, name=name)
        for size in ("Min", "Max"):
            gmsh.option.setNumber(f"Mesh.MeshSize{size}", 50.0)
        gmsh.option.setNumber("Mesh.Optimize", 1.0)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(order)
        gmsh.write(str(folder / f"disc{order}.msh"))
    return folder / f"disc{order}.msh"


def test_tetrahedra_carry_what_hexahedra_do(tmp_path: Path) -> None:
    """At 0.25 mm within 3 %, by which three meshes of hexahedra differ; negative control: straight ones do not."""
    rubber = Material(
        name="rubber", young_modulus=5e6, poisson_ratio=0.4, density=1100.0, yield_strength=2e6, source="made up"
    )
    faces = NamedFaces(ground=("tread",), held=("bore",))
    case = WheelLoadCase(orientation_deg=0.0, deflections=(0.00025,), rigid_parts=(), faces=faces)
    loads = {}
    files = {"hexahedra": ring_wheel(20), **{f"order {n}": read_mesh_file(_tetrahedra(tmp_path, n)) for n in (1, 2)}}
    for name, file in files.items():
        mesh = wheel_of_file(file, DISC, MILLIMETRES)
        loads[name] = float(solve_wheel(mesh, dict.fromkeys(("hub", "rim"), rubber), case).curve.load[-1])
    assert loads["order 2"] == pytest.approx(loads["hexahedra"], rel=0.03)
    assert loads["order 1"] < 0.5 * loads["hexahedra"], "a polygon first touches with an edge"


def test_a_wrong_unit_is_asked_about(tmp_path: Path) -> None:
    """Inches for millimetres make a wheel of three metres, which is one, but no rover's."""
    text = SPIRAL.read_text(encoding="utf-8").replace('units = "mm"', 'units = "in"')
    (tmp_path / "spiral.inp").write_bytes(SPIRAL.with_suffix(".inp").read_bytes())
    (tmp_path / "inch.toml").write_text(text, encoding="utf-8")
    ended = run("check", tmp_path / "inch.toml")
    assert ended.returncode == 0
    assert "a radius of 3175 mm is unusual" in " ".join(ended.stderr.split())
    assert "radius 3175 mm" in " ".join(ended.stdout.split())
