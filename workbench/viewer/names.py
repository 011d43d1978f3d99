"""Names from a folder or a browser as text: what cannot be seen is written out, and no two are alike.

Verified by tests/unit/test_viewer_folder.py.
"""

from __future__ import annotations

import html
from collections.abc import Iterable
from pathlib import Path

__all__ = ["chart_text", "named_apart", "plain"]

_LONGEST = 60
"""Characters of a name in a chart."""


def plain(name: str) -> str:
    """One line that can be printed and sent: escapes for control characters, turned writing and broken UTF-8."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in name)


def named_apart(paths: Iterable[Path]) -> dict[str, Path]:
    """Files by their plain names without endings; a number is added to the second of two alike."""
    found: dict[str, Path] = {}
    for path in paths:
        name, number = plain(path.stem), 1
        while (key := name if number == 1 else f"{name} ({number})") in found:
            number += 1
        found[key] = path
    return found


def chart_text(text: str) -> str:
    """For Plotly, which takes some of HTML's tags in names and titles for its own; the middle of a long one is cut."""
    short = text if len(text) <= _LONGEST else f"{text[: _LONGEST // 2]}…{text[1 - _LONGEST // 2 :]}"
    return html.escape(short, quote=False)
