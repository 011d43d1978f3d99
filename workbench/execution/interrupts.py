"""Ctrl-C: it ends a command at any time, in one line and with exit status 2, and is never lost.

A KeyboardInterrupt can be lost where compiled code calls Python: in a callback, while a library is loaded, or while
numba or LLVM is at work, where it leaves half a function behind besides. So it is put off where it does harm; and once
raised it is raised again, every few hundredths of a second (SIGALRM), until it is on its way: being handled by an
``except`` or a ``finally`` of the main thread.

Verified by tests/unit/test_interrupts.py and tests/end_to_end/test_interrupt.py.
"""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import PurePath
from types import FrameType
from typing import Any

__all__ = ["came", "delicate", "hear_no_more", "interrupt_safely", "put_off"]

_DELICATE = frozenset(("numba", "llvmlite"))
_AGAIN = 0.02
"""After this time a Ctrl-C that was put off, or may be lost, is tried again [s]."""


@dataclass(slots=True, kw_only=True)
class _State:
    """Whether Ctrl-C is heard here, whether it came, and how many put it off."""

    heard: bool = False
    came: bool = False
    put_off: int = 0


_STATE = _State()


def interrupt_safely() -> None:
    """From now on SIGINT, unless it is ignored, raises KeyboardInterrupt where it does no harm; takes SIGALRM, too."""
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        _STATE.heard = True
        sys.unraisablehook = _unraisable
        signal.signal(signal.SIGALRM, _interrupt)
        signal.signal(signal.SIGINT, _interrupt)


def hear_no_more() -> None:
    """From now on SIGINT does nothing, if it was heard here: the command has ended and says its last word."""
    if _STATE.heard:
        _STATE.put_off += 1
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        signal.setitimer(signal.ITIMER_REAL, 0.0)


def came() -> bool:
    """Whether Ctrl-C came, so that an error may be what it left of a library it was lost in."""
    return _STATE.came


@contextmanager
def put_off() -> Iterator[None]:
    """Hear Ctrl-C now, raise KeyboardInterrupt afterwards."""
    _STATE.put_off += 1
    try:
        yield
    finally:
        _STATE.put_off -= 1


def delicate(frame: FrameType | None) -> bool:
    """Whether this frame, or one that called it, belongs to a compiler."""
    return any(not _DELICATE.isdisjoint(PurePath(f.f_code.co_filename).parts) for f in _callers(frame))


def _interrupt(signum: int, frame: FrameType | None) -> None:
    _STATE.came = True
    signal.setitimer(signal.ITIMER_REAL, _AGAIN)
    if not (_STATE.put_off or delicate(frame) or _on_its_way()):
        raise KeyboardInterrupt


def _on_its_way() -> bool:
    """Whether the main thread handles a KeyboardInterrupt now, or an error that arose while it did."""
    error = sys.exception()
    while error is not None and not isinstance(error, KeyboardInterrupt):
        error = error.__context__
    return error is not None


def _unraisable(lost: Any) -> None:
    """Say nothing of a KeyboardInterrupt that compiled code could not pass on: it comes again."""
    if not isinstance(lost.exc_value, KeyboardInterrupt):
        sys.__unraisablehook__(lost)


def _callers(frame: FrameType | None) -> Iterator[FrameType]:
    while frame is not None:
        yield frame
        frame = frame.f_back
