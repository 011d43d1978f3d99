"""Texts of users (titles, names, labels, sources, paths) as each output needs them: one escape for each, all here.

A text is text: no output takes a part of it for a command, markup or a formula. One rule holds for what cannot be seen:
white space of any kind is a space, so that a text is one line; every other control character, what overrides the
direction of writing, and halves of characters (bytes of a file name that are no UTF-8) are shown as escapes, such as
``\\x1b`` or ``\\u202e``. No language's letters are refused or changed. Verified by tests/unit/test_text.py.
"""

from __future__ import annotations

import re
from html import escape, unescape

__all__ = [
    "cell_text",
    "comment_text",
    "for_cell",
    "for_comment",
    "for_html",
    "for_json",
    "for_markdown",
    "for_matplotlib",
    "for_plotly",
    "for_script",
    "for_terminal",
    "one_line",
    "plain_of_html",
]

_SPACES = re.compile("\r\n|[\t\n\v\f\r\x1c-\x1f\x85\u2028\u2029]")
_HIDDEN = re.compile("[\x00-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff\ufeff\ufffe\uffff]")
_COMMAND = re.compile(r"(?:(?<=\s)|^):(?=:)|#(?=#\[)")
_MARKDOWN = re.compile(r"[\\`*_\[\]<>|~$&#]")
_FORMULA = re.compile(r"['\s]*[=+\-@]")
_FORMULA_IN_A_COMMENT = re.compile(r"(?<=[,;])(?=['\s]*[=+\-@])")
_KEPT_IN_A_COMMENT = re.compile(r"(?<=[,;])'(?=['\s]*[=+\-@])")


def one_line(text: str) -> str:
    """The text in one line without anything that hides or acts; what every title, name, label and source becomes."""
    return _shown(_SPACES.sub(" ", text))


def for_terminal(text: str) -> str:
    """For terminals and logs: one line; ``::`` at the start of a word and ``##[`` command no CI service."""
    return _COMMAND.sub(lambda found: f"\\x{ord(found[0]):02x}", one_line(text))


def for_html(text: str) -> str:
    """For HTML, between tags and in quoted attributes, and for XML; templates of Jinja2 escape by themselves."""
    return escape(one_line(text))


def for_plotly(text: str) -> str:
    """For names, titles and notes of Plotly, which takes tags for markup."""
    return escape(one_line(text), quote=False)


def for_matplotlib(text: str) -> str:
    """For texts of matplotlib: dollars are no formulas, and a name with an underscore in front is in the legend."""
    shown = one_line(text).replace("$", r"\$")
    return f" {shown}" if shown.startswith("_") else shown


def for_json(text: str) -> str:
    """JSON text in which what cannot be seen or encoded is written as JSON's own escape; its value stays."""
    return re.sub(f"(?![\r\n\t]){_HIDDEN.pattern}|[\u2028\u2029]", lambda found: f"\\u{ord(found[0]):04x}", text)


def for_script(text: str) -> str:
    """JSON text inside a ``script`` element: nothing in it can end the element or begin a comment; its value stays."""
    return for_json(text).replace("<", "\\u003c")


def for_markdown(text: str) -> str:
    """For Markdown as GitHub and GitLab read it, in a paragraph or a cell of a table."""
    return _MARKDOWN.sub(r"\\\g<0>", one_line(text))


def for_cell(text: str) -> str:
    """A cell of a CSV: an apostrophe before what a spreadsheet would take for a formula; numbers stay numbers."""
    shown = one_line(text)
    return f"'{shown}" if _FORMULA.match(shown) and not _is_number(shown) else shown


def cell_text(cell: str) -> str:
    """What `for_cell` was given, from the cell."""
    return cell[1:] if cell.startswith("'") and _FORMULA.match(cell, 1) else cell


def for_comment(text: str) -> str:
    """A comment line of a CSV, of which a spreadsheet makes cells at commas and semicolons, as `for_cell`."""
    return _FORMULA_IN_A_COMMENT.sub("'", one_line(text))


def comment_text(line: str) -> str:
    """What `for_comment` was given, from the line."""
    return _KEPT_IN_A_COMMENT.sub("", line)


def plain_of_html(text: str) -> str:
    """What a reader sees of `for_plotly`'s text, tags of our own left out."""
    return unescape(re.sub(r"<[^>]*>", "", text))


def _shown(text: str) -> str:
    return _HIDDEN.sub(lambda found: _escape(ord(found[0])), text)


def _escape(number: int) -> str:
    return f"\\x{number:02x}" if number < 0x100 else f"\\u{number:04x}"


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
