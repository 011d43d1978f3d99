"""``workbench stiffness --travel``: the hub moved over the ground from a load, and the files it leaves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.hub_travel import Way
from contracts.travel_curve import WRENCH, read_travel
from tests.end_to_end.small_study import run, tiny_study

LOAD = 40.0


WHERE = ("--orientation", "15", "--load", f"{LOAD:g}", "--out", "o", "--store", "s")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A tiny study, its hub turned, and moved a little every way."""
    folder = tmp_path_factory.mktemp("travel")
    (folder / "study.toml").write_text(tiny_study(), encoding="utf-8")
    ended = run("stiffness", "study.toml", "--travel", "turning", *WHERE, folder=folder)
    assert ended.returncode == 0, ended.stderr
    assert "what resists the hub" in ended.stdout
    assert "N m/rad" in ended.stdout
    ended = run("stiffness", "study.toml", "--matrix", *WHERE, folder=folder)
    assert ended.returncode == 0, ended.stderr
    assert "K differs from its transpose by" in ended.stdout
    return folder


def test_a_turn_has_its_file_and_is_resisted(folder: Path) -> None:
    found = read_travel(folder / "o" / "travels" / "fe_turning_phi015.csv", "fe", Way.TURNING, 15.0)
    assert found.columns["load_N"][0] == pytest.approx(LOAD, rel=0.3)  # friction adds to what the curve bears
    assert (found.resistance[1:] > 0.0).all()


def test_the_standing_wheel_is_a_spring_of_six_ways(folder: Path) -> None:
    """Its matrix is its own transpose but for what slides and the moment it stands under; a sign mistaken is seen.

    It is positive, but it may roll to an orientation that stores less. The wheel is the same on its left and right, so
    that three of its ways do not stir the other three.
    """
    lines = (folder / "o" / "matrices" / "fe_phi015.csv").read_text(encoding="utf-8").splitlines()
    K = np.loadtxt(lines[2:], delimiter=",")
    scale = np.diag([1.0, 1.0, 1.0, 10.0, 10.0, 10.0])  # turns at 0.1 m
    K = scale @ K @ scale
    assert (np.linalg.eigvalsh(0.5 * (K + K.T))[1:] > 0.0).all()
    assert np.abs(K - K.T).max() < 0.02 * np.abs(K).max()
    middle, beside = [0, 2, 4], [1, 3, 5]
    assert np.abs(K[np.ix_(middle, beside)]).max() < 1e-3 * np.abs(K).max()
    assert np.abs(K[0, 4]) > 0.05 * np.abs(K).max()


def test_the_same_again_is_reused(folder: Path) -> None:
    ended = run("stiffness", "study.toml", "--travel", "turning", *WHERE, folder=folder)
    assert (ended.returncode, "0 tasks computed" in ended.stdout) == (0, True), ended.stderr


def test_six_components_stand_in_every_curve(folder: Path) -> None:
    """And of a mirrored half only what the whole has; of the curve, which is there, the footprint alone is new."""
    ended = run("stiffness", "study.toml", "--orientation", "15", "--out", "c", "--store", "s", folder=folder)
    assert (ended.returncode, "1 tasks computed, 2 reused" in ended.stdout) == (0, True), ended.stderr
    head = (folder / "c" / "curves" / "fe_phi015.csv").read_text().splitlines()[1].split(",")
    assert set(WRENCH) <= set(head)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--travel", "up"], "'up': is not known; give fore_aft, lateral, turning, radial, leaning, wind_up or all"),
        (["--travel", "lateral", "--model", "brush"], "has no hub that could be moved"),
        (["--travel", "lateral", "--load", "0"], "load = 0 N: must lie between 0.1 N and fe.max_load, 300 N"),
        (["--travel", "lateral", "--load", "inf"], "load = inf N: must lie between"),
        (
            ["--travel", "lateral", "--load", "290", "--orientation", "15"],
            "lies outside the curve without friction, which",
        ),
        (["--matrix", "--load", "290", "--orientation", "15"], "turning_small_phi015"),
        (["--load", "50"], "load = 50 N: is where the hub's travel begins; give --travel or --matrix"),
    ],
)
def test_bad_input_ends_with_one_message(folder: Path, arguments: list[str], message: str) -> None:
    ended = run("stiffness", "study.toml", *arguments, "--store", "s", "--out", "bad", folder=folder)
    assert ended.returncode == 2
    assert message in " ".join(ended.stderr.split())
    assert "Traceback" not in ended.stderr
