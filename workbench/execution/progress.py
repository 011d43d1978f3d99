"""Shows the run: live bars on a terminal, one line per finished task elsewhere.

Verified by tests/end_to_end/test_report.py.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from types import TracebackType
from typing import Self

from rich.progress import BarColumn, Progress, ProgressColumn, TaskID, TextColumn, TimeElapsedColumn
from rich.progress import Task as ProgressTask
from rich.text import Text

from contracts.text import for_terminal
from workbench.execution.listening import Teller
from workbench.execution.remaining import RemainingTime
from workbench.execution.store import Entry
from workbench.execution.task import Task
from workbench.execution.terminal import Terminal

__all__ = ["RunDisplay", "duration_text"]

_UNITS = ((86400.0, "d"), (3600.0, "h"), (60.0, "min"), (1.0, "s"))


def duration_text(seconds: float) -> str:
    """An age or a duration in its largest unit: ``"3 d"``, ``"5 h"``, ``"12 min"``, ``"40 s"``."""
    size, unit = next(((size, unit) for size, unit in _UNITS if seconds >= size), _UNITS[-1])
    return f"{max(seconds, 0.0) / size:.0f} {unit}"


class _Left(ProgressColumn):
    """Remaining time of the run, in the row of all tasks; looked at again as the clock goes on, news or none."""

    max_refresh = 1.0

    def __init__(self, display: RunDisplay) -> None:
        super().__init__()
        self._display = display

    def render(self, task: ProgressTask) -> Text:
        """The text of one row."""
        return Text(self._display.left() if task.id == self._display.whole else "")


class RunDisplay(Teller):
    """A ``Listener`` that draws Rich progress bars, or prints plain lines when standard output is no terminal."""

    def __init__(self, console: Terminal, tasks: Sequence[Task]) -> None:
        self.console, self.total = console, len(tasks)
        self.remaining = RemainingTime(tasks)
        self.count = self.reused = 0
        self.bars: dict[str, TaskID] = {}
        self.progress = Progress(
            TextColumn("{task.description:<24}", markup=False),
            BarColumn(),
            TextColumn("{task.percentage:>3.0f} %", markup=False),
            TimeElapsedColumn(),
            _Left(self),
            console=console,
            disable=not console.is_terminal,
        )
        self.whole = self.progress.add_task("all tasks", total=float(self.total))

    def __enter__(self) -> Self:
        self.progress.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.progress.stop()

    def say(self, sentence: str, *, warning: bool = False) -> None:
        """In one line, a warning like the rest."""
        self.console.print(sentence)

    def warned(self, warning: str) -> None:
        """Say so, on standard error."""
        sys.stderr.write(f"workbench: warning: {for_terminal(warning)}\n")

    def started(self, name: str) -> None:
        """Add a bar for the task."""
        self.remaining.started(name, time.monotonic())
        self.bars[name] = self.progress.add_task(name, total=1.0)

    def progressed(self, name: str, fraction: float) -> None:
        """Move the task's bar."""
        self.remaining.progressed(name, fraction, time.monotonic())
        self.progress.update(self.bars[name], completed=min(max(fraction, 0.0), 1.0))

    def finished(self, name: str, entry: Entry, reused: bool) -> None:
        """Fill the task's bar and count it."""
        self.count += 1
        self.reused += reused
        if name in self.bars:
            self.progress.update(self.bars[name], completed=1.0)
        self.remaining.finished(name, entry.wall_s, reused=reused)
        self.progress.update(self.whole, completed=float(self.count))
        if not self.console.is_terminal:
            left = self.left()
            how = "reused" if reused else f"computed in {entry.wall_s:.1f} s{left and f', {left}'}"
            self.console.print(f"[{self.count}/{self.total}] {name}: {how}")

    def restarted(self, name: str, reason: str) -> None:
        """Say so; the task's bar starts anew."""
        self._drop(name)
        super().restarted(name, reason)

    def failed(self, name: str, message: str) -> None:
        """Say so; the whole message comes at the end."""
        self._drop(name)
        self.remaining.dropped(name)
        self.say(f"{name}: failed; what does not need it goes on")

    def left(self) -> str:
        """``"about 3 min left"``, ``"at least 3 min left"``; nothing where nothing is known or all is done."""
        left = self.remaining.left(time.monotonic())
        if left is None or left.seconds < 1.0:
            return ""
        return f"{'at least' if left.at_least else 'about'} {duration_text(left.seconds)} left"

    def _drop(self, name: str) -> None:
        if name in self.bars:
            self.progress.remove_task(self.bars.pop(name))
