"""``workbench view``: a local page on a report's folder.

Verified by tests/end_to_end/test_view.py.
"""

from __future__ import annotations

import sys
from pathlib import Path

from workbench.viewer.folder import read_folder

__all__ = ["run_view"]


def run_view(folder: Path, port: int, *, open_browser: bool) -> int:
    """Serve the page until Ctrl-C; raises InputError for a folder without results, a bad file or a port in use."""
    found = read_folder(folder)
    for name in found.left_out:
        sys.stderr.write(f"workbench: warning: {name} is left out: it leads out of the folder, or is no file\n")
    from workbench.viewer.results import Results
    from workbench.viewer.server import serve

    serve(Results(found), port, open_browser=open_browser)
    return 0
