"""Shows the run: live bars on a terminal, one line per finished task elsewhere.

Verified by tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn

from workbench.execution.store import Entry

__all__ = ["RunDisplay"]


class RunDisplay:
    """A ``Listener`` that draws Rich progress bars, or prints plain lines when standard output is no terminal."""

    def __init__(self, console: Console, total: int) -> None:
        self.console, self.total = console, total
        self.count = self.reused = 0
        self.bars: dict[str, TaskID] = {}
        self.progress = Progress(
            TextColumn("{task.description:<24}"),
            BarColumn(),
            TextColumn("{task.percentage:>3.0f} %"),
            TimeElapsedColumn(),
            console=console,
            disable=not console.is_terminal,
        )
        self.whole = self.progress.add_task("all tasks", total=float(total))

    def __enter__(self) -> Self:
        self.progress.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.progress.stop()

    def damaged(self, name: str, fault: str) -> None:
        """Say so, in one line."""
        self._say(f"{name}: its stored result is damaged ({fault}); computed again")

    def started(self, name: str) -> None:
        """Add a bar for the task."""
        self.bars[name] = self.progress.add_task(name, total=1.0)

    def progressed(self, name: str, fraction: float) -> None:
        """Move the task's bar."""
        self.progress.update(self.bars[name], completed=min(max(fraction, 0.0), 1.0))

    def finished(self, name: str, entry: Entry, reused: bool) -> None:
        """Fill the task's bar and count it."""
        self.count += 1
        self.reused += reused
        if name in self.bars:
            self.progress.update(self.bars[name], completed=1.0)
        self.progress.update(self.whole, completed=float(self.count))
        if not self.console.is_terminal:
            how = "reused" if reused else f"computed in {entry.wall_s:.1f} s"
            self.console.print(f"[{self.count}/{self.total}] {name}: {how}", markup=False, highlight=False)

    def restarted(self, name: str, reason: str) -> None:
        """Say so; the task's bar starts anew."""
        self._drop(name)
        self._say(f"{name}: {reason}; started again")

    def failed(self, name: str, message: str) -> None:
        """Say so; the whole message comes at the end."""
        self._drop(name)
        self._say(f"{name}: failed; what does not need it goes on")

    def _drop(self, name: str) -> None:
        if name in self.bars:
            self.progress.remove_task(self.bars.pop(name))

    def _say(self, text: str) -> None:
        self.console.print(text, markup=False, highlight=False)
