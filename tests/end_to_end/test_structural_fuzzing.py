"""Studies, rovers, curves, terrains, arguments whose content is wrong: a message or a result, nothing absurd believed.

Each case is a sound file with one structural change (types swapped, keys renamed, lost or doubled, units exchanged,
numbers scaled by 1e12 or 1e-12), read through the command line's own entry. Never a traceback, a hang (a case has 50 s
of the processor), another exit status than 0, 1 and 2. *No absurd acceptance*: the oracle knows nothing of the reader's
ranges; a number scaled by 1e12 or 1e-12 must be refused or told, but for those in FREE. Cases are named by their seeds.
"""

from __future__ import annotations

import copy
import io
import math
import os
import tomllib
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
import rasterio

from rover_dynamics.rover.rover_file import EXOMARS_ROVER
from tests.end_to_end.small_study import run, small_study_text
from tests.end_to_end.test_fuzzing import REACHED, nothing_computes, watched
from tests.structural_mutations import Damage, damaged, paths_of, scaled, toml_text
from workbench.cli import _run
from workbench.study.reading import built_in_study

__all__ = ["nothing_computes"]

STUDIES = {
    "small": tomllib.loads(small_study_text()),
    "exomars": tomllib.loads(built_in_study().read_text(encoding="utf-8")),
    "amalia": tomllib.loads(built_in_study().with_name("amalia.toml").read_text(encoding="utf-8")),
}
ROVER = tomllib.loads(EXOMARS_ROVER.read_text(encoding="utf-8"))
FREE = {
    "sweep.seed": "any whole number will do",
    "input_uncertainty": "its samples are tried by `workbench check` and `sample`, not by reading",
    "pivots.*.axis": "a direction; only its own length is arbitrary",
}
"""Numbers that may be scaled without a word, and why."""
COMMANDS = [
    *(["stiffness", "FILE", "--model", model] for model in ("fe", "section", "ancf_wheel", "ancf", "brush")),
    *(
        ["report", "FILE"],
        ["mesh", "FILE"],
        ["calibrate", "FILE"],
        ["calibrate", "ancf", "FILE"],
        ["calibrate", "brush", "FILE"],
        ["sweep", "FILE"],
    ),
]
_WARNING = "workbench: warning: "
_ERROR = "workbench: error: "


def ended(arguments: list[str], capsys: pytest.CaptureFixture[str], case: object) -> tuple[int, str]:
    """Exit status and what stderr says, each line of it one of ours; anything else fails the test."""
    capsys.readouterr()
    try:
        with watched(50.0):
            status = _run(arguments)
    except BaseException as error:
        raise AssertionError(f"case {case}: {arguments}") from error
    told = capsys.readouterr().err
    assert status in (0, 1, 2), f"case {case}"
    assert "Traceback" not in told, f"case {case}: {told[-500:]}"
    assert "defect of the workbench" not in told, f"case {case}: {told[:500]}"
    usage = "Usage:" in told  # Typer's own message has a frame
    for line in [] if usage else told.splitlines():
        assert line.startswith((_WARNING, _ERROR)), f"case {case}: {line[:300]!r}"
        assert len(line) < 2000, f"case {case}"
    assert told.count(_ERROR) <= 1, f"case {case}"
    assert (status == 2) == (_ERROR in told or usage), f"case {case}: {status} {told[:300]}"
    return status, told


def _out(folder: Path) -> list[str]:
    return ["--out", str(folder / "o"), "--store", str(folder / "s")]


def believed(told: str, damage: Damage) -> bool:
    """Whether a number far from anything passed without a word about it."""
    kind, path, value = damage
    frost = str(value).endswith("degC") and "e-" in str(value)  # next to nothing in Celsius is a usual temperature
    name = ".".join("*" if isinstance(part, int) else part for part in path)
    free = any(name.startswith(one) for one in FREE) or path[-1] == "axis"
    refused = _ERROR in told and REACHED not in told
    return kind == "scale" and not (free or frost) and not refused and _WARNING not in told


def _fuzz_tables(
    capsys: pytest.CaptureFixture[str], folder: Path, tables: dict[str, dict[str, Any]],
    commands: list[list[str]], seeds: range,
) -> Counter[str]:  # fmt: skip
    """One damaged file a seed; how often each outcome came."""
    found: Counter[str] = Counter()
    path = folder / "file.toml"
    for seed in seeds:
        source = Random(seed)
        name = source.choice(sorted(tables))
        table, damage = damaged(source, tables[name])
        path.write_text(toml_text(table), encoding="utf-8")
        arguments = [str(path) if word == "FILE" else word for word in source.choice(commands)]
        case = f"{seed}: {name} {str(damage)[:300]}"
        status, told = ended([*arguments, *_out(folder)], capsys, case)
        assert not believed(told, damage), f"case {case}: believed"
        outcome = "read" if status < 2 or REACHED in told else "refused"
        found[f"{damage[0]} {outcome}"] += 1
    return found


