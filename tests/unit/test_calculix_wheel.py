"""The CalculiX deck of a wheel: faces, sets, block, steps; on cells whose numbers can be told by hand.

Faces of CalculiX' hexahedra by their nodes: user's manual of CalculiX CrunchiX 2.20, *DLOAD (from memory).
"""

from __future__ import annotations

import math
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmarks.crosscheck import deck_of, refuse_others
from benchmarks.peer_codes.calculix_wheel import WheelDeck, face_labels, write_deck
from contracts.errors import InputError
from contracts.materials import TI_6AL_4V
from contracts.mesh import TaggedMesh
from geometry.build import build_mesh
from reference_fe.verification.structured_hexahedra import block_mesh, stacked
from workbench.study.reading import built_in_study, read_study
from workbench.study.wheel_design import wheel_design

ROOT = Path(__file__).parents[2]
FACES = {1: (0, 1, 2, 3), 2: (4, 7, 6, 5), 3: (0, 4, 5, 1), 4: (1, 5, 6, 2), 5: (2, 6, 7, 3), 6: (3, 7, 4, 0)}


def unit_cell() -> TaggedMesh:
    return block_mesh((1, 1, 1), lambda X: X)


def deck() -> WheelDeck:
    """Two cells one above the other, the upper one held, the lower one on the plane z = 0, y = 0 the middle."""
    mesh = stacked(unit_cell(), block_mesh((1, 1, 1), lambda X: X + np.array([0.0, 0.0, 2.0])), "hub")
    mesh = replace(mesh, faces={**{k: v for k, v in mesh.faces.items() if k != "y0"}, "symmetry": mesh.faces["y0"]})
    return WheelDeck(
        mesh=mesh,
        materials={"body": TI_6AL_4V},
        rigid=("hub",),
        ground_faces=("z0",),
        pairs=(("z1", "hub_z0"),),
        normal=np.array([0.0, 0.0, 1.0]),
        distance_at_touch=0.5,
        deflections=(0.01, 0.02),
        stiffness=1e11,
    )


def blocks(text: str) -> list[tuple[str, list[str]]]:
    """Keyword lines with the lines behind them."""
    return [(part.split("\n")[0], part.split("\n")[1:]) for part in re.split(r"\n(?=\*)", text.strip())]


def lines_of(text: str, keyword: str) -> list[str]:
    (found,) = (lines for head, lines in blocks(text) if head == keyword)
    return found


def test_a_face_has_the_number_that_calculix_gives_its_nodes() -> None:
    mesh = unit_cell()
    for name, tag in mesh.faces.items():
        ((cell, number),) = face_labels(mesh, name)
        corners = mesh.facets[mesh.facet_tags == tag][0, :4]
        assert set(mesh.cells[cell, list(FACES[number])]) == set(corners), name


def test_facets_at_the_nodes_named_are_left_out() -> None:
    mesh = block_mesh((3, 1, 1), lambda X: X)
    assert len(face_labels(mesh, "z0")) == 3
    edge = mesh.facets[mesh.facet_tags == mesh.faces["x0"]].ravel()
    assert [cell for cell, _ in face_labels(mesh, "z0", edge)] == [1, 2]


def test_deck_has_sets_surfaces_and_a_step_for_each_deflection(tmp_path: Path) -> None:
    write_deck(deck(), tmp_path)
    mesh, case = (tmp_path / "mesh.inp").read_text(), (tmp_path / "case.inp").read_text()
    assert len(lines_of(mesh, "*NODE, NSET=ALL_NODES")) == 40
    assert sum(len(line.split(",")) for line in lines_of(mesh, "*NSET, NSET=HELD")) == 20
    assert sum(len(line.split(",")) for line in lines_of(mesh, "*NSET, NSET=MIDDLE")) == 8
    assert lines_of(case, "*SURFACE, NAME=TREAD") == ["1, S1"]
    assert (lines_of(case, "*SURFACE, NAME=S0"), lines_of(case, "*SURFACE, NAME=M0")) == (["1, S2"], ["2, S1"])
    pairs = [lines for head, lines in blocks(case) if head.startswith("*CONTACT PAIR")]
    assert pairs == [["TREAD, PLANE"], ["S0, M0"]]
    assert "*FRICTION" not in case
    assert places(case) == [(0.0, -0.01), (0.0, -0.02)]


