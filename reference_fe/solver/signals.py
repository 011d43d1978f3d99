"""PETSc leaves the process' signals alone.

Its own handlers end the process at the first broken connection (SIGPIPE), which Python turns into an exception, and
hide what Python says of a crash. Verified by tests/unit/test_fe_signals.py.
"""

from __future__ import annotations

import os
from collections.abc import MutableMapping

__all__ = ["leave_signals_alone"]

_OPTIONS, _OURS = "PETSC_OPTIONS", "-no_signal_handler"


def leave_signals_alone(environment: MutableMapping[str, str] = os.environ) -> None:
    """Set what PETSc reads at its start, before it is loaded; options of the user's stay."""
    options = environment.get(_OPTIONS, "").split()
    if _OURS not in options:
        environment[_OPTIONS] = " ".join([*options, _OURS])
