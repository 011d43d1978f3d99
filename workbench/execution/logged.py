"""Tells Python's ``logging`` what happens to tasks: for those who call us from Python, where no terminal is ours.

``logging.basicConfig(level="INFO")`` shows every task as it begins and ends; without it, warnings alone are shown.
Verified by tests/unit/test_workbench_api.py.
"""

from __future__ import annotations

import logging

from workbench.execution.store import Entry

__all__ = ["Logged"]

_LOG = logging.getLogger("workbench")


class Logged:
    """A ``Listener`` that writes to the logger ``workbench``."""

    def damaged(self, name: str, fault: str) -> None:
        """Warn of it."""
        _LOG.warning("%s: its stored result is damaged (%s); computed again", name, fault)

    def warned(self, warning: str) -> None:
        """Warn of it."""
        _LOG.warning("%s", warning)

    def started(self, name: str) -> None:
        """Say so."""
        _LOG.info("%s: started", name)

    def progressed(self, name: str, fraction: float) -> None:
        """Say so to those who want every detail."""
        _LOG.debug("%s: %.0f %%", name, 100.0 * fraction)

    def finished(self, name: str, entry: Entry, reused: bool) -> None:
        """Say so."""
        _LOG.info("%s: %s", name, "reused" if reused else f"computed in {entry.wall_s:.1f} s")

    def elsewhere(self, name: str) -> None:
        """Say so."""
        _LOG.info("%s: another run computes it now; waiting for its result", name)

    def restarted(self, name: str, reason: str) -> None:
        """Warn of it."""
        _LOG.warning("%s: %s; started again", name, reason)

    def failed(self, name: str, message: str) -> None:
        """Say so; the error that is raised at the end says it to everybody."""
        _LOG.info("%s: failed", name)
