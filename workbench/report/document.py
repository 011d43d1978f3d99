"""The page's sections as a tree of words, tables and figures, from which a document is set.

Read from the rendered HTML, so that page and document cannot say different things. Verified by
tests/unit/test_workbench_document.py.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from html.parser import HTMLParser
from typing import Any

__all__ = ["Tree", "read_html"]

type Node = str | dict[str, Any]

_DROPPED = ("iframe", "input", "button", "label", "svg", "nav", "style", "noscript")
_LEFT_OUT = {"screen", "aside"}
"""Classes of what is done with a pointer, and of long tables that the page keeps folded."""
_VOID = ("br", "img", "input", "wbr", "meta", "hr", "col")
_CLEAR = ("span", "div", "section", "tbody", "header", "main", "col", "colgroup")
"""Tags that only group; their content stands for them, unless their class has a meaning."""
_MEANING = ("pair", "chip", "plot", "scene", "soft", "caption", "inferred", "verdict", "eyebrow")

_WORDS = (
    "h2",
    "h3",
    "h4",
    "p",
    "ul",
    "ol",
    "li",
    "dl",
    "dt",
    "dd",
    "caption",
    "figcaption",
    "inferred",
    "summary",
    "details",
)
_TABLES = ("table", "thead", "tr", "td", "th")
_BLOCKS = frozenset((*_WORDS, *_TABLES, "figure", "plot", "scene", "img", "pair", "part"))


@dataclass(slots=True, kw_only=True)
class Tree:
    """What was read.

    Attributes
    ----------
    nodes : text, or a dict with ``t`` (tag, or one of the classes that mean something), ``c`` (children) and, by tag,
        ``name`` (of a figure), ``src`` (of a picture), ``n`` (a number's cell), ``across`` and ``down`` (spans),
        ``shares`` (of a table: widths of its columns)
    figures : name -> Plotly's data and layout
    """

    nodes: list[Node]
    figures: dict[str, Mapping[str, Any]] = field(default_factory=dict)


def read_html(text: str) -> Tree:
    """Read a piece of the page; scripts with numbers become figures, what only a screen needs is dropped."""
    reader = _Reader()
    reader.feed(text)
    reader.close()
    return Tree(nodes=_tidy(reader.stack[0][1]), figures=reader.figures)


class _Reader(HTMLParser):
    """Builds the tree; an unknown tag is clear."""

    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.stack: list[tuple[dict[str, Any], list[Node]]] = [({}, [])]
        self.figures: dict[str, Mapping[str, Any]] = {}
        self.script: str | None = None
        self.dropped = 0

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        if self.dropped or tag in _DROPPED or _LEFT_OUT & set(given.get("class", "").split()):
            self.dropped += tag not in _VOID
            return
        if tag == "script":
            self.script = given.get("data-for", "") if "json" in given.get("type", "") else ""
            return
        node = _node(tag, given)
        if tag == "div" and not node["t"] and self.stack[-1][0].get("t") == "pair":
            node["t"] = "part"
        if tag in _VOID:
            if tag in ("br", "img"):
                self.stack[-1][1].append(node)
            return
        self.stack.append((node, []))

    def handle_endtag(self, tag: str) -> None:
        if self.dropped:
            self.dropped -= tag not in _VOID
        elif tag == "script":
            self.script = None
        elif tag not in _VOID and len(self.stack) > 1:
            node, children = self.stack.pop()
            self.stack[-1][1].extend([node | {"c": _tidy(children)}] if node["t"] else children)

    def handle_data(self, data: str) -> None:
        if self.script:
            self.figures[self.script] = json.loads(data)
        elif self.script is None and not self.dropped:
            self.stack[-1][1].append(re.sub(r"\s+", " ", data))


def _node(tag: str, given: Mapping[str, str]) -> dict[str, Any]:
    """Tag and what of its attributes a document needs; ``t`` is empty for a clear tag."""
    classes = given.get("class", "").split()
    meaning = next((name for name in _MEANING if name in classes), "")
    node: dict[str, Any] = {"t": meaning if tag in (*_CLEAR, "p") and meaning else "" if tag in _CLEAR else tag}
    if "chip" in classes or "verdict" in classes:
        node["tone"] = (
            "warn"
            if {"finding", "fail"} <= set(classes) or {"error", "undecided"} & set(classes)
            else "fail"
            if "fail" in classes
            else "pass"
        )
    if tag in ("td", "th"):
        node |= {"n": "n" in classes, "across": int(given.get("colspan", 1)), "down": int(given.get("rowspan", 1))}
    if "data-shares" in given:
        node["shares"] = [float(part) for part in given["data-shares"].split()]
    if tag == "img":
        node["src"] = given.get("src", "")
    if meaning in ("plot", "scene"):
        node["name"] = given.get("id", "")
    return node


def _tidy(children: list[Node]) -> list[Node]:
    """Neighbouring texts as one; none where there is only space beside a block."""
    found: list[Node] = []
    for child in children:
        if isinstance(child, str) and found and isinstance(found[-1], str):
            found[-1] = re.sub(r" +", " ", found[-1] + child)
        else:
            found.append(child)
    beside = [{"", *(_kind(n) for n in found[max(k - 1, 0) : k + 2])} & _BLOCKS for k in range(len(found))]
    return [n for n, blocks in zip(found, beside, strict=True) if not (isinstance(n, str) and not n.strip() and blocks)]


def _kind(node: Node) -> str:
    return "" if isinstance(node, str) else str(node["t"])
