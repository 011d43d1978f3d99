"""Tables on paper: a sentence across columns takes no width from the others, and no header stands alone."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest

from workbench.charts.still_charts import blank_figure
from workbench.report import pdf
from workbench.report.document import read_html
from workbench.report.pdf import set_document

pytestmark = pytest.mark.skipif(shutil.which("pdftotext") is None, reason="no pdftotext on PATH")
SENTENCE = "a tire folds at t = 20.3 s: plate 12 of the left one is turned inside out, and the run cannot go on there"
HEAD = "<thead><tr>" + "".join(f"<th>{name}</th>" for name in ("Requirement", "Quantity", "Fitted", "Brush", "Verdict"))
ROWS = """<tr><td>slope of 25 degrees, upwards</td><td>smallest load on a wheel</td><td class="n">47.92 N</td>
<td class="n">29.79 N</td><td>met</td></tr>"""
FOLDED = f'<tr><td>step of 0.25 m</td><td colspan="3">{SENTENCE}</td><td>not met</td></tr>'


def placed(table: str, folder: Path) -> list[tuple[int, str, float, float]]:
    """Page, word, left edge and top [pt] of every word of a document with one table, from the contents on."""
    blank_figure(1.0, 1.0).savefig(folder / "lead.svg")
    content: Mapping[str, object] = {
        **dict.fromkeys(("study", "created", "word", "verdict"), ""),
        **{name: [] for name in ("answers", "counts", "ratings", "band", "outside", "warnings")},
        "title": "T",
        "tone": "pass",
        "lead": "lead.svg",
        "groups": [{"title": "G", "nodes": read_html(f"<h2>Before</h2><table>{table}</table>").nodes}],
    }
    (folder / "one.pdf").write_bytes(set_document(content, folder))
    run = subprocess.run(["pdftotext", "-bbox", folder / "one.pdf", "-"], capture_output=True, text=True, check=True)
    found = []
    for number, page in enumerate(run.stdout.split("<page ")[2:]):
        for left, top, word in re.findall(r'<word xMin="([\d.]+)" yMin="([\d.]+)"[^>]*>([^<]*)<', page):
            found.append((number, word, float(left), float(top)))
    return found


def lines_of(words: Sequence[str], found: Sequence[tuple[int, str, float, float]]) -> int:
    """On how many lines these words stand."""
    return len({round(top) for _, word, _, top in found if word in words})


def test_a_sentence_across_columns_leaves_the_others_their_width(tmp_path: Path) -> None:
    found = placed(f"{HEAD}</tr></thead><tbody>{ROWS}{FOLDED}</tbody>", tmp_path)
    assert lines_of(("degrees,", "upwards"), found) == 1
    assert lines_of(("smallest", "load", "wheel"), found) == 1
    assert {"folds", "20.3", "inside"} <= {word for _, word, _, _ in found}


def test_control_by_the_longest_cell_alone_the_words_are_squeezed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = pdf._TEMPLATE.read_text(encoding="utf-8")
    assert "if sentence {" in text
    (tmp_path / "damaged.typ").write_text(text.replace("if sentence {", "if false {"), encoding="utf-8")
    monkeypatch.setattr(pdf, "_TEMPLATE", tmp_path / "damaged.typ")
    found = placed(f"{HEAD}</tr></thead><tbody>{ROWS}{FOLDED}</tbody>", tmp_path)
    assert max(lines_of(("degrees,", "upwards"), found), lines_of(("smallest", "load", "wheel"), found)) > 1


def test_a_header_is_repeated_and_never_alone(tmp_path: Path) -> None:
    """Each page with the header has a row below it."""
    found = placed(f"{HEAD}</tr></thead><tbody>{90 * ROWS}</tbody>", tmp_path)
    pages = {number for number, word, _, _ in found if word == "Requirement"}
    assert len(pages) > 1
    for page in pages:
        (header,) = [top for number, word, _, top in found if (number, word) == (page, "Requirement")]
        assert any(number == page and word == "upwards" and top > header for number, word, _, top in found)