def _studies(tmp_path: Path, capsys: pytest.CaptureFixture[str], seeds: range) -> Counter[str]:
    (tmp_path / "amalia_fe.csv").write_bytes(built_in_study().with_name("amalia_fe.csv").read_bytes())
    return _fuzz_tables(capsys, tmp_path, STUDIES, COMMANDS, seeds)


def _rovers(tmp_path: Path, capsys: pytest.CaptureFixture[str], seeds: range) -> Counter[str]:
    commands = [["rover", scenario, "--rover", "FILE", "--tire", "brush"] for scenario in ("straight", "drop", "step")]
    return _fuzz_tables(capsys, tmp_path, {"rover": ROVER}, commands, seeds)


def _cases(short: int, long: int) -> Callable[[Any], Any]:
    marks = [pytest.param(range(short), id="some"), pytest.param(range(1000, 1000 + long), id="many", marks=LONG)]
    return pytest.mark.parametrize("seeds", marks)


LONG = [pytest.mark.long, pytest.mark.timeout(7200)]


@_cases(60, 900)
def test_studies(tmp_path: Path, capsys: pytest.CaptureFixture[str], seeds: range) -> None:
    found = _studies(tmp_path, capsys, seeds)
    assert sum(found[f"{kind} refused"] for kind in ("scale", "swap", "rename", "unit")) > len(seeds) // 5
    assert sum(number for outcome, number in found.items() if outcome.endswith("read")) > len(seeds) // 50


@_cases(60, 500)
def test_rovers(tmp_path: Path, capsys: pytest.CaptureFixture[str], seeds: range) -> None:
    found = _rovers(tmp_path, capsys, seeds)
    assert found["scale refused"] > len(seeds) // 20
    assert sum(number for outcome, number in found.items() if outcome.endswith("read")) > len(seeds) // 50


def _numbers(table: dict[str, Any]) -> list[tuple[str | int, ...]]:
    found = []
    for path in paths_of(table):
        at: Any = table
        for part in path:
            at = at[part]
        if scaled(at, 2.0) is not None and "axis" not in path and path[0] not in ("name", "title", "inferred"):
            found.append(path)
    return found


@pytest.mark.long
@pytest.mark.timeout(7200)
@pytest.mark.parametrize("factor", [1e12, 1e-12])
@pytest.mark.parametrize("name", [*STUDIES, "rover"])
def test_no_number_is_believed_a_million_millions_larger_or_smaller(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, factor: float
) -> None:
    """Each number of each file in turn: none is left to chance."""
    (tmp_path / "amalia_fe.csv").write_bytes(built_in_study().with_name("amalia_fe.csv").read_bytes())
    base = ROVER if name == "rover" else STUDIES[name]
    start = ["rover", "straight", "--rover"] if name == "rover" else ["stiffness", "--model", "brush"]
    for path in _numbers(base):
        table = copy.deepcopy(base)
        at: Any = table
        for part in path[:-1]:
            at = at[part]
        at[path[-1]] = scaled(at[path[-1]], factor)
        (tmp_path / "file.toml").write_text(toml_text(table), encoding="utf-8")
        status, told = ended([*start, str(tmp_path / "file.toml"), *_out(tmp_path)], capsys, path)
        assert not believed(told, ("scale", path, at[path[-1]])), f"{path}: {at[path[-1]]} is believed"
        assert status == 2 or factor < 1.0, path  # what is all but zero may be told as such and used


CURVE = "# source: x\ndeflection_mm,load_kN,load_uncertainty_N\n" + "".join(
    f"{d},{0.008 * d:.6g},{0.2 * d:.3g}\n" for d in range(12)
)


