"""The rover's animation: bodies drawn where the motion has them, and a page that needs nothing but itself.

Claim: a wheel's marked spoke is seen, in the rendered picture, where the driven angle puts it, to two pixels; the page
holds one picture for each time drawn and names no other file or address. Source: the projection written out here.
Negative control: a wheel that is not turned, and a page with an address in it, are noticed.
"""

from __future__ import annotations

import base64
import io
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from contracts.errors import InputError
from contracts.height_field import HeightField
from contracts.terrain import Plane, inclined_plane
from contracts.terrain_ridges import Step
from rover_dynamics.rover.rover import build_rover
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.vehicle.vehicle import VehicleMotion
from workbench.charts.solids import Solid
from workbench.charts.stills import View, draw_motion
from workbench.questions.rover.animation import framing, shown_frames, write_animation
from workbench.questions.rover.solids import MARKER, body_names, ground_solids, rover_solids

DESIGN = read_rover()
NAMES = body_names(DESIGN)
WHEELS = [number for number, name in enumerate(NAMES) if name.startswith("wheel_")]
SIDE = View(eye=(0.0, -1.0, 0.0), up=(0.0, 0.0, 1.0), centre=(0.0, 0.0, 0.0), scale=500.0, size=(240, 240))
EXTERNAL = re.compile(r"https?:|//[a-z]|file:|\b(?:src|href|url)\s*[=(]\s*[\"']?(?!data:)[\w./]", re.IGNORECASE)
FloatArray = NDArray[np.float64]


def about_y(angle: float) -> FloatArray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def rolling(n: int = 4, distance: float = 0.3) -> VehicleMotion:
    """The rover moved forward, its wheels rolling, without dynamics."""
    bodies = build_rover(DESIGN).model.bodies
    times = np.linspace(0.0, 4.0, n)
    way = distance * times / times[-1]
    positions = np.array([body.position for body in bodies]) + way[:, None, None] * np.array([1.0, 0.0, 0.0])
    rotations = np.tile(np.eye(3), (n, len(bodies), 1, 1))
    for k in range(n):
        rotations[k, WHEELS] = about_y(way[k] / DESIGN.wheel_radius)
    velocities = np.zeros((n, len(bodies), 6))
    velocities[..., 0] = distance / times[-1]
    nothing = np.zeros((n, 6, 10))
    return VehicleMotion(
        times=times,
        positions=positions,
        rotations=rotations,
        velocities=velocities,
        tires=nothing,
        wrenches=nothing[..., :6],
        efforts=np.zeros((n, 0)),
        steps=0,
        iterations=0,
        rejected=0,
    )


def marked(picture: NDArray[np.uint8]) -> FloatArray:
    """Middle of what is drawn in the marker's colour, right and up from the picture's middle [pixels]."""
    red, green, blue = (picture[..., k].astype(int) for k in range(3))
    rows, columns = np.nonzero((red > green + 60) & (green > blue + 20))
    middle = 0.5 * (np.array(picture.shape[:2]) - 1.0)
    return np.array([columns.mean() - middle[1], middle[0] - rows.mean()])


def marker_of_a_wheel() -> list[Solid]:
    return [s for s in rover_solids(DESIGN) if s.body == NAMES.index("wheel_front_right") and s.colours == MARKER]


def test_bodies_are_in_the_order_of_the_vehicle() -> None:
    bodies = build_rover(DESIGN).model.bodies
    assert tuple(body.name for body in bodies) == NAMES
    assert {solid.body for solid in rover_solids(DESIGN)} == set(range(len(bodies)))


def test_the_marked_spoke_turns_by_the_driven_angle() -> None:
    angles = np.array([0.0, 0.5 * np.pi, 2.0, 4.5])
    positions = np.zeros((len(angles), len(NAMES), 3))
    rotations = np.array([np.tile(about_y(angle), (len(NAMES), 1, 1)) for angle in angles])
    pictures = list(draw_motion(marker_of_a_wheel(), positions, rotations, SIDE))
    middle = 0.6 * DESIGN.wheel_radius * SIDE.scale
    ahead = middle * np.column_stack([np.cos(angles), -np.sin(angles)])
    assert np.array([marked(picture) for picture in pictures]) == pytest.approx(ahead, abs=2.0)


def test_negative_control_a_wheel_that_is_not_turned_is_noticed() -> None:
    positions, rotations = np.zeros((1, len(NAMES), 3)), np.tile(np.eye(3), (1, len(NAMES), 1, 1))
    (picture,) = draw_motion(marker_of_a_wheel(), positions, rotations, SIDE)
    quarter = 0.6 * DESIGN.wheel_radius * SIDE.scale * np.array([0.0, -1.0])
    assert np.linalg.norm(marked(picture) - quarter) > 20.0


def test_wheels_touch_the_ground_and_joints_meet() -> None:
    bodies = build_rover(DESIGN).model.bodies
    positions, rotations = np.array([body.position for body in bodies]), np.tile(np.eye(3), (len(bodies), 1, 1))
    solids = rover_solids(DESIGN)
    lowest = [min(s.placed(positions, rotations)[:, 2].min() for s in solids if s.body == wheel) for wheel in WHEELS]
    assert lowest == pytest.approx([0.0] * 6, abs=2e-3)
    steering = np.array(DESIGN.legs[0].steering) + np.array([0.0, 0.0, DESIGN.wheel_radius])
    for part in ("arm", "spindle"):
        (solid,) = (s for s in solids if s.body == NAMES.index(f"{part}_{DESIGN.legs[0].name}"))
        assert np.linalg.norm(solid.placed(positions, rotations) - steering, axis=1).min() < 0.04


