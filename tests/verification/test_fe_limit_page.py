"""The page docs/how_to/limit_load.md: its code runs as it stands and gives what the page says and shows."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

PAGE = Path(__file__).parents[2] / "docs" / "how_to" / "limit_load.md"


@pytest.mark.long
def test_the_page_runs_and_says_what_comes_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The message as printed; the path over the whole table; the arch leaves the plane; the figure is drawn."""
    text = PAGE.read_text(encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    found: dict[str, Any] = {}
    exec("\n".join(re.findall(r"```python\n(.*?)```", text, re.DOTALL)), found)
    (printed,) = re.findall(r"```text\n(.*?); \.\.\.\n```", text, re.DOTALL)
    assert found["told"].startswith(printed.replace("\n", " "))
    assert found["reached"] == found["targets"]
    path = found["path"]
    assert path[-1, 0] == 1.0
    assert 30.0 * found["moved"].control == pytest.approx(path[: int(np.argmin(path[:, 0])), 1].max(), rel=5e-3)
    assert "pressed it with up to 5.07 N on this path" in found["end"]
    assert found["height"].max() > 8e-3 > 6e-3 > found["height"][-1]
    assert (tmp_path / "limit_load.png").stat().st_size > 10_000
