"""Text of a user is text in everything the program writes, and decides no result.

Claim: a study, a rover and curve files whose every text tries to be something else (markup of the terminal, HTML,
Markdown, TeX, Typst, templates, formulas, commands of CI services, control codes) run through the commands; page, PDF,
JSON, XML, Markdown, CSV, Parquet and terminal hold the texts as they are, the browser runs none of it, and the report
computes nothing again but the distances to the user's own curve. Source: docs/reference/files.md. Negative control:
tests/unit/test_text.py reads texts that were not escaped.
"""

from __future__ import annotations

import csv
import json
import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import pytest
from markdown_it import MarkdownIt

from contracts.curves import read_curve
from contracts.text import cell_text, for_terminal, one_line
from tests.end_to_end.small_study import ROOT, command, environment, small_study_text

TRIES = (
    '[/red] [b]<script>window.pwned = 1</script> &lt; "q" it\'s `c` | *a* _b_ $x_$ #eval {{ 7*7 }} {% x %} '
    "::error::e , =1+1 \x1b[31m \u202e \u8f6e end"
)
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
CURVE, OTHER = "=c [red]$x$ <b>.csv", "d \x1b[31m<b>\n::error::x.csv"
STUDY = "[red]s $x$.toml"
type Finished = subprocess.CompletedProcess[str]


def _toml(text: str) -> str:
    """A text as TOML writes it."""
    return json.dumps(text)


def _nasty(start: str) -> str:
    return f"{start} {TRIES}"


def _study_text() -> str:
    """The small study with other words, and a curve of the user's own."""
    metal = _toml(_nasty("@metal"))
    text = small_study_text()
    for pattern, new in (
        (r'title = "[^"]*"', f"title = {_toml(_nasty('=1+1 title'))}"),
        (r'source = "MatWeb[^"]*"', f"source = {_toml(_nasty('+metal source'))}"),
        (r'source = "Samarini[^"]*"', f"source = {_toml(_nasty('-brush source'))}"),
        (r'"wheel.grousers" = "[^"]*"', f'"wheel.grousers" = {_toml(_nasty("inferred"))}'),
    ):
        text, count = re.subn(pattern, lambda _, new=new: new, text, count=1)
        assert count == 1, pattern
    text = text.replace('[materials."Ti-6Al-4V"]', f"[materials.{metal}]")
    text = text.replace('material = "Ti-6Al-4V"', f"material = {metal}")
    words = {"file": CURVE, "label": _nasty("_label"), "kind": "measured", "source": _nasty("=curve source")}
    words["uncertainty"] = "3 %"
    return f"{text}\n[[reference.curves]]\n" + "".join(f"{key} = {_toml(value)}\n" for key, value in words.items())


def _run(folder: Path, *arguments: str, page: Path | None = None) -> Finished:
    """A command on a terminal so wide that no text is broken."""
    settings = environment() | {"COLUMNS": "6000"} | ({"GITHUB_STEP_SUMMARY": str(page)} if page else {})
    return subprocess.run(command(*arguments), cwd=folder, env=settings, capture_output=True, text=True, check=False)


class _Page(HTMLParser):
    """Words, scripts and tags of a page."""

    def __init__(self, source: str) -> None:
        super().__init__(convert_charrefs=True)
        self.words, self.tags = "", list[str]()
        self.scripts: list[tuple[str | None, str]] = []
        self.inside = ""
        self.feed(source)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.inside = tag if tag in ("script", "style") else ""
        if tag == "script":
            self.scripts.append((dict(attrs).get("type"), ""))

    def handle_endtag(self, tag: str) -> None:
        self.inside = ""

    def handle_data(self, data: str) -> None:
        if self.inside == "script":
            kind, text = self.scripts[-1]
            self.scripts[-1] = kind, text + data
        elif not self.inside:
            self.words += data


def _letters(text: str) -> str:
    """Without spaces and the marks at which a line may be broken."""
    return re.sub(r"[\s\u200b\u00ad-]", "", text)


def _nothing_acts(text: str) -> None:
    """No control code, and no line that commands a CI service."""
    assert not re.search(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202e]", text)
    assert not any(line.lstrip().startswith("::") or "##[" in line for line in text.splitlines())


@pytest.fixture(scope="module")
def folder(workspace: Path) -> Path:
    """The shared folder with the files whose texts are nasty."""
    (workspace / STUDY).write_text(_study_text(), encoding="utf-8")
    header = f"# source: a,=1+1 {one_line(TRIES)}\ndeflection_m,load_N,=1+1\n"
    (workspace / CURVE).write_text(f"{header}0,0,1\n0.003,24,1\n0.006,48,2\n", encoding="utf-8")
    (workspace / OTHER).write_text("deflection_mm,load_N\n0,0\n3,26\n6,50\n", encoding="utf-8")
    return workspace


