"""Damaged and hostile files: always success or one clear message with exit status 2, never a traceback, never a hang.

1600 mutations of study, rover, terrain and curve files through the command line's own entry, and generated tables of
curves. Computing itself is cut off: what a file may break is its reading, checking and becoming tasks. Every case has a
seed of its own, named when it fails. Time is that of the processor, so that a busy machine does not look like a hang.
"""

from __future__ import annotations

import io
import signal
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from random import Random
from types import FrameType
from typing import Any

import numpy as np
import pytest
import rasterio
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from contracts.errors import WorkbenchError
from rover_dynamics.rover.rover_file import EXOMARS_ROVER
from tests.end_to_end.small_study import ROOT, run, small_study_text
from tests.mutations import HOSTILE_CELLS, mutated_bytes, mutated_sweep, mutated_table, mutated_toml, seeds
from workbench.cli import _run

REACHED = "the file was read and its tasks were made"
LONGEST = 10.0
"""Processor time of one case [s]."""
HEADERS = (
    *(
        "deflection_m",
        "load_N",
        "deflection_mm",
        "load_kN",
        "load",
        "diameter_change_mm",
        "loaded_radius_m",
        "force [lbf]",
    ),
    *("load_uncertainty_%", "load_uncertainty_N", "x", "", "_", "[mm]", "load_(N)", "deflection %", "load_N_N", "\x85"),
)
SI_CURVE = "deflection_m,load_N\n0,0\n0.01,80\n0.02,165\n"
CURVE = "# source: x\ndeflection_mm,load_kN,load_uncertainty_N\n" + "".join(
    f"{d},{0.008 * d + 1e-4 * d * d:.6g},{0.2 * d:.3g}\n" for d in range(12)
)


class HangError(BaseException):
    """A case took too long."""


def _hung(number: int, frame: FrameType | None) -> None:
    raise HangError


@contextmanager
def watched(longest: float) -> Iterator[None]:
    """HangError after so much processor time [s]."""
    before = signal.signal(signal.SIGVTALRM, _hung)
    signal.setitimer(signal.ITIMER_VIRTUAL, longest)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        signal.signal(signal.SIGVTALRM, before)


