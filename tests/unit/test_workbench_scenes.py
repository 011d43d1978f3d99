"""Scenes of the page: what is packed comes out again, pieces hold what they should."""

from __future__ import annotations

import base64
import json
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from rover_dynamics.rover.rover_file import read_rover
from workbench.charts.packing import packed, picture_link, quantised, unpacked
from workbench.charts.scenes import Look, Piece, Pose, Stressed, coloured_scene, stressed_scene
from workbench.questions.rover.scene import rover_pieces

LOOK = Look(eye=(1.0, -1.0, 0.5), zoom=1.5, alt='a "square"')
SQUARE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 2.0, 0.0], [0.0, 2.0, 0.5]])
QUADS = np.array([[0, 1, 2, 3]])


def _numbers(field: dict[str, object]) -> np.ndarray:
    steps = np.frombuffer(base64.b64decode(str(field["data"])), dtype="<u2")
    return np.asarray(field["low"] + np.float64(field["step"]) * steps)  # type: ignore[operator]


def _content(text: str) -> dict[str, object]:
    found = re.search(r'<script type="text/plain" data-for="([^"]+)">([^<]+)</script>', text)
    assert found
    assert f'id="{found[1]}"' in text
    return dict(json.loads(unpacked(found[2])))


def test_packing_is_undone_and_the_same_at_any_time() -> None:
    assert unpacked(packed("Grüße")) == "Grüße".encode()
    assert packed("x" * 9999) == packed(b"x" * 9999)


@pytest.mark.parametrize("values", [[0.0, -3.0, 2.5], [7.0, 7.0]])
def test_quantised_numbers_are_near(values: list[float]) -> None:
    assert np.allclose(_numbers(quantised(values)), values, atol=np.ptp(values) / 65535)


def test_a_coloured_scene_holds_its_pieces() -> None:
    piece = Piece(name="rim", colour="#123456", points=SQUARE, quads=QUADS)
    text = coloured_scene("here", [piece], "data:,", look=LOOK)
    (one,) = _content(text)["pieces"]  # type: ignore[misc]
    assert (one["name"], one["colour"]) == ("rim", "#123456")
    assert np.allclose(np.column_stack([_numbers(axis) for axis in one["points"]]), SQUARE, atol=1e-4)
    assert np.frombuffer(base64.b64decode(one["quads"]), dtype="<u4").tolist() == [0, 1, 2, 3]
    assert 'alt="a &quot;square&quot;"' in text


def test_a_stressed_scene_holds_its_poses_in_megapascals() -> None:
    pose = Pose(label="0°, 200 N", orientation=0.5, displacement=0.1 * SQUARE, von_mises=np.arange(4) * 1e8)
    wheel = Stressed(points=SQUARE, quads=QUADS, mirrored=True, limit=8.8e8, poses=[pose])
    content = _content(stressed_scene("here", wheel, "data:,", look=LOOK))
    (one,) = content["poses"]  # type: ignore[misc]
    assert (content["mirrored"], content["limit"], one["label"]) == (True, pytest.approx(880.0), "0°, 200 N")
    assert np.allclose(_numbers(one["stress"]), [0.0, 100.0, 200.0, 300.0], atol=0.01)


def test_the_rover_stands_on_the_ground_with_six_wheels() -> None:
    pieces = {piece.name: piece for piece in rover_pieces(read_rover())}
    assert {"principal body", "bogies", "wheels", "ground"} <= set(pieces)
    assert pieces["grousers"].points[:, 2].min() == pytest.approx(0.0, abs=2e-3)
    assert pieces["ground"].points[:, 2].max() == pytest.approx(0.0, abs=1e-9)
    assert all(piece.quads.max() < len(piece.points) for piece in pieces.values())


def test_a_picture_becomes_a_smaller_link(tmp_path: Path) -> None:
    noise = np.random.default_rng(1).integers(0, 255, (80, 80, 3), dtype=np.uint8)
    Image.fromarray(noise).save(tmp_path / "a.png")
    link = picture_link(tmp_path / "a.png")
    assert link.startswith("data:image/webp;base64,")
    assert len(link) < (tmp_path / "a.png").stat().st_size
