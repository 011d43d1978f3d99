"""What the commands do around the tasks: an error of a task names the study; the doctor lists only what is used."""

from __future__ import annotations

import importlib.metadata
import re
import subprocess
import sys
from pathlib import Path

import pytest

from contracts.errors import InputError, StudyError
from tests.end_to_end.small_study import said
from workbench.commands.computing import naming, warn
from workbench.execution.doctor import NEEDED
from workbench.execution.errors import InterruptedRunError, RunError

ROOT = Path(__file__).parents[2]
PACKAGES = ("contracts", "geometry", "soil", "reference_fe", "ancf_reduced", "rover_dynamics", "workbench")


@pytest.mark.parametrize("error", [RunError("task mesh failed"), InputError("load", "1 N", "is low", "raise it")])
def test_an_error_of_a_task_names_the_study(error: Exception) -> None:
    with pytest.raises(RunError, match=rf"^my/study.toml: {error}$"), naming(Path("my/study.toml")):
        raise error


@pytest.mark.parametrize("error", [InterruptedRunError("interrupted"), StudyError("s.toml", "a", 1, "is bad", "mend")])
def test_what_needs_no_study_name_stays_as_it_is(error: Exception) -> None:
    with pytest.raises(type(error)) as caught, naming(Path("my/study.toml")):
        raise error
    assert caught.value is error


def test_a_warning_is_of_bearable_length(capsys: pytest.CaptureFixture[str]) -> None:
    """A key of [inferred] of thousands of letters: its two ends are told."""
    warn(Path("my/study.toml"), [f"{'k' * 9000} names no key of the study", "short"])
    long, short = capsys.readouterr().err.splitlines()
    assert len(long) < 2000
    assert long.startswith("workbench: warning: my/study.toml: kkk")
    assert long.endswith("kkk names no key of the study")
    assert short == "workbench: warning: my/study.toml: short"


SAID_ON_A_TERMINAL = """
import sys

class Screen:
    terminal, told = True, []
    def isatty(self):
        return self.terminal
    def write(self, text):
        self.told.append((text, sorted({"numpy", "rich.progress", "workbench.execution.runner"} & set(sys.modules))))
    def flush(self):
        pass

from workbench.cli import app
sys.stderr = Screen()
Screen.terminal = sys.argv[1] == "terminal"
try:
    app(sys.argv[2:], standalone_mode=False)
except Exception as error:
    print(type(error).__name__)
print(Screen.told)
"""


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("stiffness", "none.toml"), "stiffness none.toml"),
        (("report", "none.toml"), "report none.toml"),
        (("modes", "none.toml"), "modes none.toml"),
        (("rover", "no_such_scenario"), "rover no_such_scenario"),
        (("calibrate", "none.toml"), "thickness none.toml"),
        (("drawbar", "none.toml"), "drawbar none.toml"),
    ],
)
def test_a_long_command_says_at_once_what_it_is_about(arguments: tuple[str, ...], words: str) -> None:
    """On a terminal, and before the libraries are loaded that take the time."""
    for screen, told in (("terminal", [(f"{words}: loading and planning\n", [])]), ("pipe", [])):
        call = [sys.executable, "-c", SAID_ON_A_TERMINAL, screen, *arguments]
        ended = subprocess.run(call, cwd=ROOT, capture_output=True, text=True, check=True)
        error, said = ended.stdout.splitlines()
        assert error in ("InputError", "StudyError")
        assert said == repr(told), screen


def test_help_and_wrong_usage_are_not_announced() -> None:
    for arguments in (("report", "--help"), ("report", "--nonsense")):
        call = [sys.executable, "-c", SAID_ON_A_TERMINAL, "terminal", *arguments]
        ended = subprocess.run(call, cwd=ROOT, capture_output=True, text=True, check=True)
        assert ended.stdout.splitlines()[-1] == "[]"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("drawbar", "--soil", "grc1", "--soil=fjs1"), "workbench: error: --soil: is given twice, and counts once; "),
        (("stiffness", "none.toml", "--load", "1", "--load", "2"), "workbench: error: --load: is given twice"),
        (
            ("stiffness", "none.toml", "--orientation", "1", "--orientation", "2"),
            "workbench: error: none.toml: does not",
        ),
        (("drawbar", "none.toml", "--towed", "--towed"), "workbench: error: none.toml: does not exist"),
    ],
)
def test_an_option_that_counts_once_is_given_once(arguments: tuple[str, ...], message: str) -> None:
    ended = said(*arguments)
    assert ended.returncode == 2
    assert message in ended.stderr
    assert ended.stderr.count("\n") == 1


@pytest.mark.parametrize("distribution", NEEDED)
def test_everything_the_doctor_asks_for_is_imported(distribution: str) -> None:
    """A distribution is listed only if some module of ours imports one of its packages."""
    owners = importlib.metadata.packages_distributions()
    modules = {name for name, owned in owners.items() if distribution in owned} | {distribution.replace("-", "_")}
    text = "\n".join(p.read_text(encoding="utf-8") for package in PACKAGES for p in (ROOT / package).rglob("*.py"))
    assert any(re.search(rf"^\s*(import|from) {re.escape(name)}\b", text, re.MULTILINE) for name in modules)
