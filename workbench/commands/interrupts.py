"""Ctrl-C where it can do no harm: not while numba or LLVM is at work.

A KeyboardInterrupt that arises in Python code which compiled code has called is lost there, or leaves half a function
behind: a crash, or an error that names the wrong cause. It is then put off until that code has returned.

Verified by tests/unit/test_interrupts.py and tests/end_to_end/test_interrupt.py.
"""

from __future__ import annotations

import signal
from collections.abc import Iterator
from pathlib import PurePath
from types import FrameType

__all__ = ["delicate", "interrupt_safely"]

_DELICATE = frozenset(("numba", "llvmlite"))
_AGAIN = 0.02
"""After this time a Ctrl-C that was put off is tried again [s]."""


def interrupt_safely() -> None:
    """From now on SIGINT raises KeyboardInterrupt as soon as no compiler is at work; SIGALRM is used for that."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGALRM, _interrupt)
        signal.signal(signal.SIGINT, _interrupt)


def _interrupt(signum: int, frame: FrameType | None) -> None:
    if delicate(frame):
        signal.setitimer(signal.ITIMER_REAL, _AGAIN)
        return
    raise KeyboardInterrupt


def delicate(frame: FrameType | None) -> bool:
    """Whether this frame, or one that called it, belongs to a compiler."""
    return any(not _DELICATE.isdisjoint(PurePath(f.f_code.co_filename).parts) for f in _callers(frame))


def _callers(frame: FrameType | None) -> Iterator[FrameType]:
    while frame is not None:
        yield frame
        frame = frame.f_back
