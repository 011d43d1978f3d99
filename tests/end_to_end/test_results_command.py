"""``workbench results``, and what a run says of a damaged result, as a user sees them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.end_to_end.small_study import run, small_study_text

LINE = ("stiffness", "study.toml", "--model", "brush", "--out", "out", "--store", "store")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a study and a store that holds its brush line."""
    (tmp_path / "study.toml").write_text(small_study_text(), encoding="utf-8")
    ended = run(*LINE, folder=tmp_path)
    assert ended.returncode == 0, ended.stderr
    return tmp_path


def _entry(folder: Path) -> Path:
    (manifest,) = (folder / "store").glob("??/*/manifest.json")
    return manifest.parent


def test_a_damaged_result_is_told_and_computed_again(folder: Path) -> None:
    curve = _entry(folder) / "curve.csv"
    whole = curve.read_bytes()
    curve.write_bytes(whole[:50])
    checked = run("results", "--check", "--store", "store", folder=folder)
    assert checked.returncode == 1
    assert f"damaged: curve.csv has 50 of {len(whole)} bytes" in checked.stdout
    again = run(*LINE, folder=folder)
    assert again.returncode == 0
    told = f"brush: its stored result is damaged (curve.csv has 50 of {len(whole)} bytes); computed again"
    assert told in again.stdout.splitlines()
    assert curve.read_bytes() == whole
    assert run("results", "--check", "--store", "store", folder=folder).returncode == 0


def test_list_show_and_prune(folder: Path) -> None:
    key = _entry(folder).name
    listed = run("results", "--store", "store", folder=folder)
    assert listed.returncode == 0
    header, line, total, *_ = listed.stdout.splitlines()
    assert header.split() == ["task", "study", "age", "size", "wall", "time", "key"]
    assert line.split()[:2] == ["brush", "study"]
    assert line.split()[-1] == key[:12]
    assert total.startswith("1 result,")
    shown = json.loads(run("results", "show", key[:12], "--store", "store", folder=folder).stdout)
    assert shown["key"] == key
    assert shown["state"] == "whole"
    assert shown["inputs"]["radial_stiffness"] == 8250.0
    assert set(shown["origin"]["libraries"]) == {"numpy"}
    assert set(shown["files"]) == {"curve.csv"}
    for options, count in ((("--older-than", "1 d"), "nothing"), (("--task", "fe_*"), "nothing")):
        assert run("results", "prune", *options, "--store", "store", folder=folder).stdout.startswith(count)
    dry = run("results", "prune", "--larger-than", "0 MB", "--dry-run", "--store", "store", folder=folder)
    assert f"would remove brush {key[:12]}" in dry.stdout
    assert _entry(folder).name == key
    pruned = run("results", "prune", "--task", "brush", "--store", "store", folder=folder)
    assert pruned.returncode == 0
    assert "1 result removed" in pruned.stdout
    assert list((folder / "store").glob("??/*")) == []


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("results", "--store", "nowhere"), "result store = nowhere: is not there"),
        (("results", "prune", "--store", "store"), "prune = no option: says nothing to remove by"),
        (("results", "prune", "--older-than", "30", "--store", "store"), "a duration in a string needs its unit"),
        (("results", "prune", "--larger-than", "2 m", "--store", "store"), "must be a size"),
        (("results", "prune", "--older-than", "-1 d", "--store", "store"), "must not be negative"),
        (("results", "show", "0123", "--store", "store"), "is the beginning of no key in the store"),
    ],
)
def test_bad_input_is_one_message(tmp_path: Path, arguments: tuple[str, ...], message: str) -> None:
    (tmp_path / "store" / "tmp").mkdir(parents=True)
    ended = run(*arguments, folder=tmp_path)
    assert ended.returncode == 2
    assert message in ended.stderr
    assert len(ended.stderr.splitlines()) == 1
    assert not (tmp_path / "nowhere").exists()
