"""The notebook docs/fe_wheel.ipynb runs as it stands, here on a far coarser mesh; what it shows is kept in it.

Claim: who opens the notebook sees its tables and pictures, and who runs it gets such ones. Negative control: a cell
that fails is raised.
"""

from __future__ import annotations

import base64
import json
import re
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.end_to_end.small_study import tiny_study

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs" / "hooks"))

import notebook as hooks  # type: ignore[import-not-found]  # noqa: E402

PATH = ROOT / "docs" / "fe_wheel.ipynb"


def shown(notebook: dict[str, Any]) -> list[list[str]]:
    """Kinds of output of each code cell."""
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    return [[kind for one in cell["outputs"] for kind in one.get("data", {"stream": ""})] for cell in cells]


def test_the_notebook_runs_and_shows_what_is_kept_in_it(tmp_path: Path) -> None:
    (tmp_path / "docs").mkdir()
    (tmp_path / "studies").mkdir()
    (tmp_path / "studies" / "first.toml").write_text(tiny_study(), encoding="utf-8")
    kept = json.loads(PATH.read_text(encoding="utf-8"))
    bare = {**kept, "cells": [cell | {"outputs": []} if "outputs" in cell else cell for cell in kept["cells"]]}
    done = hooks.run(bare, tmp_path / "docs")
    assert shown(done) == shown(kept)
    assert ["stream", "image/png"] in shown(done)
    pictures = [one["data"]["image/png"] for cell in done["cells"] for one in cell.get("outputs", ())
                if "image/png" in one.get("data", {})]  # fmt: skip
    assert [base64.b64decode(picture)[:4] for picture in pictures] == [b"\x89PNG", b"\x89PNG"]


def test_what_is_kept_is_small_and_names_no_machine() -> None:
    text = PATH.read_text(encoding="utf-8")
    assert len(text) < 300_000
    assert not re.search(r"/(home|root|tmp|work|Users)/", text)
    assert json.loads(text)["nbformat"] == 4


def test_negative_control_a_cell_that_fails_is_raised(tmp_path: Path) -> None:
    cell = {"cell_type": "code", "source": ["x = 1\n", "1 / (x - 1)"], "outputs": []}
    with pytest.raises(ZeroDivisionError):
        hooks.run({"cells": [cell]}, tmp_path)