def _damaged_curve(source: Random) -> tuple[str, bool]:
    """Cells swapped, columns lost and doubled, units exchanged, numbers scaled; whether to believe it is absurd.

    An uncertainty may be as small as it likes.
    """
    rows = [line.split(",") for line in CURVE.splitlines()[1:]]
    kind, k, absurd = source.randrange(7), source.randrange(3), False
    if kind == 0:
        source.choice(rows)[k] = source.choice(("", "x", "1 mm", "True", "[]", "nan", "1e400", "\x00", "1" * 5000))
    elif kind == 1:
        rows = [[*row[:k], *row[k + 1 :]] for row in rows]
    elif kind == 2:
        rows = [[*row, row[k]] for row in rows]
    elif kind == 3:
        rows[0][k] = source.choice(("deflection_kg", "load_mm", "load_%", "x", "", "deflection_deg", "load_N/m"))
    elif kind == 4:
        factor = source.choice((1e12, 1e-12, 1e300, -1.0))
        absurd = factor > 1.0 or (factor > 0.0 and k < 2)
        rows[1:] = [[*row[:k], repr(float(row[k]) * factor), *row[k + 1 :]] for row in rows[1:]]
    elif kind == 5:
        rows = [list(column) for column in zip(*rows, strict=True)]
    else:
        source.shuffle(rows)
    return "\n".join(["# source: x", *(",".join(row) for row in rows)]) + "\n", absurd


@_cases(60, 400)
def test_curves(tmp_path: Path, capsys: pytest.CaptureFixture[str], seeds: range) -> None:
    sound, path, statuses = tmp_path / "sound.csv", tmp_path / "curve.csv", Counter[int]()
    sound.write_text(CURVE, encoding="utf-8")
    for seed in seeds:
        source = Random(seed)
        text, absurd = _damaged_curve(source)
        path.write_text(text, encoding="utf-8")
        files = [str(path), str(sound)][:: source.choice((1, -1))]
        status, _ = ended(["compare", *files, *source.choice(([], ["--tolerance", "5 %"]))], capsys, seed)
        assert status == 2 or not absurd, f"case {seed}: believed"
        statuses[status] += 1
    assert min(statuses[0] + statuses[1], statuses[2]) > len(seeds) // 20


def _terrain(source: Random, folder: Path) -> Path:
    heights: Any = np.random.default_rng(0).normal(size=(60, 16), scale=0.01)
    fields: dict[str, Any] = {"heights": heights, "spacing": [0.5, 0.5], "origin": [-10.0, -4.0]}
    place, crs = rasterio.Affine(0.5, 0.0, -10.0, 0.0, -0.5, 4.0), "EPSG:32632"
    kind = source.randrange(9)
    factor = source.choice((1e12, 1e-12, 0.0, -1.0, math.nan, math.inf))
    name = source.choice(list(fields))
    if kind < 3:
        fields[name] = np.asarray(fields[name]) * factor
        place = place @ rasterio.Affine.scale(factor, 1.0) if kind == 1 and math.isfinite(factor) else place
    elif kind == 3:
        fields[name] = source.choice((np.zeros(0), np.zeros((2, 2, 2)), "text", 1.0, np.array(["a", "b"]), [1.0]))
    elif kind == 4:
        del fields[name]
    elif kind == 5:
        fields[f"{name}s"] = fields.pop(name)
    elif kind == 6:
        fields[name] = np.asarray(fields[name]).astype(source.choice(("int8", "complex128", "bool", "float16")))
    else:
        crs = source.choice(("EPSG:4326", "EPSG:2225", "EPSG:32632"))
    if source.random() < 0.5:
        with io.BytesIO() as stream:
            np.savez(stream, **fields)
            (folder / "t.npz").write_bytes(stream.getvalue())
        return folder / "t.npz"
    size = {"width": 60, "height": 16, "count": source.choice((1, 3)), "dtype": source.choice(("float64", "uint8"))}
    with rasterio.open(folder / "t.tif", "w", driver="GTiff", transform=place, crs=crs, **size) as file:
        file.write(np.nan_to_num(np.broadcast_to(heights.T * 1.0, (16, 60)) * factor).astype(size["dtype"]), 1)
    return folder / "t.tif"


@pytest.mark.filterwarnings("ignore:invalid value encountered", "ignore:Casting complex values", "ignore:overflow")
@pytest.mark.filterwarnings("ignore::rasterio.errors.NotGeoreferencedWarning")
@_cases(40, 200)
def test_terrains(tmp_path: Path, capsys: pytest.CaptureFixture[str], seeds: range) -> None:
    statuses = Counter[bool]()
    for seed in seeds:
        path = _terrain(Random(seed), tmp_path)
        _, told = ended(["rover", "straight", "--terrain", str(path), "--out", str(tmp_path / "o")], capsys, seed)
        statuses[REACHED in told] += 1
    assert statuses[False] > len(seeds) // 10


