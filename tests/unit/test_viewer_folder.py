"""What the viewer finds in a folder, and what it says of folders it cannot use."""

from __future__ import annotations

from pathlib import Path

import pytest

from contracts.errors import InputError
from tests.small_report_folder import write_small_report
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


def test_folders_without_results_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="holds no results; give the folder"):
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
