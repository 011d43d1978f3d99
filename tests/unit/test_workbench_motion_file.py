"""Recorded motions: what is written is read again, to single precision; a damaged file is one clear message."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from contracts.errors import InputError
from tests.small_report_folder import rolling_run
from tests.unit.test_workbench_tire_animation import flexible
from workbench.questions.rover.motion_file import read_motion, write_motion
from workbench.study.ancf_tire import drawn_tire, tire_values
from workbench.viewer.stages import RoverStage


def test_a_motion_comes_back(tmp_path: Path) -> None:
    run = rolling_run()
    write_motion(run, tmp_path / "motions" / "m.npz")
    found = read_motion(tmp_path / "motions" / "m.npz")
    assert found.title == run.scenario.title
    np.testing.assert_allclose(found.times, run.motion.times)
    np.testing.assert_allclose(found.positions, run.motion.positions, atol=1e-6)
    np.testing.assert_allclose(found.rotations, run.motion.rotations, atol=1e-6)
    np.testing.assert_allclose(found.up, [0.0, 0.0, 1.0])
    assert found.vectors.shape[1] == 0
    assert {solid.body for solid in found.solids} == {-1, *range(found.positions.shape[1])}


def test_a_long_motion_keeps_its_ends_and_no_more_than_181_times(tmp_path: Path) -> None:
    run = rolling_run(frames=1000)
    write_motion(run, tmp_path / "m.npz")
    found = read_motion(tmp_path / "m.npz")
    assert len(found.times) == 181
    assert found.times[[0, -1]].tolist() == [0.0, 4.0]
    assert (tmp_path / "m.npz").stat().st_size < 200_000


def test_a_replayed_motion_moves_as_the_recorded_one(tmp_path: Path) -> None:
    run = rolling_run(frames=100)
    write_motion(run, tmp_path / "m.npz")
    found = read_motion(tmp_path / "m.npz").replayed()
    np.testing.assert_allclose(found.positions, run.motion.positions, atol=1e-6)
    way = np.trapezoid(found.velocities[:, 0, :3], found.times, axis=0)
    np.testing.assert_allclose(way, found.positions[-1, 0] - found.positions[0, 0], atol=1e-5)


def test_a_slope_is_seen_by_what_is_up(tmp_path: Path) -> None:
    run = rolling_run()
    tilt = type(run.scenario.tilt)(angle=0.3, heading=0.0)
    write_motion(replace(run, scenario=replace(run.scenario, tilt=tilt)), tmp_path / "m.npz")
    np.testing.assert_allclose(read_motion(tmp_path / "m.npz").up, [-np.sin(0.3), 0.0, np.cos(0.3)], atol=1e-12)


def test_a_motion_on_ancf_tires_brings_its_tire(tmp_path: Path) -> None:
    """Its hubs are solid, its tire is drawn as it was driven; vectors of another tire are refused."""
    tire = build_tire(replace(thesis_preset(), hub_radius=0.03, young_modulus=1e6))
    run = replace(rolling_run(), motion=flexible(0.8))
    write_motion(run, tmp_path / "m.npz", tire_values(tire.preset, tire.mesh))
    found = read_motion(tmp_path / "m.npz")
    assert found.tire is not None
    drawn = drawn_tire(found.tire, found.vectors.shape[2])
    assert (drawn.preset.hub_radius, drawn.preset.young_modulus) == (0.03, 1e6)
    np.testing.assert_array_equal(drawn.mesh.points, tire.mesh.points)
    whole = RoverStage(tmp_path / "m.npz").tires
    assert whole is not None
    assert len(whole.surfaces) == 6
    with pytest.raises(InputError, match="must have the motion's 7"):
        drawn_tire(found.tire, 7)
    for broken in ({}, {"preset": {"spokes": 4}}, found.tire | {"plates": found.tire["plates"] | {"elements": [[99]]}}):
        with pytest.raises(InputError, match="tire of the motion file = its numbers: cannot be read"):
            drawn_tire(broken, found.vectors.shape[2])
    write_motion(run, tmp_path / "m.npz")  # as before motions held their tire
    with pytest.raises(InputError, match="vectors of 6 ANCF tires, and no tire"):
        read_motion(tmp_path / "m.npz")


@pytest.mark.parametrize("damage", ["cut", "text", "bodies"])
def test_a_damaged_file_is_refused(tmp_path: Path, damage: str) -> None:
    path = tmp_path / "m.npz"
    write_motion(rolling_run(), path)
    if damage == "cut":
        path.write_bytes(path.read_bytes()[:2000])
    elif damage == "text":
        path.write_text("no archive", encoding="utf-8")
    else:
        with np.load(path) as archive:
            arrays = dict(archive)
        arrays["bodies"] = arrays["bodies"] + 30
        np.savez(path, **arrays)
    with pytest.raises(InputError, match=r"motion file = .*cannot be read"):
        read_motion(path)