@pytest.fixture(scope="module")
def report(folder: Path, first_report: Finished) -> Finished:
    """The study's report, after that of the same study with plain words."""
    assert first_report.returncode == 0, first_report.stderr
    return _run(folder, "report", STUDY, "--out", "nasty", "--store", "store", "--ci", page=folder / "step_summary.md")


def test_other_words_compute_nothing_again(report: Finished) -> None:
    assert report.returncode == 0, report.stderr
    assert report.stderr == ""
    assert re.findall(r"\] (\S+): computed", report.stdout) == ["metrics"]
    _nothing_acts(report.stdout)


def test_the_page_holds_the_words_and_runs_none(report: Finished, folder: Path) -> None:
    words = ""
    for name in ("report.html", "evidence.html"):
        plain, page = (_Page((folder / one / name).read_text(encoding="utf-8")) for one in ("report", "nasty"))
        assert [kind for kind, _ in page.scripts] == [kind for kind, _ in plain.scripts]
        for kind, text in page.scripts:
            assert "pwned" not in text or (kind == "application/json" and json.loads(text))
        assert set(page.tags) == set(plain.tags)
        words += page.words
    for start in ("=1+1 title", "@metal", "+metal source", "_label", "=curve source", "inferred"):
        assert one_line(_nasty(start)) in words, start


def test_the_browser_runs_none_of_it(report: Finished, folder: Path) -> None:
    if CHROMIUM is None:
        assert os.environ.get("CI") != "true", "continuous integration must have chromium"
        pytest.skip("chromium is not on PATH")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page()
        page.goto((folder / "nasty" / "report.html").as_uri())
        page.wait_for_selector(".plot[data-drawn='1'], .plot[data-failed]", state="attached", timeout=120e3)
        assert page.evaluate("typeof window.pwned") == "undefined"
        assert one_line(_nasty("=1+1 title")) in page.title()
        label = one_line(_nasty("_label"))  # behind the mark of its line
        assert any(label in text for text in page.locator(".legend button").all_text_contents())
        browser.close()


@pytest.mark.skipif(shutil.which("pdftotext") is None, reason="no pdftotext on PATH")
def test_the_document_holds_the_words(report: Finished, folder: Path) -> None:
    run = subprocess.run(
        ["pdftotext", "-raw", folder / "nasty" / "report.pdf", "-"], capture_output=True, text=True, check=True
    )
    words = _letters(run.stdout)
    for start in ("=1+1 title", "_label"):
        shown = _letters(one_line(_nasty(start)))
        assert shown.partition("\u8f6e")[0] in words, start  # the document's fonts have no Chinese


def test_files_for_programs_hold_the_words(report: Finished, folder: Path) -> None:
    label, source = one_line(_nasty("_label")), one_line(_nasty("=curve source"))
    checks = json.loads((folder / "nasty" / "summary.json").read_text(encoding="utf-8"))["checks"]
    (mine, *_) = [check for check in checks if check["id"].startswith("user_0")]
    assert label in mine["title"]
    assert mine["source"].removeprefix("measured: ").startswith(source)
    cases = ElementTree.parse(folder / "nasty" / "junit.xml").iter("testcase")
    assert any(label in (case.findtext("system-out") or "") and source in "".join(case.itertext()) for case in cases)
    brush = read_curve(folder / "nasty" / "curves" / "brush_average.csv")
    assert one_line(_nasty("-brush source")) in brush.source
    first = (folder / "nasty" / "curves" / "brush_average.csv").read_text(encoding="utf-8").splitlines()[0]
    assert not re.search(r"[,;]\s*[=+@-]", first)


def test_markdown_holds_no_markup_of_theirs(report: Finished, folder: Path) -> None:
    for path in (folder / "nasty" / "summary.md", folder / "step_summary.md"):
        text = path.read_text(encoding="utf-8")
        _nothing_acts(text)
        tags = set(_Page(MarkdownIt("commonmark").enable("table").render(text)).tags)
        assert not tags & {"script", "em", "b", "img", "a"}


@pytest.mark.long
def test_a_report_with_such_words_is_accepted_and_held_against(report: Finished, folder: Path) -> None:
    kept = _run(folder, "accept", "nasty", "--baseline", "[red]kept")
    assert (kept.returncode, kept.stderr) == (0, "")
    assert "[red]kept" in kept.stdout
    again = _run(folder, "report", STUDY, "--out", "nasty", "--store", "store", "--ci", "--baseline", "[red]kept")
    assert (again.returncode, again.stderr) == (0, "")
    assert "0 tasks computed" in again.stdout


