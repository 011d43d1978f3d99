"""Every output's escape gives its reader back the text that was put in, and nothing that acts.

Claim: for each of the texts below, what a parser of the output reads is the text in one line, and no element, no
formula, no command is found beside it. Source: HTML Living Standard, XML 1.0 section 2.2, CommonMark with GitHub's
tables, OWASP's list of CSV injections, GitHub's workflow commands. Negative control: without the escape, each parser
finds what the text was made to do.
"""

from __future__ import annotations

import csv
import io
import json
import re
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import pytest
from markdown_it import MarkdownIt

from contracts.csv_table import TableRule, read_table, table_text
from contracts.curves import StiffnessCurve, read_curve, write_curve
from contracts.text import (
    cell_text,
    comment_text,
    for_cell,
    for_comment,
    for_html,
    for_json,
    for_markdown,
    for_matplotlib,
    for_plotly,
    for_script,
    for_terminal,
    one_line,
    plain_of_html,
)

NASTY = {
    "markup of the terminal": "[red]a[/red] [/] [bold :warning:",
    "a script": "<script>window.pwned = 1</script>",
    "the end of a script": "</script><!--<script>",
    "an image": '"><img src=x onerror="window.pwned = 1">',
    "entities": "&lt;b&gt; &amp; a & b",
    "quotes": 'it\'s "so" `called`',
    "Markdown": "| *a* _b_ [c](d) ![e](f) ~~g~~ <details> # h",
    "a formula of TeX": r"$\frac{1$ a_b $$ \$",
    "a template": "{{ 7 * 7 }} {% include 'x' %} ${title} $title %s",
    "Typst": '#import "x" $x$ @ref <label> */ // #eval',
    "a formula": "=1+1",
    "a call": "@SUM(1)*cmd|' /C calc'!A0",
    "a sum": "+1+1",
    "a difference": "-2+3",
    "a formula after a comma": "a,=1+1;-cmd, '@x",
    "an apostrophe": "'=1+1",
    "a command of a CI service": "::error::gone ##[error]gone",
    "Chinese and emoji": "轮子 🛞 👩‍🚀 Ünïcödé",
    "Arabic and Hebrew": "عجلة גלגל",
    "an underscore in front": "_hidden",
    "very long": "long " * 400 + "end",
}
"""What it tries -> a text in one line."""
HIDDEN = {
    "\x1b[31mred\x1b[0m": r"\x1b[31mred\x1b[0m",
    "a\nb\r\nc\td\u2028e": "a b c d e",
    "a\x00b\x07c\x7fd\x9be": r"a\x00b\x07c\x7fd\x9be",
    "a\u202egnp.exe\u2066": r"a\u202egnp.exe\u2066",
    "bytes \udcff": r"bytes \udcff",
    "a\ufffeb": r"a\ufffeb",
}
"""What cannot be seen -> how it is shown."""
each = pytest.mark.parametrize("text", NASTY.values(), ids=list(NASTY))


class _Read(HTMLParser):
    """Text and tags of a piece of HTML."""

    def __init__(self, source: str) -> None:
        super().__init__(convert_charrefs=True)
        self.text, self.tags = "", list[str]()
        self.attributes = dict[str, str | None]()
        self.feed(source)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes |= dict(attrs)

    def handle_data(self, data: str) -> None:
        self.text += data


@pytest.mark.parametrize("text", HIDDEN, ids=list(HIDDEN.values()))
def test_what_cannot_be_seen_is_shown(text: str) -> None:
    assert one_line(text) == HIDDEN[text]
    assert one_line(one_line(text)) == HIDDEN[text]
    assert for_terminal(text) == HIDDEN[text]
    one_line(text).encode("utf-8")
    assert ElementTree.fromstring(f"<a>{for_html(text)}</a>").text == HIDDEN[text]


@each
def test_a_text_in_one_line_is_itself(text: str) -> None:
    assert one_line(text) == text


@each
def test_the_terminal_takes_no_commands(text: str) -> None:
    shown = for_terminal(text)
    assert not re.search(r"(^|\s)::|##\[", shown)
    assert shown.replace("\\x3a", ":").replace("\\x23", "#") == text


