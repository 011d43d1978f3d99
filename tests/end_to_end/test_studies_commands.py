"""A study file to begin with, and whether one can be used: as a user does it."""

from __future__ import annotations

import tomllib
from importlib.metadata import version
from pathlib import Path

import pytest

from contracts.errors import StudyError
from tests.end_to_end.small_study import run, said
from workbench.commands.studies import run_check
from workbench.questions.study_graph import report_tasks
from workbench.study.reading import built_in_study, read_study

SHIPPED = sorted(built_in_study().parent.glob("*.toml"))


def test_version() -> None:
    assert run("--version").stdout == f"workbench {version('wheel-workbench')}\n"


@pytest.mark.parametrize("shipped", SHIPPED, ids=lambda path: path.stem)
def test_a_new_study_is_the_shipped_one_wherever_it_lies(
    shipped: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = run("new", "my-wheel.toml", "--from", shipped.stem, folder=tmp_path)
    assert (made.returncode, made.stderr) == (0, "")
    text, old = ((path.read_text(encoding="utf-8")) for path in (tmp_path / "my-wheel.toml", shipped))
    assert text.count("#") == old.count("#") + 1 - 2 * read_study(shipped).of_the_thesis
    assert tomllib.loads(text)["name"] == "my-wheel"
    study, before = read_study(tmp_path / "my-wheel.toml"), read_study(shipped)
    assert study.wheel == before.wheel
    if before.of_the_thesis:  # a copy is another wheel, of which the thesis says nothing
        before = before.model_copy(update={"reference": None})
    assert study.of_the_thesis is False
    assert run_check(tmp_path / "my-wheel.toml") == 0
    printed = capsys.readouterr()
    assert printed.err == ""
    assert f"its report takes {len(report_tasks(before))} tasks" in printed.out
    assert [path.name for path in tmp_path.iterdir()] == ["my-wheel.toml"]


def test_nothing_is_overwritten_and_nothing_unusable_is_written(tmp_path: Path) -> None:
    (tmp_path / "a.toml").write_text("mine", encoding="utf-8")
    for arguments, words in (
        (("new", "a.toml"), "is there already"),
        (
            ("new", "b.toml", "--from", "nothing"),
            "one of amalia, e3, exomars, exomars_hoops, first, honeycomb, leaf_optimise, leaves, rubber_tread",
        ),
        (("new", "b c.toml"), "name = 'b c': must begin with a letter"),
        (("new", "none/b.toml"), "No such file or directory"),
        (("check", "a.toml"), "is not valid TOML"),
    ):
        ended = said(*arguments, folder=tmp_path)
        assert ended.returncode == 2
        (line,) = ended.stderr.splitlines()
        assert words in line
    assert [(path.name, path.read_text(encoding="utf-8")) for path in tmp_path.iterdir()] == [("a.toml", "mine")]


def test_what_is_unusual_is_told(tmp_path: Path) -> None:
    text = built_in_study().read_text(encoding="utf-8").replace("poisson_ratio = 0.342", "poisson_ratio = -0.342")
    (tmp_path / "a.toml").write_text(text, encoding="utf-8")
    ended = run("check", "a.toml", folder=tmp_path)
    assert ended.returncode == 0
    assert "poisson_ratio = -0.342 is unusual" in ended.stderr


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ('"fe.nothing" = [1, 2]', "[sweep] point 1 (fe.nothing = 1): fe.nothing = 1: is not a known key"),
        ('strip_thickness = ["-0.6 mm"]', "point 1 (strip_thickness = '-0.6 mm')"),
        ('strip_thickness = ["0.6 mm", "-0.6 mm"]', "point 2 (strip_thickness = '-0.6 mm')"),
        ('models = ["fe"]\ntemperature = ["-5 K"]', "point 1 (temperature = '-5 K'): temperature = -5 K"),
        ("plates = [0]", "point 1 (plates = 0)"),
        ("[sweep.plates]\nlow = 0\nhigh = 9\n[sweep.fe.friction]\nlow = 0.1\nhigh = 0.2", "plates = 0"),
    ],
)
def test_a_sweep_that_cannot_be_read_is_refused(tmp_path: Path, line: str, words: str) -> None:
    _with_sweep(tmp_path / "a.toml", line)
    with pytest.raises(StudyError) as caught:
        run_check(tmp_path / "a.toml")
    assert words in str(caught.value)


def test_a_deflection_of_a_sweep_beyond_every_curve_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _with_sweep(tmp_path / "a.toml", 'strip_thickness = ["0.6 mm", "0.61 mm"]\ndeflections = ["20 mm", "500 mm"]')
    assert run_check(tmp_path / "a.toml") == 0
    (line,) = capsys.readouterr().err.splitlines()
    assert "sweep.deflections[1] = 500 mm lies beyond the largest max_deflection, 20 mm" in line


def _with_sweep(path: Path, lines: str) -> None:
    """The shipped sweep's study with another [sweep]; a hypercube where ``lines`` give ranges."""
    text = (built_in_study().parent / "strip_sweep.toml").read_text(encoding="utf-8")
    start, end = text.index("[sweep]"), text.index("# --- The wheel")
    hypercube = 'design = "latin-hypercube"\nsamples = 60\n' if "low =" in lines else ""
    path.write_text(f"{text[:start]}[sweep]\n{hypercube}{lines}\n{text[end:]}", encoding="utf-8")
