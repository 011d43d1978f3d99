"""What the viewer finds in a folder, and what it says of folders it cannot use."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from contracts.errors import InputError
from tests.small_report_folder import write_small_report
from workbench.viewer.curve_groups import curve_choices
from workbench.viewer.folder import read_folder, spoken


def test_everything_is_found(tmp_path: Path) -> None:
    write_small_report(tmp_path)
    found = read_folder(tmp_path)
    assert (found.study, found.status) == ("small", "pass")
    assert [(one.orientation, one.load) for one in found.fields] == [(0, 100), (0, 200), (30, 100), (30, 200)]
    assert list(found.points) == [("fe", 0.0)]
    assert set(found.curves) == {"fe_phi000", "fe_phi030", "fe_average"}
    assert set(found.series) == set(found.motions) == {("straight", "brush")}
    assert found.parts_of("fe", 30.0) == ("hub", "tire")
    assert found.parts_of("fe", 45.0) == ()


@pytest.mark.parametrize(
    ("name", "text"),
    [("fe_phi015", "FE 15°"), ("ancf_four_spokes_phi060", "ANCF four spokes 60°"), ("brush_average", "brush average")],
)
def test_names_are_spoken(name: str, text: str) -> None:
    assert spoken(name) == text


def test_curves_are_grouped_by_model_and_variants_of_it() -> None:
    names = ["section_phi000", "ancf_wheel_phi000", "ancf_wheel_phi015", "ancf_wheel_average", "words_band_average"]
    names += ["fe_phi015", "fe_phi000", "fe_average", "fe_penalty_0.1_phi015", "ancf_phi000", "<b>"]
    found = [(one["group"], one["value"]) for one in curve_choices(names)]
    assert found == [
        ("FE", "fe_average"),
        ("FE", "fe_penalty_0.1_phi015"),
        ("FE", "fe_phi000"),
        ("FE", "fe_phi015"),
        ("ANCF", "ancf_phi000"),
        ("ANCF wheel", "ancf_wheel_average"),
        ("ANCF wheel", "ancf_wheel_phi000"),
        ("ANCF wheel", "ancf_wheel_phi015"),
        ("section", "section_phi000"),
        ("others", "words_band_average"),
        ("others", "<b>"),
    ]
    assert {one["value"]: one["text"] for one in curve_choices(names)}["fe_phi015"] == "FE 15°"


def test_folders_without_results_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="holds no fields, curves, series, motions or modes to show; give the folder"):
        read_folder(tmp_path)
    with pytest.raises(InputError, match="does not exist"):
        read_folder(tmp_path / "nowhere")
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(InputError, match="is not a folder"):
        read_folder(tmp_path / "file")


def test_a_damaged_summary_or_curve_is_named(tmp_path: Path) -> None:
    write_small_report(tmp_path)
    (tmp_path / "summary.json").write_text("{", encoding="utf-8")
    with pytest.raises(InputError, match=r"summary = .*summary\.json: cannot be read"):
        read_folder(tmp_path)
    (tmp_path / "summary.json").unlink()
    (tmp_path / "curves" / "fe_phi000.csv").write_text("a,b\n1,x\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"fe_phi000\.csv"):
        read_folder(tmp_path)


HOSTILE = ("two\nlines", "\x1b[31mred", "\udcff\udcfe", "\u202egnp", "<b>bold", "' \" {{ x }}", "long" * 60)


def test_names_are_plain_and_told_apart(tmp_path: Path) -> None:
    write_small_report(tmp_path)
    text = (tmp_path / "curves" / "fe_phi000.csv").read_text(encoding="utf-8")
    for name in (*HOSTILE, "two\\nlines"):  # the last is written as the first is shown
        (tmp_path / "curves" / f"{name}.csv").write_text(text, encoding="utf-8")
    (tmp_path / "fields" / "fe_phi000_100N.vtu").rename(tmp_path / "fields" / "a\n\udcff_phi045_100N.vtu")
    (tmp_path / "motions" / "straight_brush.npz").rename(tmp_path / "motions" / "st\nraight_brush.npz")
    (tmp_path / "summary.json").write_text('{"study": "\\ud800\\n", "status": "\\u001b"}', encoding="utf-8")
    found = read_folder(tmp_path)
    assert len(found.curves) == 3 + len(HOSTILE) + 1
    assert {"two\\nlines", "two\\nlines (2)", "\\x1b[31mred", "\\udcff\\udcfe", "\\u202egnp"} <= set(found.curves)
    models = {one.model for one in found.fields}
    assert models == {"fe", "a\\n\\udcff"}
    assert set(found.motions) == {("st\\nraight", "brush")}
    assert (found.study, found.status) == ("\\ud800\\n", "\\x1b")
    for name in (*found.curves, *models, found.study):
        assert name.isprintable()
        assert name.encode("utf-8")
    assert found.left_out == ()


def test_links_out_of_the_folder_are_not_followed(tmp_path: Path) -> None:
    outside, path = tmp_path / "outside", tmp_path / "report"
    outside.mkdir()
    path.mkdir()
    write_small_report(path)
    curve = (path / "curves" / "fe_phi000.csv").read_text(encoding="utf-8")
    (outside / "secret.csv").write_text(curve, encoding="utf-8")
    (path / "curves" / "out.csv").symlink_to(outside / "secret.csv")
    (path / "curves" / "up.csv").symlink_to(Path("..") / ".." / "outside" / "secret.csv")
    (path / "curves" / "round.csv").symlink_to("round.csv")
    (path / "curves" / "nowhere.csv").symlink_to("missing")
    (path / "curves" / "folder.csv").mkdir()
    os.mkfifo(path / "curves" / "pipe.csv")
    (path / "curves" / "within.csv").symlink_to("fe_phi000.csv")
    (path / "series").rename(outside / "series")
    (path / "series").symlink_to(outside / "series")
    (path / "summary.json").rename(outside / "summary.json")
    (path / "summary.json").symlink_to(outside / "summary.json")
    (tmp_path / "link").symlink_to(path)  # the folder itself may be reached by one
    found = read_folder(tmp_path / "link")
    assert "within" in found.curves
    assert set(found.curves) == {"fe_phi000", "fe_phi030", "fe_average", "within"}
    assert (found.study, dict(found.series)) == ("", {})
    left = ("folder.csv", "nowhere.csv", "out.csv", "pipe.csv", "round.csv", "up.csv")
    assert set(found.left_out) == {*(f"curves/{name}" for name in left), "series/straight_brush.csv", "summary.json"}
