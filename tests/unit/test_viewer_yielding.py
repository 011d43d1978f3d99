"""What is marked as above yield: by part, by the smaller strength where two meet; and the file that says how much."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.errors import InputError
from tests.small_report_folder import STRENGTHS, ring_mesh, write_small_report
from workbench.questions.fe.parts_file import PARTS_FILE, parts_text, read_parts
from workbench.viewer.folder import read_folder
from workbench.viewer.wheel_body import Cut, wheel_body
from workbench.viewer.yielding import above_yield, legend, marked_share


def test_points_are_marked_by_the_strength_of_their_part() -> None:
    mesh = ring_mesh()
    body = wheel_body(mesh.points, mesh.cells, mesh.cell_tags.astype(np.int64))
    surface, stress = body.surface(), np.full(len(mesh.points), 200e6)
    radius = np.hypot(surface.places[:, 0], surface.places[:, 2])
    inner = above_yield(surface, stress, {1: 150e6, 2: 300e6})
    np.testing.assert_array_equal(inner, radius < 0.13)  # part 1, and where it meets part 2
    np.testing.assert_array_equal(above_yield(surface, stress, {2: 150e6}), radius > 0.11)
    assert not above_yield(surface, stress, {1: 200e6, 2: 300e6}).any()  # to reach it is not to exceed it
    assert not above_yield(surface, stress, {}).any()
    outer = body.surface(Cut(hidden=frozenset({1})))
    assert not above_yield(outer, stress, {1: 150e6, 2: 300e6}).any()
    nothing = body.surface(Cut(hidden=frozenset({1, 2})))
    assert above_yield(nothing, stress, {1: 1.0}).shape == (0,)
    assert marked_share(nothing, above_yield(nothing, stress, {1: 1.0})) == 0.0


def test_the_share_is_of_the_area_that_is_drawn() -> None:
    mesh = ring_mesh()
    body = wheel_body(mesh.points, mesh.cells, mesh.cell_tags.astype(np.int64))
    surface = body.surface()
    assert marked_share(surface, np.ones(len(surface.nodes), dtype=bool)) == pytest.approx(1.0)
    side = 48 / 2 * np.sin(2 * np.pi / 48) * (0.14**2 - 0.1**2)
    around = 2 * 48 * np.sin(np.pi / 48) * (0.14 + 0.1) * 0.1
    marked = side + 0.25 * around  # of what lies around, the half that reaches from y = 0 to this side, by two corners
    assert marked_share(surface, surface.places[:, 1] > 0.0) == pytest.approx(marked / (2 * side + around))
    upper = marked_share(surface, surface.places[:, 2] > 1e-9)
    assert upper == pytest.approx(23 / 48)  # two of 48 strips end at z = 0


@pytest.mark.parametrize(
    ("strengths", "text"),
    [
        ({"tire": 255e6, "hub": 255e6}, "above yield strength: 255 MPa (3.1 % of the surface)"),
        (
            {"tire": 255e6, "leaf": 880e6, "hub": 255e6},
            "above yield strength: 255 MPa tire and hub, 880 MPa leaf (3.1 % of the surface)",
        ),
        ({c: k * 1e8 for k, c in enumerate("abcd", 1)}, "above yield strength: 100 MPa to 400 MPa, by part (3.1 % of"),
    ],
)
def test_the_legend_names_the_strengths(strengths: dict[str, float], text: str) -> None:
    assert legend(strengths, 0.0312).startswith(text)


def test_strengths_are_known_by_the_tags_of_the_parts(tmp_path: Path) -> None:
    write_small_report(tmp_path)
    found = read_folder(tmp_path)
    assert found.yield_strengths == STRENGTHS
    assert found.strengths_of("fe", 30.0) == {1: STRENGTHS["hub"], 2: STRENGTHS["tire"]}
    assert found.strengths_of("fe", 45.0) == {}
    held = STRENGTHS | {"outer_hub": 900e6}  # rigid, and so without a stress in the curve
    (tmp_path / "fields" / PARTS_FILE).write_text(parts_text(held), encoding="utf-8")
    assert read_folder(tmp_path).parts_of("fe", 30.0) == ("hub", "tire", "outer_hub")
    assert read_folder(tmp_path).strengths_of("fe", 30.0)[3] == 900e6
    (tmp_path / "fields" / PARTS_FILE).unlink()
    assert read_folder(tmp_path).strengths_of("fe", 30.0) == {}


@pytest.mark.parametrize(
    "content",
    [
        *("{", "[]", "{}", '{"yield_strength_Pa": 3}', '{"yield_strength_Pa": {"tire": "x"}}'),
        *(f'{{"yield_strength_Pa": {{"tire": {value}}}}}' for value in ("0", "-1", "true", "null", "1e999", "[]")),
    ],
)
def test_a_bad_parts_file_is_one_message(tmp_path: Path, content: str) -> None:
    path = tmp_path / PARTS_FILE
    path.write_text(parts_text({"tire": 255e6}), encoding="utf-8")
    assert read_parts(path) == {"tire": 255e6}
    path.write_text(content, encoding="utf-8")
    with pytest.raises(InputError, match=r"parts file = .*parts\.json"):
        read_parts(path)
