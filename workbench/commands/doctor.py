"""``workbench doctor``: what is installed, what works, what is missing.

Verified by tests/end_to_end/test_commands.py.
"""

from __future__ import annotations

from workbench.execution.doctor import Examination, examine, install
from workbench.execution.load_checks import install_command
from workbench.execution.terminal import Terminal, console, empty_table

__all__ = ["run_doctor"]


def run_doctor(*, mend: bool = False) -> int:
    """Show what was found; 2 if something is missing. With ``mend``, install the system's packages and look again."""
    console.print("every library is loaded and used once, some seconds")
    found = examine()
    if mend and found.packages:
        install(found.packages)
        found = examine()
    _show(found, console)
    return 0 if found.well else 2


def _show(found: Examination, shown_on: Terminal) -> None:
    columns = ("name", "found", "needed for", "advice")
    table = empty_table("workbench doctor", columns, texts=columns, folded=columns)
    for finding in found.findings:
        cells = (finding.name, finding.found, finding.purpose, finding.advice or "ok")
        table.add_row(*cells)
    shown_on.print(table)
    if found.packages:
        shown_on.print(f"as root: {install_command(found.packages)}", soft_wrap=True)
