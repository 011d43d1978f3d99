"""What a command says on the terminal is its own: libraries' warnings and logs are for those who mend the workbench.

With ``WORKBENCH_TRACEBACK`` set, or Python's own ``-W`` and ``PYTHONWARNINGS``, they are shown. Worker processes write
all they say into the store's logs. Verified by tests/end_to_end/test_quiet.py.
"""

from __future__ import annotations

import logging
import os
import sys
import warnings

__all__ = ["quieten"]


def quieten() -> None:
    """Let this process print our own lines alone, and letters its terminal does not have as escapes."""
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]
    if os.environ.get("WORKBENCH_TRACEBACK") or sys.warnoptions:
        return
    warnings.simplefilter("ignore")
    logging.getLogger().addHandler(logging.NullHandler())  # else Python prints what no handler takes
