"""The rover on a wheel whose mesh comes from another program, by the curves of one of the sectors it repeats by.

Claim: at rest every wheel is on the curve of the orientation it stands on, and the six carry the rover.
Negative control: a number of sectors that the mesh does not have, and a wheel of another size, end with one message.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.curves import read_curve
from contracts.series import read_series
from rover_dynamics.rover.rover_file import EXOMARS_ROVER
from tests.end_to_end.small_study import ROOT, run, said
from tests.ring_wheel import AROUND, ring_deck

LOAD = 197.92
"""A sixth of 320 kg on Mars [N]."""
STUDY = f"""
name = "disc"
title = "A disc of rubber"
[mesh]
file = "disc.inp"
units = "mm"
repeats = {AROUND}
hub = ["bore"]
ground = ["tread"]
[mesh.parts]
hub = {{ material = "rubber" }}
rim = {{ material = "rubber" }}
[materials.rubber]
young_modulus = "5 MPa"
poisson_ratio = 0.4
density = "1100 kg/m^3"
yield_strength = "2 MPa"
source = "made up"
[fe]
orientations = ["0 deg"]
max_deflection = "3 mm"
points = 6
max_load = "400 N"
[full]
orientation_step = "7.5 deg"
[brush]
radial_stiffness = "8250 N/m"
radial_damping = "8140 N*s/m"
longitudinal_slip_stiffness = "8250 N"
cornering_stiffness_per_degree = "850 N"
friction_min = 0.597
friction_max = 0.757
rolling_resistance = 0.015
source = "Samarini 2020, Table II"
"""


@pytest.mark.long
def test_at_rest_every_wheel_is_on_its_curve(tmp_path: Path) -> None:
    """The rover's own wheels are those of the disc; the brake holds position 0 down."""
    (tmp_path / "disc.inp").write_text(ring_deck(20))
    (tmp_path / "disc.toml").write_text(STUDY)
    rover, text = tmp_path / "rover.toml", EXOMARS_ROVER.read_text(encoding="utf-8")
    assert text.count("\nradius = 0.1425 ") == 1
    rover.write_text(text.replace("\nradius = 0.1425 ", "\nradius = 0.1 "), encoding="utf-8")
    where = ("--out", "o", "--store", "s")
    asked = ("rover", "straight", "--study", "disc.toml", "--tire", "fe")
    ended = run(*asked, "--rover", rover, *where, folder=tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert "11 tasks computed" in ended.stdout or "10 tasks computed, 1 reused" in ended.stdout
    series = read_series(tmp_path / "o" / "series" / "straight_fe.csv", "straight", "fe")
    again = run("stiffness", "disc.toml", "--orientation", "0", *where, folder=tmp_path)
    assert again.returncode == 0, again.stderr
    curve = read_curve(tmp_path / "o" / "curves" / "fe_phi000.csv", "fe", 0.0)
    for wheel in ("front_left", "center_right", "rear_left"):
        deflection, load = series[f"{wheel}_deflection_m"][0], series[f"{wheel}_load_N"][0]
        assert deflection > 0.5e-3
        assert load == pytest.approx(curve.load_at(deflection), rel=0.01)
    loads = np.array([series[f"{wheel}_load_N"] for wheel in ("front_left", "center_left", "rear_left")])
    assert loads.sum(axis=0).mean() == pytest.approx(3.0 * LOAD, rel=2e-3)
    ended = run(*asked, *where, folder=tmp_path)
    assert ended.returncode == 2
    told = " ".join(ended.stderr.split())
    assert "radius of the wheel's own mesh = 100 mm: is not that of the rover's wheels, 142.5 mm" in told


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("repeats = 10", "repeats = 7", "mesh.repeats: equal sectors = 7: are not what part spokes has: turned by"),
        ("[fe]", "[rover]\n[fe]", "radius of the wheel's own mesh = 125 mm: is not that of the rover's wheels"),
    ],
)
def test_a_wrong_wheel_is_one_message_and_status_2(tmp_path: Path, old: str, new: str, words: str) -> None:
    text = (ROOT / "studies/spiral.toml").read_text(encoding="utf-8")
    assert text.count(old) == 1
    mesh = f'file = "{(ROOT / "studies/spiral.inp").as_posix()}"'
    (tmp_path / "mine.toml").write_text(text.replace(old, new).replace('file = "spiral.inp"', mesh), encoding="utf-8")
    done = said("check", tmp_path / "mine.toml")
    assert done.returncode == 2
    assert len([line for line in done.stderr.splitlines() if "workbench: error:" in line]) == 1
    assert words in " ".join(done.stderr.split())
