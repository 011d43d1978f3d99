"""The terminal as every command writes to it: a text is text, never Rich's markup, an emoji's name or a control code.

Verified by tests/unit/test_terminal.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rich.console import Console
from rich.status import Status
from rich.table import Table
from rich.text import Text

from contracts.text import for_terminal

__all__ = ["Terminal", "console", "empty_table"]


class Terminal(Console):
    """A console on which every string, also those in tables, titles and spinners, is shown as it is."""

    def __init__(self, **options: Any) -> None:
        super().__init__(markup=False, emoji=False, highlight=False, **options)

    def render_str(self, text: str, **options: Any) -> Text:
        """The string as it is shown, in one line."""
        return super().render_str(for_terminal(text), **(options | {"markup": False, "emoji": False}))

    def status(self, status: Any, **options: Any) -> Status:
        """A spinner beside the text, which Rich would read as markup."""
        return super().status(self.render_str(status) if isinstance(status, str) else status, **options)


console = Terminal()


def empty_table(title: str, columns: Sequence[str], *, texts: Sequence[str], folded: Sequence[str] = ()) -> Table:
    """A table without rows: columns of ``texts`` on the left, numbers on the right; what is ``folded`` is never cut."""
    table = Table(title=title, title_justify="left")
    for name in columns:
        table.add_column(
            name, justify="left" if name in texts else "right", overflow="fold" if name in folded else "ellipsis"
        )
    return table
