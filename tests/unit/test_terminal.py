"""The terminal shows texts as they are, wherever they stand, and nothing writes to it but our own console."""

from __future__ import annotations

import ast
import io
import re
from pathlib import Path

import pytest
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from contracts.text import for_terminal
from tests.unit.test_text import HIDDEN, NASTY
from workbench.execution.progress import RunDisplay
from workbench.execution.store import Entry
from workbench.execution.task import Task
from workbench.execution.terminal import Terminal

ROOT = Path(__file__).parents[2]
TEXTS = [*NASTY.values(), *HIDDEN]


def _shown(text: str, *, tty: bool = False) -> str:
    """What print, a table's title, cell and header, and a spinner show of a text."""
    stream = io.StringIO()
    terminal = Terminal(file=stream, width=4000, force_terminal=tty, color_system=None)
    terminal.print(text)
    table = Table(text, title=text)
    table.add_row(text)
    terminal.print(table)
    if tty:
        with terminal.status(text):
            pass
    return stream.getvalue()


@pytest.mark.parametrize("text", TEXTS, ids=range(len(TEXTS)))
def test_a_text_is_shown_as_it_is(text: str) -> None:
    shown = _shown(text)
    assert shown.count(for_terminal(text).strip()) == 4
    assert not re.search(r"[\x00-\x09\x0b-\x1f\x7f-\x9f]", shown)


@pytest.mark.parametrize("text", ["[red]a[/red]", "[/red]", ":warning: [link=x]y", "\x1b[31m"])
def test_a_spinner_shows_it_too(text: str) -> None:
    assert _shown(text, tty=True).count(for_terminal(text)) >= 5


def test_a_plain_console_would_not() -> None:
    stream = io.StringIO()
    Console(file=stream, width=400).print("[red]a[/red]")
    assert stream.getvalue() == "a\n"


@pytest.mark.parametrize("tty", [True, False])
def test_a_run_shows_the_names_of_its_tasks(tty: bool, tmp_path: Path) -> None:
    task = Task(name="fit_[/red]", function="m:f", inputs={})
    stream = io.StringIO()
    terminal = Terminal(file=stream, width=400, force_terminal=tty, color_system=None)
    with RunDisplay(terminal, [task]) as display:
        assert isinstance(display.progress, Progress)
        display.started(task.name)
        display.damaged(task.name, "[/b] is gone\n::error::x")
        display.finished(task.name, Entry(key="k", path=tmp_path, manifest={"wall_s": 1.0}), reused=False)
    shown = stream.getvalue()
    assert "fit_[/red]" in shown
    assert "[/b] is gone \\x3a:error::x" in shown


def test_nothing_else_writes_to_the_terminal() -> None:
    """No module of the workbench makes a console of its own, and `print` is left to JSON and to MPI's ranks."""
    found = set()
    for path in (ROOT / "workbench").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in ("Console", "rich.print", "print"):
                found.add(f"{path.relative_to(ROOT)}: {ast.unparse(node.func)}")
    assert found == {"workbench/commands/results.py: print", "workbench/execution/ranks.py: print"}


def test_no_command_writes_markup() -> None:
    """The terminal would show it as it is: "[green]pass[/]"."""
    found = [
        f"{path.relative_to(ROOT)}:{node.lineno}"
        for path in sorted((ROOT / "workbench").rglob("*.py"))
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and re.search(r"\[/[a-z ]*\]", node.value)
    ]
    assert not found