@pytest.fixture(autouse=True)
def nothing_computes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Tasks and scenarios stop where computing would begin; a defect shows its traceback."""

    def reached(*arguments: object, **options: object) -> None:
        raise WorkbenchError(REACHED)

    for command in ("computing", "calibrate", "calibrate_ancf"):
        monkeypatch.setattr(f"workbench.commands.{command}.run_tasks", reached)
    for command in ("sweep", "point_batches", "sample"):
        monkeypatch.setattr(f"workbench.commands.{command}.run_all", reached)
    monkeypatch.setattr("workbench.commands.rover.run_scenario", reached)
    monkeypatch.setenv("WORKBENCH_TRACEBACK", "1")


def outcome(arguments: list[str], capsys: pytest.CaptureFixture[str], case: object) -> str:
    """``read`` or ``refused``; anything else fails the test and names the case."""
    capsys.readouterr()
    try:
        with watched(LONGEST):
            status = _run(arguments)
    except BaseException as error:
        raise AssertionError(f"case {case}: {arguments}") from error
    lines = capsys.readouterr().err.splitlines(keepends=True)
    message = "".join(line for line in lines if not line.startswith("workbench: warning: "))
    if status in (0, 1):
        assert message == "", f"case {case}"
        return "read"
    assert status == 2, f"case {case}"
    assert message.startswith("workbench: error: "), f"case {case}: {message[:300]}"
    assert message.endswith("\n"), f"case {case}"
    assert len(message.splitlines()) == 1, f"case {case}: {message[:500]!r}"
    assert len(message) < 2000, f"case {case}: {message[:500]}"
    return "read" if REACHED in message else "refused"


@pytest.fixture(params=[3, pytest.param(1, marks=pytest.mark.long)], ids=["a third", "all"])
def share(request: pytest.FixtureRequest) -> int:
    """Every run tries one of so many cases, the long one each."""
    return int(request.param)


def fuzz(
    capsys: pytest.CaptureFixture[str], path: Path, arguments: list[str], damaged: Callable[[Random], bytes], count: int
) -> Counter[str]:
    """Run a command on ``count`` damaged files; how often each outcome came."""
    found: Counter[str] = Counter()
    for seed, source in enumerate(seeds(0, count)):
        path.write_bytes(damaged(source))
        found[outcome(arguments, capsys, seed)] += 1
    return found


@pytest.mark.parametrize(("model", "count"), [("fe", 130), ("section", 190), ("ancf", 130), ("brush", 40)])
def test_studies(tmp_path: Path, capsys: pytest.CaptureFixture[str], model: str, count: int, share: int) -> None:
    text, path = small_study_text(), tmp_path / f"{model}.toml"
    arguments = ["stiffness", str(path), "--model", model, "--out", str(tmp_path / "o"), "--store", str(tmp_path / "s")]
    found = fuzz(
        capsys, path, arguments, lambda source: mutated_toml(Random(f"{model}{source.random()}"), text), count // share
    )
    assert min(found["read"], found["refused"]) > 0


def test_sweeps(tmp_path: Path, capsys: pytest.CaptureFixture[str], share: int) -> None:
    text, path = (ROOT / "studies" / "strip_sweep.toml").read_text(encoding="utf-8"), tmp_path / "sweep.toml"
    arguments = ["sweep", str(path), "--out", str(tmp_path / "o"), "--store", str(tmp_path / "s")]
    found = fuzz(capsys, path, arguments, lambda source: mutated_sweep(source, text), 60 // share)
    assert min(found["read"], found["refused"]) > 5 // share


def test_rovers(tmp_path: Path, capsys: pytest.CaptureFixture[str], share: int) -> None:
    text, path = EXOMARS_ROVER.read_text(encoding="utf-8"), tmp_path / "rover.toml"
    arguments = ["rover", "straight", "--rover", str(path), "--out", str(tmp_path / "o")]
    found = fuzz(capsys, path, arguments, lambda source: mutated_toml(source, text), 500 // share)
    assert min(found["read"], found["refused"]) > 20 // share


def _archive(**options: Any) -> bytes:
    stream, heights = io.BytesIO(), np.random.default_rng(0).normal(size=(60, 16), scale=0.01)
    np.savez(stream, heights=heights, spacing=[0.5, 0.5], origin=[-10.0, -4.0], **options)
    return stream.getvalue()


def _image(folder: Path) -> bytes:
    place = rasterio.Affine(0.5, 0.0, -10.0, 0.0, -0.5, 4.0)
    size = {"width": 60, "height": 16, "count": 1, "dtype": "float64"}
    with rasterio.open(folder / "g.tif", "w", driver="GTiff", transform=place, crs="EPSG:32632", **size) as file:
        file.write(np.random.default_rng(0).normal(size=(16, 60), scale=0.01), 1)
    return (folder / "g.tif").read_bytes()


@pytest.mark.parametrize(("kind", "count"), [("npz", 200), ("tif", 100)])
def test_terrains(tmp_path: Path, capsys: pytest.CaptureFixture[str], kind: str, count: int, share: int) -> None:
    content, path = _archive() if kind == "npz" else _image(tmp_path), tmp_path / f"terrain.{kind}"
    arguments = ["rover", "straight", "--terrain", str(path), "--out", str(tmp_path / "o")]
    found = fuzz(capsys, path, arguments, lambda source: mutated_bytes(source, content), count // share)
    assert found["refused"] > 20


@pytest.mark.parametrize(("text", "count"), [(SI_CURVE, 200), (CURVE, 200)], ids=["own format", "units"])
def test_curves(tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, count: int, share: int) -> None:
    path, sound = tmp_path / "curve.csv", tmp_path / "sound.csv"
    sound.write_text(SI_CURVE, encoding="utf-8")
    for arguments in (["compare", str(path), str(sound)], ["compare", str(sound), str(path), "--tolerance", "5 %"]):
        damaged = lambda source: mutated_table(source, text, HEADERS)  # noqa: E731
        found = fuzz(capsys, path, arguments, damaged, count // 2 // share)
        assert min(found["read"], found["refused"]) > 5 // share


cells = st.one_of(
    st.floats(allow_nan=True, allow_infinity=True).map(repr), st.integers().map(str), st.sampled_from(HOSTILE_CELLS)
)
tables = st.tuples(
    st.lists(st.sampled_from(HEADERS), min_size=1, max_size=4), st.lists(st.lists(cells, max_size=4), max_size=6)
)


@settings(max_examples=100, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
@given(table=tables)
def test_generated_tables(tmp_path: Path, capsys: pytest.CaptureFixture[str], table: Any) -> None:
    header, rows = table
    text = "\n".join(",".join(row) for row in [header, *rows])
    (tmp_path / "sound.csv").write_text(SI_CURVE, encoding="utf-8")
    (tmp_path / "curve.csv").write_bytes(text.encode("utf-8", "surrogatepass"))
    outcome(["compare", str(tmp_path / "curve.csv"), str(tmp_path / "sound.csv")], capsys, text)


lengths = st.floats(1e-6, 1e3)


@settings(max_examples=20, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
@given(steps=st.lists(lengths, min_size=2, max_size=12), slope=st.floats(1e-3, 1e6), factor=st.floats(0.5, 2.0))
def test_sound_curves_are_never_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], steps: list[float], slope: float, factor: float
) -> None:
    d = np.concatenate([[0.0], np.cumsum(steps)])
    for name, load in (("a", slope * d), ("b", factor * slope * d)):
        rows = "".join(f"{x!r},{f!r}\n" for x, f in zip(d.tolist(), load.tolist(), strict=True))
        (tmp_path / f"{name}.csv").write_text(f"deflection_mm,load_N\n{rows}", encoding="utf-8")
    found = outcome(["compare", str(tmp_path / "a.csv"), str(tmp_path / "b.csv")], capsys, (steps, slope, factor))
    assert found == "read"


def test_negative_control_a_defect_a_hang_and_two_lines_are_caught(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a.csv").write_text(SI_CURVE, encoding="utf-8")
    arguments = ["compare", str(tmp_path / "a.csv"), str(tmp_path / "a.csv")]
    assert outcome(arguments, capsys, "sound") == "read"

    def endless(*_: object) -> None:
        while True:
            pass

    monkeypatch.setattr(f"{__name__}.LONGEST", 0.2)
    for defect in (lambda *_: 1 / 0, endless):
        monkeypatch.setattr("workbench.commands.compare.run_compare", defect)
        with pytest.raises(AssertionError, match="case damaged"):
            outcome(arguments, capsys, "damaged")

    def talkative(*_: object) -> None:
        sys.stderr.write("first\n")
        raise WorkbenchError("second")

    monkeypatch.setattr("workbench.commands.compare.run_compare", talkative)
    with pytest.raises(AssertionError, match="case damaged"):
        outcome(arguments, capsys, "damaged")


@pytest.mark.long
@pytest.mark.parametrize("kind", ["study", "rover", "curve"])
def test_the_same_as_a_process_of_its_own(tmp_path: Path, kind: str) -> None:
    """A few of the worst, from outside: nothing but the message may reach the terminal."""
    path = tmp_path / "ein Märchen.toml"
    arguments = {
        "study": ["stiffness", path, "--model", "brush", "--out", tmp_path / "o", "--store", tmp_path / "s"],
        "rover": ["rover", "straight", "--rover", path, "--out", tmp_path / "o"],
        "curve": ["compare", path, path],
    }[kind]
    for content in (b"a = " + b"[" * 5000, b"a = " + b"9" * 5000, b"\xff\xfe\x00", b"\x00"):
        path.write_bytes(content)
        ended = run(*arguments)
        assert (ended.returncode, ended.stdout, ended.stderr.count("\n")) == (2, "", 1), ended.stderr
        assert ended.stderr.startswith("workbench: error: ")
    assert not (tmp_path / "o").exists()