def test_two_curves_are_compared_under_their_names(folder: Path) -> None:
    run = _run(folder, "compare", CURVE, OTHER, "--out", "[b]compared")
    assert (run.returncode, run.stderr) == (0, "")
    _nothing_acts(run.stdout)
    assert f"{CURVE} against {for_terminal(OTHER)}" in run.stdout
    page = _Page((folder / "[b]compared" / "compare.html").read_text(encoding="utf-8"))
    title = f"{Path(CURVE).stem} against {one_line(Path(OTHER).stem)}"
    assert title in page.words
    assert not any("pwned" in text for kind, text in page.scripts if kind != "application/json")
    assert one_line(TRIES) in page.words
    values = json.loads((folder / "[b]compared" / "compare.json").read_text(encoding="utf-8"))
    assert values["curve"] == {"name": Path(CURVE).stem, "source": f"a,=1+1 {one_line(TRIES)}"}


def test_a_sweep_over_texts_names_them(folder: Path) -> None:
    texts = [_nasty("=1+1"), "</script><!--<script>", "@x\ty", "plain"]
    swept = ", ".join(map(_toml, texts))
    study = f'{small_study_text()}\n[sweep]\nmodels = ["brush"]\n"brush.source" = [{swept}]\n'
    (folder / "swept.toml").write_text(study, encoding="utf-8")
    run = _run(folder, "sweep", "swept.toml", "--out", "swept", "--store", "store")
    warning = "workbench: warning: swept.toml: sweep.brush.source changes nothing that brush computes; leave it out\n"
    assert (run.returncode, run.stderr) == (0, warning)
    _nothing_acts(run.stdout)
    with (folder / "swept" / "sweep.csv").open(encoding="utf-8", newline="") as stream:
        cells = [row["brush.source"] for row in csv.DictReader(stream)][1:]
    assert not any(cell.startswith(("=", "+", "-", "@")) for cell in cells)
    assert [cell_text(cell) for cell in cells] == [one_line(text) for text in texts]
    page = _Page((folder / "swept" / "sweep.html").read_text(encoding="utf-8"))
    for text in texts:
        assert one_line(text) in page.words
        assert f"brush.source = {for_terminal(text)}" in run.stdout
    assert all(kind == "application/json" for kind, text in page.scripts if "pwned" in text)


def test_a_rover_keeps_its_name(folder: Path) -> None:
    text = (ROOT / "rover_dynamics" / "rover" / "exomars_rover.toml").read_text(encoding="utf-8")
    name = _nasty("[/red]rover")
    (folder / "rover.toml").write_text(re.sub(r'name = "[^"]*"', lambda _: f"name = {_toml(name)}", text, count=1))
    run = _run(folder, "rover", "drop", "--rover", "rover.toml", "--tire", "rigid", "--out", "rover")
    assert (run.returncode, run.stderr) == (0, "")
    assert for_terminal(name) in " ".join(run.stdout.split())  # the title is as wide as its table
    _nothing_acts(run.stdout)
    assert one_line(name) in comment_of(folder / "rover" / "series" / "drop_rigid.csv")


def comment_of(path: Path) -> str:
    """The source that a series states."""
    from contracts.series import read_series

    return read_series(path, "drop", "rigid").source


ENDS: dict[str, tuple[tuple[str, ...], str]] = {
    "a study that is not there": (("report", "[/red]\x1b[31m\n::error::.toml"), "[/red]\\x1b[31m ::error::.toml"),
    "a scenario": (("rover", "[/red]\x1b[2J"), "[/red]\\x1b[2J"),
    "a command": (("[red]\x1b[2J",), "[red]\\x1b[2J"),
    "a store": (("results", "--store", "[/b]\x1b[2J"), "[/b]\\x1b[2J"),
    "a curve of bytes": (("compare", "a\udcff.csv", "b.csv"), "a\\udcff.csv"),
}


@pytest.mark.parametrize("case", ENDS)
def test_messages_quote_what_was_given(case: str, tmp_path: Path) -> None:
    arguments, shown = ENDS[case]
    run = _run(tmp_path, *arguments)
    assert run.returncode == 2
    assert run.stdout == ""
    _nothing_acts(run.stderr)
    assert shown.replace(" ::", " \\x3a:") in run.stderr


def test_a_name_of_bytes_is_no_obstacle(folder: Path) -> None:
    shutil.copy(folder / CURVE, folder / "b\udcff.csv")
    run = _run(folder, "compare", "b\udcff.csv", CURVE, "--out", "bytes")
    assert (run.returncode, run.stderr) == (0, "")
    assert "b\\udcff.csv against" in run.stdout
    assert json.loads((folder / "bytes" / "compare.json").read_text(encoding="utf-8"))["curve"]["name"] == "b\\udcff"


@pytest.fixture(scope="module", autouse=True)
def _without_its_files(folder: Path) -> Iterator[None]:
    """Take the strange names out of the shared folder again."""
    yield
    for name in (STUDY, CURVE, OTHER, "b\udcff.csv", "swept.toml", "rover.toml", "step_summary.md"):
        (folder / name).unlink(missing_ok=True)