@each
def test_html_and_xml(text: str) -> None:
    inside = _Read(f"<p>{for_html(text)}</p>")
    assert (inside.text, inside.tags) == (text, ["p"])
    for quote in "\"'":
        held = _Read(f"<p title={quote}{for_html(text)}{quote}>")
        assert held.attributes == {"title": text}
    assert ElementTree.fromstring(f"<a>{for_html(text)}</a>").text == text


@each
def test_plotly_and_matplotlib(text: str) -> None:
    assert "<" not in for_plotly(text)
    assert plain_of_html(for_plotly(text)) == text
    from matplotlib.cbook import is_math_text

    shown = for_matplotlib(text)
    assert not is_math_text(shown)
    assert not shown.startswith("_")
    assert shown.replace(r"\$", "$").lstrip() == text.lstrip()


@pytest.mark.parametrize("text", [*NASTY.values(), *HIDDEN])
def test_json_in_a_file_and_in_a_page(text: str) -> None:
    written = json.dumps({"a": text}, ensure_ascii=False, indent=1)
    assert json.loads(for_json(written)) == json.loads(for_script(written)) == {"a": text}
    for_json(written).encode("utf-8")
    assert not re.search(r"[<\u2028\u2029\x7f-\x9f]", for_script(written))


@each
def test_markdown(text: str) -> None:
    made = MarkdownIt("commonmark").enable(["table", "strikethrough"])
    plain = _Read(made.render(f"a {for_markdown(text)}\n"))
    assert (" ".join(plain.text.split()), set(plain.tags)) == (" ".join(f"a {text}".split()), {"p"})
    table = _Read(made.render(f"| x | y |\n|---|---|\n| {for_markdown(text)} | z |\n"))
    assert table.tags.count("td") == 2
    assert not {"a", "img", "em", "strong", "script", "details", "code", "s"} & set(table.tags)
    assert " ".join(text.split()) in " ".join(table.text.split())


@each
def test_a_cell_is_no_formula_and_reads_back(text: str) -> None:
    stream = io.StringIO()
    csv.writer(stream).writerow([for_cell(text), "1"])
    ((cell, _),) = csv.reader(io.StringIO(stream.getvalue()))
    assert not cell.lstrip().startswith(("=", "+", "-", "@"))
    assert cell_text(cell) == text


@pytest.mark.parametrize("number", ["-5", "+5.5e3", "-1e-9", "0"])
def test_numbers_stay_numbers(number: str) -> None:
    assert for_cell(number) == number


@each
def test_a_comment_makes_no_formulas_and_reads_back(text: str) -> None:
    line = for_comment(f"# source: {text}")
    for cell in re.split("[,;]", line)[1:]:
        assert not cell.lstrip().startswith(("=", "+", "-", "@"))
    assert comment_text(line) == f"# source: {text}"


@each
def test_a_curve_keeps_its_source_and_its_columns(text: str, tmp_path: Path) -> None:
    import numpy as np

    d = np.array([0.0, 0.001])
    curve = StiffnessCurve(
        model="mine", orientation_deg=None, deflection=d, load=1e3 * d, columns={text: d}, source=text
    )
    write_curve(curve, tmp_path / "c.csv")
    found = read_curve(tmp_path / "c.csv")
    assert found.source == " ".join(text.split())
    assert list(found.columns) == [text]


def test_a_table_keeps_nothing_that_cannot_be_seen(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_text('# source: a\x1b[31mb\ntime_s,"x\x07y"\n0,1\n1,2\n', encoding="utf-8")
    table = read_table(path, TableRule(what="table", first=("time_s",), units=""))
    assert (table.names[1], table.source) == (r"x\x07y", r"a\x1b[31mb")
    assert "\x1b" not in table_text(table)


def test_controls_without_the_escapes() -> None:
    assert _Read(f"<p>{NASTY['a script']}</p>").tags == ["p", "script"]
    assert "em" in _Read(MarkdownIt().render("a *b*")).tags
    with pytest.raises(ElementTree.ParseError):
        ElementTree.fromstring("<a>\x1b</a>")
    from matplotlib.cbook import is_math_text

    assert is_math_text(NASTY["a formula of TeX"])
