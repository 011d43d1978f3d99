"""``workbench roll`` as a user runs it: a drop with its series and account, the same again, and bad input."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.series import read_series
from tests.end_to_end.small_study import run, said, small_study_text


def coarse_study(folder: Path) -> Path:
    head, _, rest = small_study_text().partition("[ancf_wheel]")
    rest = rest.replace('"16 mm"', '"40 mm"', 1).replace('"18 mm"', '"40 mm"', 1)
    path = folder / "study.toml"
    path.write_text(f"{head}[ancf_wheel]{rest}", encoding="utf-8")
    return path


def test_a_drop_falls_freely_and_keeps_account(tmp_path: Path) -> None:
    study = coarse_study(tmp_path)
    asked = ("roll", study, "--case", "drop", "--height", "0.5 mm", "--load", "60", "--seconds", "0.03")
    ended = run(*asked, "--out", tmp_path / "o", "--store", tmp_path / "s")
    assert ended.returncode == 0, ended.stderr
    for text in ("dropped by 0.5 mm", "largest load", "account of energy is open by", "1 tasks computed, 0 reused"):
        assert text in ended.stdout
    series = read_series(tmp_path / "o" / "series" / "roll_drop.csv", "drop", "ancf_wheel")
    falls = series.time < 0.016  # 0.5 mm take 16.4 ms on Mars
    way = series["hub_z_m"][0] - series["hub_z_m"]
    np.testing.assert_allclose(way[falls], 0.5 * 3.711 * series.time[falls] ** 2, atol=1e-8)
    assert not series["load_z_N"][falls].any()
    assert series["load_z_N"].max() > 1.0
    change = max(np.ptp(series[f"{part}_J"]) for part in ("kinetic", "strain", "weight", "contact", "damping"))
    assert np.ptp(series["account_J"]) < 0.01 * change
    again = run(*asked, "--out", tmp_path / "o2", "--store", tmp_path / "s")
    assert "0 tasks computed, 1 reused" in again.stdout
    one, two = ((tmp_path / o / "series" / "roll_drop.csv").read_bytes() for o in ("o", "o2"))
    assert one == two


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (("--case", "jump"), "give rolling, drop, half_round"),
        (("--case", "drop", "--radius", "5 mm"), "is of no use to --case drop"),
        (("--height", "5 kg", "--case", "drop"), "height"),
        (("--seconds", "-1"), "must lie between"),
        (("--load", "nan"), "must lie between"),
        (("no_such_study.toml",), "no_such_study.toml"),
    ],
)
def test_bad_input_is_one_message(options: tuple[str, ...], text: str, tmp_path: Path) -> None:
    ended = said("roll", *options, "--out", tmp_path / "o", "--store", tmp_path / "s")
    assert ended.returncode == 2
    assert text in ended.stderr
    assert ended.stderr.count("\n") == 1