WORDS = (
    *("0", "-1", "1", "nan", "inf", "-inf", "1e308", "1e12", "1e-12", "1e-320", "9" * 400, "", " ", "x", "½", "\x01"),
    *(
        "1 mm",
        "5 %",
        "-3 N",
        "8.25 N/mm",
        "1e300 N/m",
        "15 deg",
        "[]",
        "{}",
        "--",
        "-x",
        "--help",
        "../..",
        "/dev/null",
    ),
    *("/dev/zero", "PIPE", "FOLDER", "HUGE", "STUDY", "CURVE", "true", "None", "a" * 5000, "[/red]", "\x1b[31m"),
)
OPTIONS: dict[str, tuple[str, ...]] = {
    "stiffness": ("--model", "--orientation", "--workers", "--ranks"),
    "mesh": ("--model", "--deflection", "--orientation"),
    "compare": ("--max-load", "--uncertainty", "--tolerance"),
    "rover": ("--tire", "--rover", "--gravity", "--terrain", "--start", "--rocks"),
    "report": ("--baseline", "--workers", "--ci", "--full"),
    "calibrate": ("--target",),
    "sweep": ("--workers",),
}


@pytest.fixture
def hostile(tmp_path: Path) -> dict[str, str]:
    """Words that stand for files of a folder."""
    os.mkfifo(tmp_path / "pipe")
    with (tmp_path / "huge").open("wb") as stream:
        stream.truncate(10**12)
    (tmp_path / "study.toml").write_text(small_study_text(), encoding="utf-8")
    (tmp_path / "curve.csv").write_text(CURVE, encoding="utf-8")
    names = {"PIPE": "pipe", "HUGE": "huge", "FOLDER": ".", "STUDY": "study.toml", "CURVE": "curve.csv"}
    return {word: str(tmp_path / name) for word, name in names.items()}


def _arguments(source: Random, hostile: dict[str, str], folder: Path) -> list[str]:
    command = source.choice(sorted(OPTIONS))
    first = {"compare": ["CURVE", "CURVE"], "rover": ["straight"]}.get(command, ["STUDY"])
    words = [command, *first]
    if source.random() < 0.4:
        words[source.randrange(1, len(words))] = source.choice(WORDS)
    for _ in range(source.randint(0, 2)):
        option = source.choice(OPTIONS[command])
        words += [option, source.choice(WORDS), *([source.choice(WORDS)] if option == "--start" else [])]
    outs = ["--out", str(folder / "o")] + (["--store", str(folder / "s")] if command != "compare" else [])
    return [hostile.get(word, word) for word in words] + outs


@_cases(25, 400)
def test_arguments(tmp_path: Path, capsys: pytest.CaptureFixture[str], hostile: dict[str, str], seeds: range) -> None:
    statuses = Counter[int]()
    for seed in seeds:
        words = _arguments(Random(seed), hostile, tmp_path)
        status, _ = ended(words, capsys, f"{seed}: {[word[:80] for word in words]}")
        statuses[status] += 1
    assert statuses[2] > len(seeds) // 5


@pytest.mark.long
def test_a_few_as_processes_of_their_own(tmp_path: Path, hostile: dict[str, str]) -> None:
    """From outside: exit status, one line each on stderr, nothing left behind."""
    for seed in range(3):
        table, damage = damaged(Random(seed), STUDIES["small"])
        (tmp_path / "file.toml").write_text(toml_text(table), encoding="utf-8")
        found = run("stiffness", tmp_path / "file.toml", "--model", "brush", *_out(tmp_path))
        assert found.returncode in (0, 2), f"{damage}: {found.stderr}"
        assert all(line.startswith((_WARNING, _ERROR)) for line in found.stderr.splitlines()), found.stderr
    for word in ("PIPE", "FOLDER", "HUGE"):
        found = run("stiffness", hostile[word], "--model", "brush", *_out(tmp_path))
        assert (found.returncode, found.stdout, found.stderr.count("\n")) == (2, "", 1), found.stderr


def test_negative_control_what_is_believed_is_seen(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The same oracle on a reader that asks no range: it must complain."""
    damage: Damage = ("scale", ("materials", "Ti-6Al-4V", "density"), "4.43e15 kg/m^3")
    assert believed("", damage)
    assert believed(f"{_ERROR}{REACHED}", damage)
    assert not believed(f"{_ERROR}density: must lie", damage)
    assert not believed(f"{_WARNING}density is unusual", damage)
    assert not believed("", ("swap", damage[1], 1))
