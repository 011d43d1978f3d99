"""Modes as they are drawn: mirrored by their parity, of a chosen size, upright; and files that are none."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from contracts.errors import InputError
from tests.small_report_folder import ring_mesh, write_small_modes
from workbench.viewer.charts import modes_chart
from workbench.viewer.folder import read_folder
from workbench.viewer.mode_shapes import read_modes
from workbench.viewer.modes_stage import FRAMES, ModesStage
from workbench.viewer.scene import Scene


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """What ``workbench modes --out`` leaves."""
    write_small_modes(tmp_path / "modes")
    return tmp_path


def test_a_folder_of_modes_alone_is_found_with_its_states(folder: Path) -> None:
    plates, solid = read_folder(folder).modes
    assert (solid.title, solid.orientation) == ("FE, held at its hub", 0.0)
    assert (plates.title, plates.orientation) == ("ANCF wheel, standing on 30° under 200 N", 30.0)
    (folder / "modes" / "modes_fe_held.csv").rename(folder / "modes" / "modes_fe_standing_phi015_100N_grip.csv")
    (folder / "modes" / "modes_fe_held.vtu").rename(folder / "modes" / "modes_fe_standing_phi015_100N_grip.vtu")
    titles = [one.title for one in read_folder(folder).modes]
    assert titles[1] == "FE, standing on 15° under 100 N, gripping"
    (folder / "modes" / "modes_ancf_wheel_standing_phi030_200N.csv").unlink()
    found = read_folder(folder)
    assert len(found.modes) == 1
    assert found.left_out == ("modes/modes_ancf_wheel_standing_phi030_200N.csv",)


def test_the_other_half_moves_by_the_parity_of_the_mode(folder: Path) -> None:
    stage = ModesStage(read_folder(folder).modes[1])
    surface, mesh = stage.found.surface, ring_mesh()
    assert [one.words for one in stage.found.modes] == ["18.54 Hz, torsional", "32.20 Hz, lateral"]
    assert len(surface.quads) == 2 * 48 * 4
    turn = stage.found.displacement(0)
    np.testing.assert_allclose(turn, np.cross((0.0, 1.0, 0.0), surface.places) / 0.14, atol=1e-6)
    np.testing.assert_allclose(stage.found.displacement(1), np.tile([0.0, 1.0, 0.0], (len(turn), 1)), atol=1e-6)
    assert float(np.linalg.norm(mesh.points[:, [0, 2]], axis=1).max()) == pytest.approx(0.14)


def test_a_swing_goes_there_and_back_with_the_chosen_size(folder: Path) -> None:
    stage = ModesStage(read_folder(folder).modes[1])
    rest = stage.places(1, 0.1, 0)
    np.testing.assert_allclose(rest, stage.found.surface.places, atol=1e-12)
    moved = [stage.places(1, 0.1, frame)[:, 1] - rest[:, 1] for frame in range(FRAMES + 1)]
    expected = 0.014 * np.sin(2.0 * np.pi * np.arange(FRAMES + 1) / FRAMES)
    np.testing.assert_allclose([one.min() for one in moved], expected, atol=1e-8)
    np.testing.assert_allclose([one.max() for one in moved], expected, atol=1e-8)


def test_what_faces_the_ground_is_below(folder: Path) -> None:
    stage = ModesStage(read_folder(folder).modes[0])
    assert stage.found.modes[0].words == "grows at 12.5/s, radial n=2"
    down = stage.found.surface.places @ np.array([0.5, 0.0, -np.sqrt(0.75)])
    np.testing.assert_allclose(-stage.places(0, 0.1, 0)[:, 2], down, atol=1e-12)


def test_modes_are_drawn_and_charted(folder: Path) -> None:
    stage, scene = ModesStage(read_folder(folder).modes[1]), Scene()
    for number in (0, 1):
        stage.show(scene, number, 0.1, FRAMES // 4)
        (drawn,) = scene._now.shapes
        np.testing.assert_allclose(drawn.points, stage.places(number, 0.1, FRAMES // 4), atol=1e-7)
    scene.close()
    figure = modes_chart(stage.found.modes, 1)
    assert figure["data"][0]["y"] == [18.54, 32.2]
    assert len(set(figure["data"][0]["marker"]["color"])) == 2


DAMAGES: dict[str, tuple[str, Callable[[str], str]]] = {
    "no table": (".csv", lambda _: ""),
    "a column is missing": (".csv", lambda text: text.replace("kind", "kid")),
    "a word for a number": (".csv", lambda text: text.replace("32.2", "x")),
    "an endless frequency": (".csv", lambda text: text.replace("32.2", "inf")),
    "a row is cut": (".csv", lambda text: text[:-20]),
    "more modes than shapes": (".csv", lambda text: text + text.splitlines()[1] + "\n"),
    "a shape is missing": (".vtu", lambda text: text.replace("mode_02", "mode_03")),
    "half a file": (".vtu", lambda text: text[: len(text) // 2]),
    "no such cells": (".vtu", lambda text: text.replace('Name="connectivity"', 'Name="c"')),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_damaged_modes_are_one_message(folder: Path, damage: str) -> None:
    ending, change = DAMAGES[damage]
    path = (folder / "modes" / "modes_fe_held").with_suffix(ending)
    before = path.read_text(encoding="utf-8")
    assert change(before) != before
    path.write_text(change(before), encoding="utf-8")
    with pytest.raises(InputError, match=r"(field file|table of modes) = .*modes_fe_held\."):
        read_modes(read_folder(folder).modes[1])
