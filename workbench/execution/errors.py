"""Failure of a run, as opposed to a bad study: a branch of the project's one error tree."""

from __future__ import annotations

from contracts.errors import WorkbenchError

__all__ = ["DiskFullError", "InterruptedRunError", "RunError"]


class RunError(WorkbenchError):
    """A task failed, a worker was killed, or the user interrupted the run; finished results are kept."""


class InterruptedRunError(RunError):
    """The user interrupted the run: nothing is wrong with the study."""


class DiskFullError(RunError):
    """A disk is full: says which, and what to try."""
