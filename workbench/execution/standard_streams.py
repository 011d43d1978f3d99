"""The three standard streams and the terminal's width as a program may count on them, whoever started it and how.

A closed stream is opened on nothing, before any file can take its number; an error on one names it; a width that no
terminal has is forgotten. What a command says on the terminal is its own: libraries' warnings and logs are for those
who mend the workbench. With ``WORKBENCH_TRACEBACK`` set, or Python's own ``-W`` and ``PYTHONWARNINGS``, they are shown.
Worker processes write all they say into the store's logs.

Verified by tests/end_to_end/test_closed_streams.py and tests/end_to_end/test_quiet.py.
"""

from __future__ import annotations

import io
import logging
import os
import sys
import warnings

__all__ = ["STANDARD_OUTPUT", "forget_odd_widths", "name_errors", "open_closed_streams", "quieten"]

STANDARD_OUTPUT = "standard output"
_WIDEST = 10_000
"""Columns; some tables are as wide as they may be."""


def open_closed_streams() -> None:
    """Open what is closed of stdin, stdout and stderr on nothing, for this process and those that it starts."""
    for number, mode in enumerate("rww"):
        try:
            os.fstat(number)
        except OSError:
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)  # the lowest number that is free: this one
        name = ("stdin", "stdout", "stderr")[number]
        if getattr(sys, name) is None:
            setattr(sys, name, open(number, mode, encoding="utf-8", closefd=False))  # noqa: SIM115  (until the end)


def name_errors() -> None:
    """Let an error on standard output say so, since Python's names no file."""
    old = sys.stdout
    if type(old) is not io.TextIOWrapper or old.fileno() != 1:
        return  # another's
    named = _Named(1, "w", closefd=False)
    buffer = named if isinstance(old.buffer, io.FileIO) else io.BufferedWriter(named)  # as with PYTHONUNBUFFERED
    sys.stdout = io.TextIOWrapper(
        buffer, old.encoding, old.errors, line_buffering=old.line_buffering, write_through=old.write_through
    )


class _Named(io.FileIO):
    """Standard output, named in its errors."""

    def write(self, data: object) -> int:
        """Write, as `io.FileIO`."""
        try:
            return super().write(data)  # type: ignore[arg-type]
        except OSError as error:
            raise OSError(error.errno, error.strerror, STANDARD_OUTPUT) from error


def forget_odd_widths() -> None:
    """Remove widths and heights from the environment that are no numbers, zero, negative or beyond every terminal."""
    for name in ("COLUMNS", "LINES", "TERMINAL_WIDTH"):
        text = os.environ.get(name, "1")
        if not (text.isascii() and text.isdigit() and 0 < int(text[:20]) <= _WIDEST):
            del os.environ[name]


def quieten() -> None:
    """Let this process print our own lines alone, and letters its terminal does not have as escapes."""
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]
    if os.environ.get("WORKBENCH_TRACEBACK") or sys.warnoptions:
        return
    warnings.simplefilter("ignore")
    logging.getLogger().addHandler(logging.NullHandler())  # else Python prints what no handler takes
