"""``workbench doctor``: what is installed and what is missing.

Verified by tests/end_to_end/test_commands.py.
"""

from __future__ import annotations

from rich.table import Table

from workbench.commands.computing import console

__all__ = ["run_doctor"]


def run_doctor() -> int:
    """Show what is installed; 2 if something is missing."""
    from workbench.execution.doctor import examine

    findings = examine()
    table = Table(title="workbench doctor", title_justify="left")
    for column in ("name", "found", "needed for", "advice"):
        table.add_column(column, overflow="fold")
    for finding in findings:
        table.add_row(finding.name, finding.found, finding.purpose, finding.advice or "ok")
    console.print(table)
    return 2 if any(f.advice for f in findings) else 0
