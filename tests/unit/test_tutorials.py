"""The tutorials' code blocks run, one after the other, and print what their text says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

TUTORIALS = Path(__file__).parents[2] / "docs" / "tutorials"


def run_blocks(name: str, capsys: pytest.CaptureFixture[str]) -> str:
    """What the blocks of a tutorial print, run in order in the present folder."""
    text, names = (TUTORIALS / name).read_text(encoding="utf-8"), dict[str, object]()
    for block in re.findall(r"```python\n(.*?)```", text, flags=re.S):
        exec(compile(block, name, "exec"), names)
    return capsys.readouterr().out


def test_every_tutorial_is_run_here() -> None:
    with_code = [path for path in TUTORIALS.glob("*.md") if "```python\n" in path.read_text(encoding="utf-8")]
    assert sorted(path.name for path in with_code) == ["ancf_tire.md", "ancf_wheel.md", "multibody.md", "rover.md"]


def test_ancf_tire(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """It carries load, lands on the rock with its energy accounted for, and its surfaces are written."""
    monkeypatch.chdir(tmp_path)
    printed = run_blocks("ancf_tire.md", capsys)
    print(printed)
    loads = [float(value) for value in re.findall(r"([\d.]+) N at 20 mm", printed)]
    assert len(loads) == 2
    assert min(loads) > 20.0
    assert float(re.findall(r"open by ([\d.]+) %", printed)[0]) < 1.0
    assert (tmp_path / "leaning_tire_20mm.step").stat().st_size > 1000


def test_ancf_wheel(capsys: pytest.CaptureFixture[str]) -> None:
    """The shipped hoops carry 18 and 37 N, stand, and their lowest node goes up by what the hub drops, nearly."""
    printed = run_blocks("ancf_wheel.md", capsys)
    print(printed)
    rows = [[float(v) for v in re.findall(r"-?[\d.]+", line)] for line in printed.splitlines()]
    assert [(d, negative) for d, _, negative, _ in rows] == [(2.0, 0.0), (4.0, 0.0)]
    assert rows[0][1] == pytest.approx(19.0, rel=0.1)
    assert rows[1][1] == pytest.approx(37.0, rel=0.1)
    assert rows[1][3] - rows[0][3] == pytest.approx(2.0, abs=0.3)


def test_multibody(capsys: pytest.CaptureFixture[str]) -> None:
    """The piston's stroke is twice the crank; redundant equations are named; the crank hangs straight down."""
    printed = run_blocks("multibody.md", capsys)
    print(printed)
    low, high = (float(value) for value in re.findall(r"piston from ([\d.]+) to ([\d.]+) m", printed)[0])
    assert 0.2 <= low < 0.205
    assert 0.395 < high <= 0.4
    assert printed.count("left out:") == 3
    assert float(re.findall(r"crank (-[\d.]+) m", printed)[0]) == pytest.approx(-0.05, abs=1e-4)


def test_rover(capsys: pytest.CaptureFixture[str]) -> None:
    """It drives what its wheels roll, over rocks; at rest its loads are those of its lever; a short field is named.

    The first step ends on the block with all wheels: 60 mm higher.
    """
    printed = run_blocks("rover.md", capsys)
    print(printed)
    ahead, up = (float(value) for value in re.findall(r"([\d.]+) m ahead, (\d+) mm up", printed)[0])
    assert ahead == pytest.approx(0.7 * 0.1425 * 19.5, rel=0.05)
    assert up > 10.0
    loads = [float(value) for value in re.findall(r"wheel loads: \[(.*?)\]", printed)[0].split()]
    assert sum(loads) == pytest.approx(57.0 * 3.711, rel=0.01)
    front = (40.0 * 0.3 + 5.0 * 0.8 + 6.0 * 0.8) / (57.0 * 0.8)
    assert sum(loads[:2]) / sum(loads) == pytest.approx(front, abs=0.01)
    assert "must lie 0.1425 m inside the terrain, x -1..4 m" in printed
    assert float(re.findall(r"([\d.]+) m higher", printed)[0]) == pytest.approx(0.06, abs=1e-3)


def test_the_four_wheel_rover_takes_twenty_lines() -> None:
    """Statements, imports apart."""
    text = (TUTORIALS / "rover.md").read_text(encoding="utf-8")
    block = re.findall(r"```python\n(.*?)```", text, flags=re.S)[0]
    lines = [line for line in block.splitlines() if line and not line.startswith(("import", "from"))]
    assert len(lines) <= 20