def places(case: str) -> list[tuple[float, float]]:
    """Of the hub, x and z, at the end of each step."""
    found = re.findall(r"^HELD, 1, 1, (\S+)\nHELD, 3, 3, (\S+)", case, re.MULTILINE)
    assert len(found) == len(re.findall(r"^\*STEP, NLGEOM", case, re.MULTILINE))
    return [(float(x), float(z)) for x, z in found]


def test_a_hub_that_is_moved_goes_forwards_at_its_last_deflection_on_ground_with_friction(tmp_path: Path) -> None:
    """Forwards is x where the ground lies below; the springs' contact stays without friction."""
    write_deck(replace(deck(), friction=0.6, travels=(0.003,)), tmp_path)
    case = (tmp_path / "case.inp").read_text()
    assert places(case) == [(0.0, -0.01), (0.0, -0.02), (0.003, -0.02)]
    assert lines_of(case, "*FRICTION") == ["0.6, 100000000000.0"]
    kinds = [head for head, _ in blocks(case) if head.startswith(("*SURFACE INTERACTION", "*FRICTION"))]
    assert kinds == ["*SURFACE INTERACTION, NAME=GROUNDED", "*FRICTION", "*SURFACE INTERACTION, NAME=PENALTY"]


def test_the_block_lies_below_the_plane_and_faces_the_wheel(tmp_path: Path) -> None:
    """Nodes 1 to 4 below, 5 to 8 on the plane, turning about the normal: face 2 looks along it."""
    tilted = replace(deck(), normal=np.array([0.6, 0.0, 0.8]))
    write_deck(tilted, tmp_path)
    case = (tmp_path / "case.inp").read_text()
    nodes = np.array([[float(v) for v in line.split(",")] for line in lines_of(case, "*NODE")])
    numbers, x = nodes[:, 0].astype(int).tolist(), nodes[:, 1:]
    assert lines_of(case, "*ELEMENT, TYPE=C3D8, ELSET=BLOCK") == [f"3, {', '.join(map(str, numbers))}"]
    assert set(numbers).isdisjoint(range(1, 55))
    np.testing.assert_allclose(x[4:] @ tilted.normal, -0.5, atol=1e-12)
    assert (x[:4] @ tilted.normal).max() < -1.0
    around = np.cross(x[5] - x[4], x[7] - x[4])
    assert around @ tilted.normal / np.linalg.norm(around) == pytest.approx(1.0)


def test_the_study_wheel_touches_first_where_ours_does() -> None:
    study = read_study(built_in_study())
    mesh = build_mesh(wheel_design(study), element_size=0.03, parts="flexible")
    made = deck_of(study, mesh, 0.0, (0.01,))
    turned = math.radians(0.97)  # the grouser's tip, 1 mm wide on 142.5 + 3 mm: its corner is lowest
    lowest = 0.1455 * math.cos(turned) + 0.0005 * math.sin(turned)
    assert made.distance_at_touch == pytest.approx(lowest, abs=2e-6)
    np.testing.assert_allclose(made.normal, [0.0, 0.0, 1.0], atol=1e-12)
    assert set(made.pairs) == {("springs_outer_front", "tire_inner"), ("springs_inner_front", "tire_inner")}


def test_a_study_that_the_deck_does_not_describe_is_refused() -> None:
    study = read_study(built_in_study())
    refuse_others(study)
    with pytest.raises(InputError, match="smooth plane"):
        refuse_others(study.model_copy(update={"fe": study.fe.model_copy(update={"friction": 0.5})}))


def test_without_calculix_one_message_says_how_to_install_it(tmp_path: Path) -> None:
    environment = {"PATH": str(tmp_path), "OMP_NUM_THREADS": "1"}
    command = [sys.executable, str(ROOT / "benchmarks" / "crosscheck.py")]
    run = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert run.returncode == 2
    assert "apt-get install calculix-ccx" in run.stderr.splitlines()[-1]
