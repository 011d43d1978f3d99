"""The example workflows parse, and every command in them exists with the options it is given."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import Any

import pytest
import yaml
from typer.main import get_command

from workbench.cli import app

ROOT = Path(__file__).parents[2]
EXAMPLES = ("docs/ci/github-actions.yml", "docs/ci/gitlab-ci.yml")


def _texts(node: Any) -> list[str]:
    """Every string of a YAML document."""
    if isinstance(node, dict):
        return [text for value in node.values() for text in _texts(value)]
    if isinstance(node, list):
        return [text for value in node for text in _texts(value)]
    return [node] if isinstance(node, str) else []


def _commands(path: str, program: str) -> list[list[str]]:
    """Arguments of each call of a program in the workflow, or in a code block of a Markdown file."""
    text = (ROOT / path).read_text(encoding="utf-8")
    lines = re.findall(r"^.*$", text, re.MULTILINE) if path.endswith(".md") else _texts(yaml.safe_load(text))
    parts = [part.split("#")[0].strip() for line in lines for part in line.split("&&")]
    return [shlex.split(part)[1:] for part in parts if re.match(rf"(\S*/)?{program} \w", part)]


def _unknown(arguments: list[str]) -> list[str]:
    """The command, or options of it, that the workbench does not have."""
    known = get_command(app).commands.get(arguments[0])  # type: ignore[attr-defined]
    if known is None:
        return arguments[:1]
    options = {name for parameter in known.params for name in parameter.opts}
    return [word for word in arguments if word.startswith("--") and word not in options]


@pytest.mark.parametrize("path", [*EXAMPLES, "docs/ci_gate.md"])
def test_the_workbench_has_every_command_and_option(path: str) -> None:
    found = _commands(path, "workbench")
    assert any({"report", "--ci", "--baseline"} <= set(arguments) for arguments in found)
    assert [unknown for arguments in found for unknown in _unknown(arguments)] == []


@pytest.mark.parametrize("path", EXAMPLES)
def test_make_has_every_target_and_studies_exist(path: str) -> None:
    targets = set(re.findall(r"^([\w-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
    assert {target for arguments in _commands(path, "make") for target in arguments} <= targets
    files = [word for arguments in _commands(path, "workbench") for word in arguments if word.endswith(".toml")]
    assert files
    assert all((ROOT / file).is_file() for file in files)


def test_negative_control_an_option_that_is_not_there_is_found() -> None:
    assert _unknown(["report", "--baseline", "b", "--strict"]) == ["--strict"]
    assert _unknown(["gate"]) == ["gate"]
