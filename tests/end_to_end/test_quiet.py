"""The terminal holds our own lines alone: no warning and no log of a library, whatever the input.

Claim: commands on input that makes NumPy, matplotlib and VTK complain end with nothing on stderr, or with our one
message. Source: README.md, exit status. Negative control: with WORKBENCH_TRACEBACK set, for those who mend the
workbench, the same command shows the library's warning.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.end_to_end.small_study import command, environment

CURVE = "deflection_m,load_N\n0,0\n0.003,24\n0.006,48\n"
BAD_FIELDS = """<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="8" NumberOfCells="1"><Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">
0 0 0</DataArray></Points></Piece></UnstructuredGrid></VTKFile>"""
READ_FIELDS = """
from pathlib import Path
from workbench.execution.standard_streams import quieten
quieten()
from workbench.viewer.wheel_file import read_fields
try:
    read_fields(Path("bad.vtu"))
except ValueError as error:
    print(error)
"""


def _run(folder: Path, *arguments: str, **more: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        command(*arguments),
        cwd=folder,
        env=environment() | more,
        capture_output=True,
        text=True,
        check=False,
    )


def _compared(folder: Path, **more: str) -> subprocess.CompletedProcess[str]:
    """Two curves under a name that the pictures' font has no letters for."""
    for name in ("\u8f6e\u5b50.csv", "b.csv"):
        (folder / name).write_text(CURVE, encoding="utf-8")
    return _run(folder, "compare", "\u8f6e\u5b50.csv", "b.csv", "--out", "out", **more)


def test_letters_that_a_font_lacks(tmp_path: Path) -> None:
    run = _compared(tmp_path)
    assert (run.returncode, run.stderr) == (0, "")
    assert "\u8f6e\u5b50.csv against b.csv" in run.stdout


def test_who_mends_the_workbench_sees_warnings(tmp_path: Path) -> None:
    run = _compared(tmp_path, WORKBENCH_TRACEBACK="1")
    assert run.returncode == 0
    assert "Warning: Glyph" in run.stderr


def test_heights_beyond_all_numbers(tmp_path: Path) -> None:
    heights = np.zeros((400, 80))
    heights[::2], heights[1::2] = 1e308, -1e308
    np.savez(tmp_path / "t.npz", heights=heights, spacing=np.array([0.1, 0.1]), origin=np.array([-5.0, -4.0]))
    run = _run(tmp_path, "rover", "straight", "--terrain", "t.npz", "--tire", "rigid", "--out", "out")
    assert run.returncode == 2
    (line,) = run.stderr.splitlines()
    assert line.startswith("workbench: error: ")


def test_fields_that_vtk_cannot_read(tmp_path: Path) -> None:
    (tmp_path / "bad.vtu").write_text(BAD_FIELDS, encoding="utf-8")
    run = subprocess.run(
        [sys.executable, "-c", READ_FIELDS],
        cwd=tmp_path,
        env=environment(),
        capture_output=True,
        text=True,
        check=True,
    )
    assert run.stderr == ""
    assert "field file = bad.vtu: cannot be read" in run.stdout


@pytest.mark.parametrize("arguments", [("--help",), ("rover", "--list")])
def test_good_input_leaves_stderr_empty(arguments: tuple[str, ...], tmp_path: Path) -> None:
    run = _run(tmp_path, *arguments)
    assert (run.returncode, run.stderr) == (0, "")


def test_a_terminal_without_our_letters_gets_escapes(tmp_path: Path) -> None:
    run = _run(tmp_path, "compare", "\u8f6e.csv", "b.csv", PYTHONIOENCODING="ascii")
    assert run.returncode == 2
    assert r"curve file = \u8f6e.csv" in run.stderr
    (tmp_path / "\u8f6e.csv").write_text(CURVE, encoding="utf-8")
    run = _run(tmp_path, "compare", "\u8f6e.csv", "\u8f6e.csv", PYTHONIOENCODING="ascii")
    assert (run.returncode, run.stderr) == (0, "")
    assert r"\u8f6e.csv against" in run.stdout