def test_the_ground_follows_the_terrain_and_keeps_its_squares() -> None:
    places = np.array([[-0.6, -0.5], [1.4, 0.5]])
    step = Step(rise=0.25, edge_radius=0.005, position=0.5)
    surface, _ = ground_solids(step, places)
    assert surface.points[:, 2] == pytest.approx(step.height(surface.points[:, 0], surface.points[:, 1]))
    assert surface.points[:, 2].max() == pytest.approx(0.25)
    flat, _ = ground_solids(Plane(), places)
    widths = np.ptp(flat.points[flat.quads][:, :, 0], axis=1)
    assert widths.max() == pytest.approx(0.25)
    assert len(np.unique(np.asarray(flat.colours), axis=0)) == 2


def test_the_slab_of_ground_is_closed_but_for_its_bottom() -> None:
    solids = ground_solids(Step(rise=0.25, edge_radius=0.005, position=0.5), np.array([[-0.6, -0.5], [1.4, 0.5]]))
    size = np.ptp(solids[0].points, axis=0)
    corners = [solid.points[solid.quads] for solid in solids]
    areas = [0.5 * np.cross(c[:, 2] - c[:, 0], c[:, 3] - c[:, 1]).sum(axis=0) for c in corners]
    assert sum(areas) == pytest.approx(np.array([0.0, 0.0, size[0] * size[1]]), abs=1e-12)


def test_the_ground_ends_with_its_height_field() -> None:
    field = HeightField(heights=np.zeros((21, 11)), spacing=(0.1, 0.1), origin=(-1.0, -0.5))
    surface, _ = ground_solids(field, np.array([[-0.9, -0.4], [0.9, 0.4]]))
    assert surface.points.min(axis=0) == pytest.approx([-1.0, -0.5, 0.0])
    assert surface.points.max(axis=0) == pytest.approx([1.0, 0.5, 0.0])


@pytest.mark.parametrize("up", [(0.0, 0.0, 1.0), (0.4, 0.0, 0.9), (0.0, -0.4, 0.9)])
def test_nothing_is_clipped(up: tuple[float, float, float]) -> None:
    motion = rolling()
    solids = [*rover_solids(DESIGN), *ground_solids(inclined_plane(0.2), np.array([[-1.0, -0.8], [1.2, 0.8]]))]
    view = framing(solids, motion.positions, motion.rotations, up)
    right = np.cross(view.up, view.eye)
    assert np.dot(view.eye, view.up) == pytest.approx(0.0, abs=1e-12)
    for k in range(len(motion.times)):
        points = np.concatenate([s.placed(motion.positions[k], motion.rotations[k]) for s in solids]) - view.centre
        assert np.abs(points @ right).max() * view.scale < 0.5 * view.size[0]
        assert np.abs(points @ np.array(view.up)).max() * view.scale < 0.5 * view.size[1]


@pytest.mark.parametrize("pull", [(0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)])
def test_no_slope_of_25_degrees_is_seen_edge_on(pull: tuple[float, float]) -> None:
    motion, slope = rolling(2), 0.4363
    up = (-pull[0] * np.sin(slope), -pull[1] * np.sin(slope), np.cos(slope))
    view = framing(rover_solids(DESIGN), motion.positions, motion.rotations, up)
    assert view.eye[2] > np.sin(0.3)
    if pull == (0.0, 0.0):
        assert view.eye[0] < 0.0
        assert view.eye[1] < 0.0


def test_frames_are_spread_over_the_times_with_both_ends() -> None:
    times = np.linspace(0.0, 40.0, 401)
    chosen = shown_frames(times, 41)
    assert times[chosen] == pytest.approx(np.arange(41.0))
    assert shown_frames(times[:7], 41).tolist() == list(range(7))


def test_the_page_holds_its_frames_and_needs_nothing_else(tmp_path: Path) -> None:
    path, motion = tmp_path / "rover.html", rolling()
    write_animation(motion, DESIGN, Plane(), path, title="Straight <path>")
    page = path.read_text(encoding="utf-8")
    code = re.sub(r"const frames = .*", "", page)
    assert EXTERNAL.findall(code) == []
    assert "default-src 'none'" in code
    assert "<title>Straight &lt;path&gt;</title>" in code
    frames = [base64.b64decode(text) for text in constant(page, "frames")]
    pictures = [np.asarray(Image.open(io.BytesIO(frame)).convert("RGB")) for frame in frames]
    assert len(pictures) == len(motion.times)
    assert all(np.abs(a.astype(int) - b).max() > 60 for a, b in zip(pictures[1:], pictures[:-1], strict=True))
    assert constant(page, "times") == pytest.approx(motion.times, abs=1e-4)
    assert constant(page, "speeds") == pytest.approx([75.0] * 4)
    assert constant(page, "ways")[-1] == pytest.approx(0.3)


def test_negative_control_an_address_in_the_page_is_noticed() -> None:
    for line in ('<script src="player.js">', "@import url(style.css)", "fetch('https://a.b/c')", '<a href="x.html">'):
        assert EXTERNAL.search(line), line


def test_a_motion_of_another_vehicle_is_refused(tmp_path: Path) -> None:
    other = replace(DESIGN, legs=DESIGN.legs[:4])
    with pytest.raises(InputError, match=r"22 bodies at 4 times.*16 bodies"):
        write_animation(rolling(), other, Plane(), tmp_path / "rover.html")


def constant(page: str, name: str) -> list[str] | list[float]:
    """A list written into the page's script."""
    found = re.search(rf"\b{name} = (\[.*?\])", page)
    assert found
    values: list[str] | list[float] = json.loads(found[1])
    return values
