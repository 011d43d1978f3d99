"""Who hears of a run, and who computes for it: what the runner asks of both.

Verified by tests/unit/test_workbench_runner.py.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

from workbench.execution.jobs import Job, Message
from workbench.execution.store import Entry

__all__ = ["Listener", "Teller", "Workers"]


class Listener(Protocol):
    """Hears what happens to tasks; the command line shows it."""

    def damaged(self, name: str, fault: str) -> None:
        """The stored result of the task is damaged, in these words; it will be computed again."""

    def warned(self, warning: str) -> None:
        """Something about the whole run, before its first task."""

    def started(self, name: str) -> None:
        """The task began to run."""

    def progressed(self, name: str, fraction: float) -> None:
        """The task is this far, 0 to 1."""

    def finished(self, name: str, entry: Entry, reused: bool) -> None:
        """The result is in the store, computed now or found there."""

    def elsewhere(self, name: str) -> None:
        """Nothing is left to do but to wait for this task, which another run on the same store computes now."""

    def restarted(self, name: str, reason: str) -> None:
        """The task's worker died; the task will run again, from its last checkpoint if it keeps one."""

    def failed(self, name: str, message: str) -> None:
        """The task failed; those that do not need it go on."""


class Teller(ABC):
    """Base of a ``Listener`` that tells in sentences; to whom, each says."""

    @abstractmethod
    def say(self, sentence: str, *, warning: bool = False) -> None:
        """Tell a sentence; ``warning`` where something is not as it should be."""

    def damaged(self, name: str, fault: str) -> None:
        """Warn of it."""
        self.say(f"{name}: its stored result is damaged ({fault}); computed again", warning=True)

    def elsewhere(self, name: str) -> None:
        """Say so."""
        self.say(f"{name}: another run computes it now; waiting for its result")

    def restarted(self, name: str, reason: str) -> None:
        """Warn of it."""
        self.say(f"{name}: {reason}; started again", warning=True)


class Workers(Protocol):
    """Whoever computes: processes of this machine, or a cluster."""

    log: Path

    @property
    def free(self) -> int:
        """How many more jobs can start now."""

    def start(self, job: Job) -> None:
        """Start a job."""

    def wait(self) -> Sequence[tuple[str, Message]]:
        """Block until there is news: task names and messages."""

    def stop(self) -> None:
        """End everything that still runs."""
