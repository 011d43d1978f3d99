"""What the commands do around the tasks: an error of a task names the study; the doctor lists only what is used."""

from __future__ import annotations

import importlib.metadata
import re
from pathlib import Path

import pytest

from contracts.errors import InputError, StudyError
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


@pytest.mark.parametrize("distribution", NEEDED)
def test_everything_the_doctor_asks_for_is_imported(distribution: str) -> None:
    """A distribution is listed only if some module of ours imports one of its packages."""
    owners = importlib.metadata.packages_distributions()
    modules = {name for name, owned in owners.items() if distribution in owned} | {distribution.replace("-", "_")}
    text = "\n".join(p.read_text(encoding="utf-8") for package in PACKAGES for p in (ROOT / package).rglob("*.py"))
    assert any(re.search(rf"^\s*(import|from) {re.escape(name)}\b", text, re.MULTILINE) for name in modules)
