"""Folders from elsewhere: links that lead out of them are refused, and what is no table in JSON."""

from __future__ import annotations

from pathlib import Path

import pytest

from contracts.errors import InputError
from contracts.foreign_folder import read_json, require_inside
from tests.small_report_folder import write_small_report
from workbench.verdict.baseline import read_baseline
from workbench.viewer.folder import read_folder


def test_links_out_of_a_folder_are_refused(tmp_path: Path) -> None:
    folder = tmp_path / "report"
    folder.mkdir()
    (folder / "own").write_text("{}", encoding="utf-8")
    (tmp_path / "other").write_text("{}", encoding="utf-8")
    (folder / "within").symlink_to("own")
    (folder / "out").symlink_to(tmp_path / "other")
    (folder / "loop").symlink_to("loop")
    (tmp_path / "door").symlink_to(folder)
    for good in (folder / "own", folder / "within", tmp_path / "door" / "own"):
        require_inside(good, good.parent, "file")
        assert read_json(good, "file", "hint") == {}
    for bad in (folder / "out", folder / "loop", tmp_path / "door" / "out"):
        with pytest.raises(InputError, match="leads out of"):
            read_json(bad, "file", "hint")


@pytest.mark.parametrize("text", ["", "[]", "3", "{", 100_000 * "[", "\0", '{"a": ' + 5000 * "9" + "}"])
def test_what_is_no_table_is_refused(text: str, tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="JSON"):
        read_json(tmp_path / "a.json", "file", "hint")


@pytest.mark.parametrize(
    "name", ["curves/fe_phi000.csv", "fields/fe_phi000_900N.vtu", "motions/a_brush.npz", "summary.json"]
)
def test_a_report_s_folder_shows_no_file_of_another(name: str, tmp_path: Path) -> None:
    write_small_report(tmp_path / "report")
    (tmp_path / "secret").write_text("nobody:x:0", encoding="utf-8")
    path = tmp_path / "report" / name
    path.parent.mkdir(exist_ok=True)
    path.unlink(missing_ok=True)
    path.symlink_to(tmp_path / "secret")
    found = read_folder(tmp_path / "report")
    assert found.left_out == (name,)
    assert "nobody" not in repr(found)


@pytest.mark.parametrize("value", ['"a"', "[1]", "{}", "true"])
def test_a_baseline_of_other_types_is_refused(value: str, tmp_path: Path) -> None:
    row = '{"id": "a", "title": "a", "quantity": "a", "unit": "a", "value": %s, "reference": 1, "tolerance": "5 %%",'
    text = '{"study": "s", "provenance": {}, "checks": [' + row % value + ' "status": "pass", "role": "gate"}]}'
    (tmp_path / "summary.json").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="no summary of a report"):
        read_baseline(tmp_path, "s")
    (tmp_path / "summary.json").write_text(text.replace(f'"value": {value}', '"value": 2.0'), encoding="utf-8")
    assert read_baseline(tmp_path, "s").checks["a"].value == 2.0
