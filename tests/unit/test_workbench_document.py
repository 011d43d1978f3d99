"""The page read as a tree: nothing said is lost, nothing of the screen is kept."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from workbench.report.document import Node, read_html

PAGE = """
<section id="a"><h2>Title &amp; more</h2>
<p>Some <b>bold</b>
 words.</p>
<div class="pair"><div><h3>Left</h3><div class="plot" id="f"></div>
<script type="application/json" data-for="f">{"data": [], "layout": {}}</script></div>
<figure><img src="data:,"></figure></div>
<div class="scene" id="s"><div class="controls"></div><img src="data:x"></div><script type="text/plain">H4sI</script>
<p>Seen. <span class="screen">no: drag <b>it</b>.</span></p><div class="screen"><h3>no</h3><br></div>
<iframe srcdoc="<p>no</p>"></iframe><svg><text>no</text></svg>
<table><thead><tr><th>A</th></tr></thead><tbody><tr><td class="n" colspan="2">1</td></tr></tbody></table>
<span class="chip finding fail">△ outside</span></section>"""


def _words(nodes: list[Node]) -> str:
    return "".join(n if isinstance(n, str) else _words(n.get("c", [])) for n in nodes)


def _all(nodes: list[Node], tag: str) -> list[dict[str, Any]]:
    inner = [n for n in nodes if isinstance(n, dict)]
    return [n for n in inner if n["t"] == tag] + [m for n in inner for m in _all(n.get("c", []), tag)]


def test_words_are_kept_and_what_moves_is_not() -> None:
    tree = read_html(PAGE)
    assert "Some bold words." in _words(tree.nodes)
    assert "Title & more" in _words(tree.nodes)
    assert "Seen. " in _words(tree.nodes)
    assert "no" not in _words(tree.nodes).replace("not", "")
    assert "H4sI" not in _words(tree.nodes)
    assert tree.figures == {"f": {"data": [], "layout": {}}}


def test_blocks_have_no_spaces_between_them() -> None:
    assert not [n for n in read_html(PAGE).nodes if isinstance(n, str) and not n.strip()]


def test_pairs_pictures_cells_and_verdicts_are_told() -> None:
    nodes = read_html(PAGE).nodes
    (pair,) = _all(nodes, "pair")
    assert [c["t"] for c in pair["c"]] == ["part", "figure"]
    assert [n["name"] for n in _all(nodes, "plot") + _all(nodes, "scene")] == ["f", "s"]
    assert [n["src"] for n in _all(nodes, "img")] == ["data:,", "data:x"]
    (cell,) = _all(nodes, "td")
    assert (cell["n"], cell["across"], cell["down"]) == (True, 2, 1)
    assert [n["tone"] for n in _all(nodes, "chip")] == ["warn"]


def test_every_class_that_means_something_is_set() -> None:
    """The template knows each tag and class the tree may hold that is not simply its content."""
    template = (Path(__file__).parents[2] / "workbench" / "report" / "templates" / "report.typ").read_text("utf-8")
    for kind in (
        "pair",
        "chip",
        "plot",
        "img",
        "inferred",
        "caption",
        "table",
        "details",
        "summary",
        "dl",
        "ul",
        "code",
    ):
        assert f'"{kind}"' in template, kind
