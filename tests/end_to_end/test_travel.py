"""``workbench stiffness --travel``: the hub moved over the ground from a load, and the files it leaves."""

from __future__ import annotations

from pathlib import Path

import pytest

from contracts.hub_travel import Way
from contracts.travel_curve import WRENCH, read_travel
from tests.end_to_end.small_study import run, tiny_study

LOAD = 40.0


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A tiny study, solved every way."""
    folder = tmp_path_factory.mktemp("travel")
    (folder / "study.toml").write_text(tiny_study(), encoding="utf-8")
    where = ("--orientation", "15", "--load", f"{LOAD:g}", "--out", "o", "--store", "s")
    ended = run("stiffness", "study.toml", "--travel", "all", *where, folder=folder)
    assert ended.returncode == 0, ended.stderr
    assert "what resists the hub" in ended.stdout
    assert "N m/rad" in ended.stdout
    return folder


@pytest.mark.parametrize("way", list(Way))
def test_every_way_has_its_file_and_resists(folder: Path, way: Way) -> None:
    found = read_travel(folder / "o" / "travels" / f"fe_{way}_phi015.csv", "fe", way, 15.0)
    assert found.columns["load_N"][0] == pytest.approx(LOAD, rel=0.3)  # friction adds to what the curve bears
    assert (found.resistance[1:] > 0.0).all()
    assert found.stiffness > 0.0


def test_the_same_again_is_reused(folder: Path) -> None:
    where = ("--orientation", "15", "--load", f"{LOAD:g}", "--out", "o", "--store", "s")
    ended = run("stiffness", "study.toml", "--travel", "lateral", *where, folder=folder)
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
        (["--travel", "up"], "'up': is not known; give fore_aft, lateral, turning, wind_up or all"),
        (["--travel", "lateral", "--model", "brush"], "has no hub that could be moved"),
        (["--travel", "lateral", "--load", "0"], "load = 0 N: must lie between 0.1 N and fe.max_load, 300 N"),
        (["--travel", "lateral", "--load", "inf"], "load = inf N: must lie between"),
        (["--travel", "lateral", "--load", "290", "--orientation", "15"], "lies outside the curve"),
        (["--load", "50"], "load = 50 N: is where the hub's travel begins; give --travel, or leave it out"),
    ],
)
def test_bad_input_ends_with_one_message(folder: Path, arguments: list[str], message: str) -> None:
    ended = run("stiffness", "study.toml", *arguments, "--store", "s", "--out", "bad", folder=folder)
    assert ended.returncode == 2
    assert message in " ".join(ended.stderr.split())
    assert "Traceback" not in ended.stderr
