"""The report as a document: ``report.pdf``, set from the report's sections by Typst, which no other module imports.

Nothing is fetched: fonts are Typst's own and matplotlib's DejaVu. Verified by tests/end_to_end/test_report_pdf.py.
"""

from __future__ import annotations

import base64
import io
import json
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import typst
from PIL import Image

from workbench.charts.printed import draw
from workbench.charts.still_charts import font_folder
from workbench.questions.models.agreement import Agreement
from workbench.report.answers import Answer
from workbench.report.contents import REPORT
from workbench.report.document import Node, Tree, read_html
from workbench.report.opening import Opening
from workbench.report.page import Rendered

__all__ = ["document_pdf", "set_document", "with_pictures"]

_TEMPLATE = Path(__file__).parent / "templates" / "report.typ"
_LEAD = "model-curves"
_DECISION_TONES = {"yes": "pass", "no": "fail", "undecided": "warn"}


def document_pdf(rendered: Rendered) -> bytes:
    """The document; every figure as vectors, every scene as its still."""
    values = rendered.values
    trees = {name: read_html(text) for name, text in rendered.sections[REPORT].items()}
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        lead = read_html(values["figures"]["models"])
        draw(lead.figures[_LEAD], folder / "lead.svg", whole_width=True)
        pictured = {name: with_pictures(tree, folder) for name, tree in trees.items()}
        groups = [
            {"title": g.title, "nodes": [node for s in g.sections for node in pictured[s.name]]}
            for g in rendered.groups[REPORT]
        ]
        content = _first_page(values["opening"]) | {
            "title": values["study"].title,
            "study": values["study"].name,
            "created": values["provenance"]["created"][:16].replace("T", " ") + " UTC",
            "lead": "lead.svg",
            "groups": groups,
        }
        return set_document(content, folder)


def set_document(content: Mapping[str, Any], folder: Path) -> bytes:
    """What `content` holds, set by the template; ``folder`` has the files of its figures and pictures."""
    (folder / "document.json").write_text(json.dumps(content, allow_nan=False), encoding="utf-8")
    (folder / "report.typ").write_text(_TEMPLATE.read_text(encoding="utf-8"), encoding="utf-8")
    fonts = [str(font_folder())]
    made = typst.compile(str(folder / "report.typ"), root=str(folder), font_paths=fonts, ignore_system_fonts=True)
    assert isinstance(made, bytes)
    return made


def with_pictures(tree: Tree, folder: Path) -> list[Node]:
    """Its nodes, each figure and picture with the file it was written to in ``folder``."""
    return [_placed(node, tree, folder, whole_width=True) for node in tree.nodes]


def _placed(node: Node, tree: Tree, folder: Path, *, whole_width: bool) -> Node:
    if isinstance(node, str):
        return node
    narrow = node["t"] == "pair"
    placed = dict(node)
    placed["c"] = [_placed(c, tree, folder, whole_width=whole_width and not narrow) for c in node.get("c", ())]
    if node["t"] == "plot" and node["name"] in tree.figures:
        placed["file"] = f"{node['name']}.svg"
        draw(tree.figures[node["name"]], folder / placed["file"], whole_width=whole_width)
    elif node["t"] == "img":
        placed["file"] = _picture(node["src"], folder)
    elif node["t"] == "plot":
        placed["file"] = ""
    return placed


def _picture(link: str, folder: Path) -> str:
    """A ``data:`` link as a PNG file's name; empty where there is none."""
    if not link.startswith("data:image/"):
        return ""
    name = f"picture{len(list(folder.glob('picture*')))}.png"
    with Image.open(io.BytesIO(base64.b64decode(link.partition(",")[2]))) as picture:
        picture.save(folder / name)
    return name


def _first_page(found: Opening) -> dict[str, Any]:
    """What stands before the contents, in words."""
    told = found.answers
    return {
        "answers": [_answer(one) for one in (told.computation, told.wheel, told.stand_in)],
        "verdict": found.verdict,
        "warnings": list(found.warnings),
        "counts": [{"words": _counted(*row), "tone": _tone(row[0], row[1])} for row in found.counts],
        "ratings": [
            {"name": m.name, "distance": _known_to(m.found), "words": m.words, "tone": _DECISION_TONES[m.decision]}
            for m in told.models
        ]
        + [{"name": r.name, "distance": _known_to(r.found), "words": r.words, "tone": "warn"} for r in found.ratings],
        "outside": [{"title": o.check.title, "value": f"{o.value} ({o.check.tolerance})"} for o in found.outside],
    }


def _answer(one: Answer) -> dict[str, Any]:
    parts = [{"name": p.name, "text": p.text, "tone": _DECISION_TONES[p.decision]} for p in one.parts]
    return {
        "question": one.question,
        "word": {"yes": "Yes", "no": "No", "undecided": "Not decided"}[one.decision],
        "tone": _DECISION_TONES[one.decision],
        "sentence": one.sentence,
        "parts": parts,
    }


def _known_to(found: Agreement) -> str:
    more = "" if found.uncertainty is None else f" ± {100 * found.uncertainty:.1f} %"
    return f"{100 * found.distance:.1f} %{more}"


def _tone(role: str, status: str) -> str:
    return "pass" if status == "pass" else "fail" if role == "gate" and status == "fail" else "warn"


def _counted(role: str, status: str, number: int) -> str:
    states = {"error": "not evaluated", "undecided": "undecided"}
    state = (
        states.get(status)
        or {
            ("gate", "pass"): "passed",
            ("gate", "fail"): "failed",
            ("finding", "pass"): "inside limits",
            ("finding", "fail"): "outside limits",
        }[role, status]
    )
    return f"{number} {role}{'s' if number != 1 else ''} {state}"
