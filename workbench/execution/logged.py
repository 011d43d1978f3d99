"""Tells Python's ``logging`` what happens to tasks: for those who call us from Python, where no terminal is ours.

``logging.basicConfig(level="INFO")`` shows every task as it begins and ends; without it, warnings alone are shown.
Verified by tests/unit/test_workbench_api.py.
"""

from __future__ import annotations

import logging

from workbench.execution.listening import Teller
from workbench.execution.store import Entry

__all__ = ["Logged"]

_LOG = logging.getLogger("workbench")


class Logged(Teller):
    """A ``Listener`` that writes to the logger ``workbench``."""

    def say(self, sentence: str, *, warning: bool = False) -> None:
        """To the log."""
        _LOG.log(logging.WARNING if warning else logging.INFO, "%s", sentence)

    def warned(self, warning: str) -> None:
        """Warn of it."""
        self.say(warning, warning=True)

    def started(self, name: str) -> None:
        """Say so."""
        self.say(f"{name}: started")

    def progressed(self, name: str, fraction: float) -> None:
        """Say so to those who want every detail."""
        _LOG.debug("%s: %.0f %%", name, 100.0 * fraction)

    def finished(self, name: str, entry: Entry, reused: bool) -> None:
        """Say so."""
        self.say(f"{name}: {'reused' if reused else f'computed in {entry.wall_s:.1f} s'}")

    def failed(self, name: str, message: str) -> None:
        """Say so; the error that is raised at the end says it to everybody."""
        self.say(f"{name}: failed")
