"""Reads the commands out of Markdown pages and runs them as a user would: in a shell, in order, in a folder of its own.

In a ``console`` block, lines that begin with ``$ `` are commands and the others what they print: ``...`` stands for
anything, also for whole lines, and a number for any number. ``[exit status 2]`` is the status of the command before it,
0 if nothing is said. Every line of a ``bash`` block is a command. A block with ``title="FILE"`` is a file the reader
saves. ``<!-- not run: REASON -->`` right before a block keeps it from being run.
"""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

__all__ = ["Block", "Command", "blocks_of", "explain", "run_command", "unlike"]

_FENCE = re.compile(
    r"^(?P<indent>[ \t]*)(?:<!-- not run: (?P<reason>.*?) -->[ \t]*\n(?P=indent))?"
    r"```(?P<language>console|bash|[a-z]+(?= title=))(?: title=\"(?P<title>[^\"]+)\")?[ \t]*\n"
    r"(?P<text>.*?)^(?P=indent)```[ \t]*$",
    re.M | re.S,
)
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
_STATUS = re.compile(r"\[exit status (\d+)\]")


@dataclass(frozen=True, slots=True, kw_only=True)
class Command:
    """One command line, what it prints according to the page, and its exit status."""

    line: str
    output: tuple[str, ...] = ()
    status: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Block:
    """One fenced block: commands, or a file to save; ``reason`` is why it is not run, empty if it is."""

    commands: tuple[Command, ...] = ()
    file: str = ""
    text: str = field(default="", repr=False)
    reason: str = ""


def blocks_of(page: str) -> Iterator[Block]:
    """Every console and bash block and every titled block of a page, in order."""
    for found in _FENCE.finditer(page):
        text = re.sub(rf"(?m)^{found['indent']}", "", found["text"])
        if found["title"]:
            yield Block(file=found["title"], text=text)
        elif found["language"] == "bash":
            lines = [line for line in text.splitlines() if line.strip()]
            yield Block(commands=tuple(Command(line=line) for line in lines), reason=found["reason"] or "")
        else:
            yield Block(commands=tuple(_commands(text)), reason=found["reason"] or "")


def _commands(text: str) -> Iterator[Command]:
    for part in re.split(r"(?m)^\$ ", text)[1:]:
        line, *output = part.rstrip().splitlines()
        status = [int(found[1]) for text in output if (found := _STATUS.fullmatch(text))]
        yield Command(
            line=line,
            output=tuple(text for text in output if text.strip() and not _STATUS.fullmatch(text)),
            status=status[0] if status else 0,
        )


def run_command(command: Command, folder: Path, environment: Mapping[str, str]) -> subprocess.CompletedProcess[str]:
    """Run one command in a shell; its two streams come as one, as in a terminal."""
    return subprocess.run(
        ["bash", "-c", command.line],
        cwd=folder, env=dict(environment), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        text=True, check=False,
    )  # fmt: skip


def unlike(command: Command, printed: str) -> str:
    """The first expected line that was not printed behind the one before it; empty if all were."""
    lines = iter([re.sub(r"\s+", " ", line).strip() for line in printed.splitlines()])
    for expected in command.output:
        if expected.strip() == "...":
            continue
        pattern = re.compile(_pattern(expected))
        if not any(pattern.fullmatch(line) for line in lines):
            return expected
    return ""


def _pattern(expected: str) -> str:
    words = re.sub(r"\s+", " ", expected).strip().split("...")
    return ".*".join(_NUMBER.pattern.join(map(re.escape, _NUMBER.split(part))) for part in words)


def explain(command: Command, run: subprocess.CompletedProcess[str]) -> str:
    """What a failing test shows."""
    return f"$ {command.line}\n{run.stdout}\n[exit status {run.returncode}, the page says {command.status}]"
