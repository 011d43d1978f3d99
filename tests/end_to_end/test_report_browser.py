"""The report in a real browser, as a reader has it: everything drawn, nothing complained of, on any width.

Claim: all drawn, the report keeps to 15 screens of 1000 points and each of its questions to its budget. The pages of
the small study open from disk without an error on their console, draw each figure and scene when the reader comes to
it, turn scenes under the mouse and by finger, keep to the width of a phone, give their files and print whole. As large
as the shipped study's, the page draws no more for its first screen. Controls: a section that takes more than its
budget and a damaged figure are caught by the same reading; a free scene keeps the swipe that else scrolls.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

from tests.end_to_end.small_study import ROOT
from workbench.questions.registry import QUESTIONS
from workbench.questions.speed.record import DATA

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
pytestmark = pytest.mark.skipif(CHROMIUM is None and os.environ.get("CI") != "true", reason="no Chromium on PATH")

SCREENS = 15
"""Height of the report in screens of 1000 CSS points."""
BUILT_IN = ROOT / "build" / "report" / "report.html"
DRAWN = "[data-drawn='1']"
AT_REST = "!busy && !waiting.length"
"""Nothing is being drawn and nothing waits for it."""
EYE = "JSON.stringify(document.querySelector('#scene-parts .view')._fullLayout.scene._scene.getCamera().eye)"
type Finished = subprocess.CompletedProcess[str]


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    assert CHROMIUM, "CI needs Chromium on PATH"
    with sync_playwright() as driver:
        found = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--enable-unsafe-swiftshader"])
        yield found
        found.close()


def opened(browser: Browser, path: Path, width: int = 1440, height: int = 900) -> tuple[Page, list[str]]:
    """The page with its first figure drawn, and a list that takes every error."""
    return opened_in(browser.new_page(viewport={"width": width, "height": height}), path)


def opened_in(page: Page, path: Path) -> tuple[Page, list[str]]:
    """The same in a page made already."""
    errors: list[str] = []
    page.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("requestfailed", lambda request: errors.append(request.url[:80]))
    page.set_default_timeout(120e3)
    page.goto(path.as_uri())
    drawn = "#checks" if path.stem == "evidence" else ".plot[data-drawn='1'], .plot[data-failed]"  # none at its top
    page.wait_for_selector(drawn, state="attached")
    return page, errors


@pytest.fixture(scope="module")
def wide(browser: Browser, first_report: Finished, workspace: Path) -> tuple[Page, list[str]]:
    assert first_report.returncode == 0, first_report.stderr
    return opened(browser, workspace / "report" / "report.html")


@pytest.fixture(scope="module")
def behind(browser: Browser, first_report: Finished, workspace: Path) -> tuple[Page, list[str]]:
    """The evidence."""
    assert first_report.returncode == 0, first_report.stderr
    return opened(browser, workspace / "report" / "evidence.html")


@pytest.fixture(scope="module")
def phone(browser: Browser, first_report: Finished, workspace: Path) -> Iterator[tuple[Page, list[str]]]:
    screen = {"width": 390, "height": 844}
    context = browser.new_context(viewport=screen, has_touch=True, is_mobile=True)  # type: ignore[arg-type]
    yield opened_in(context.new_page(), workspace / "report" / "report.html")
    context.close()


def test_the_verdict_is_first_and_soon_there(wide: tuple[Page, list[str]]) -> None:
    page, errors = wide
    for words in ("Is the computation sound?", "Does the wheel do its job?", "Models beside the wheel"):
        box = page.locator("#verdict").get_by_text(words).first.bounding_box()
        assert box, words
        assert box["y"] < 900, words
    assert page.locator("nav.contents a.here").inner_text() == "Verdict"
    assert errors == []


def test_the_report_and_each_of_its_questions_keep_to_their_room(wide: tuple[Page, list[str]]) -> None:
    page, errors = wide
    heights_hold(page)
    assert errors == []


def test_control_a_section_that_takes_more_is_caught(browser: Browser, first_report: Finished, workspace: Path) -> None:
    page, _ = opened(browser, workspace / "report" / "report.html")
    page.evaluate("document.querySelector('#strength').style.minHeight = '2000px'")
    with pytest.raises(AssertionError, match="strength"):
        heights_hold(page)
    page.close()


@pytest.mark.long
@pytest.mark.skipif(not BUILT_IN.exists(), reason="no report of the built-in study: make report")
def test_the_built_in_report_keeps_to_its_room(browser: Browser) -> None:
    page, errors = opened(browser, BUILT_IN)
    heights_hold(page)
    assert errors == []
    page.close()


def heights_hold(page: Page) -> None:
    """Every figure drawn with its legend, then the height of the page and of each section [CSS points]."""
    draw_all(page)
    found = page.evaluate(
        "Object.fromEntries([...document.querySelectorAll('main > section')].map((s) => [s.id, s.offsetHeight]))"
    )
    budgets = {question.name: question.budget for question in QUESTIONS}
    assert {n: h for n, h in found.items() if n in budgets and h > budgets[n]} == {}
    assert page.evaluate("document.documentElement.scrollHeight") <= SCREENS * 1000


def draw_all(page: Page) -> None:
    boxes = page.locator(".plot, .scene")
    for number in range(boxes.count()):
        boxes.nth(number).scroll_into_view_if_needed()
    page.wait_for_function("[...document.querySelectorAll('.plot, .scene')].every((b) => b.dataset.drawn === '1')")


def test_a_page_of_full_size_draws_no_more_for_its_first_screen(
    browser: Browser, first_report: Finished, workspace: Path
) -> None:
    """Sections repeated until the page is as large as the shipped study's: what is drawn before the reader scrolls is
    counted, not timed (``make bench NAME=report_page`` does), and is that of the small page. Scrolling draws more."""
    text = (workspace / "report" / "report.html").read_text(encoding="utf-8")
    start, end = text.index('<div class="part">'), text.index("</main>")
    size = full_size()
    repeats = 1 + -(-(size - len(text)) // (end - start))
    (workspace / "full_size.html").write_text(text[:start] + repeats * text[start:end] + text[end:], encoding="utf-8")
    assert (workspace / "full_size.html").stat().st_size >= size
    drawn = []
    for path in (workspace / "report" / "report.html", workspace / "full_size.html"):
        page, errors = opened(browser, path)
        page.wait_for_load_state("load")
        page.wait_for_function(AT_REST)
        drawn.append(page.locator(DRAWN).count())
        assert errors == []
    assert drawn[0] == drawn[1] < 0.5 * page.locator(".plot, .scene").count()
    page.evaluate("scrollTo(0, document.body.scrollHeight)")
    page.wait_for_function(f"document.querySelectorAll({DRAWN!r}).length > {drawn[1]}")
    page.close()


def full_size() -> int:
    """Bytes of the shipped study's page, as last measured by ``make bench NAME=report_page``."""
    rows = json.loads((DATA / "report_page.json").read_text(encoding="utf-8"))["rows"]
    return int(next(row["ours"] for row in rows if row["metric"] == "size of the page"))


def test_a_link_saves_the_file_of_the_folder(behind: tuple[Page, list[str]], tmp_path: Path, workspace: Path) -> None:
    page, errors = behind
    link = page.locator("a[id^='series/']").first
    with page.expect_download() as waiting:
        link.click()
    name = waiting.value.suggested_filename
    waiting.value.save_as(tmp_path / name)
    assert (tmp_path / name).read_bytes() == (workspace / "report" / "series" / name).read_bytes()
    assert errors == []


def test_every_figure_is_drawn_when_it_is_seen(behind: tuple[Page, list[str]]) -> None:
    page, errors = behind
    boxes = page.locator(".plot, .scene")
    undrawn = page.evaluate("document.querySelectorAll('.plot:not([data-drawn])').length")
    assert undrawn > 10, "figures are drawn before they are seen"
    for number in range(boxes.count()):
        box = boxes.nth(number)
        box.scroll_into_view_if_needed()
        box.locator("svg, canvas").first.wait_for(state="attached")
    page.wait_for_function("[...document.querySelectorAll('.plot, .scene')].every((b) => b.dataset.drawn === '1')")
    assert boxes.count() > 15
    assert errors == []


@pytest.mark.parametrize("name", ["scene-parts", "scene-stress", "scene-rover"])
def test_a_scene_turns_under_the_mouse(wide: tuple[Page, list[str]], name: str) -> None:
    page, errors = wide
    eye = f"JSON.stringify(document.querySelector('#{name} .view')._fullLayout.scene._scene.getCamera().eye)"
    view = page.locator(f"#{name} .view")
    page.locator(f"#{name}").scroll_into_view_if_needed()
    page.wait_for_selector(f"#{name}[data-drawn='1']", state="attached")
    view.scroll_into_view_if_needed()
    before, camera, box = view.screenshot(), page.evaluate(eye), view.bounding_box()
    assert box
    x, y = box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"]
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 120, y + 40, steps=6)
    page.mouse.up()
    page.wait_for_function(f"({eye}) !== {camera!r}")
    assert view.screenshot() != before
    assert errors == []


def test_the_wheel_goes_back_to_its_undeformed_shape(wide: tuple[Page, list[str]]) -> None:
    page, _ = wide
    high = "Math.max(...document.querySelector('#scene-stress .view').data[0].intensity)"
    loaded = page.evaluate(high)
    page.evaluate("""const s = document.querySelector('#scene-stress input'); s.value = 0;
                     s.dispatchEvent(new Event('input'))""")
    page.wait_for_function(f"{high} === 0")
    assert loaded > 1.0


def test_lines_are_switched_and_checks_filtered(wide: tuple[Page, list[str]]) -> None:
    page, errors = wide
    page.evaluate("scrollTo(0, 0)")
    page.locator(".lead .legend button").last.click()
    page.wait_for_function("document.getElementById('model-curves').data.at(-1).visible === 'legendonly'")
    assert errors == []


def test_a_count_leads_to_those_checks_which_are_filtered(
    browser: Browser, first_report: Finished, workspace: Path
) -> None:
    """From the report into the evidence, and by words there."""
    page, errors = opened(browser, workspace / "report" / "report.html")
    page.locator(".counts a.gate").first.click()
    page.wait_for_url("**/evidence.html?show=gate+pass#checks")
    page.wait_for_selector("details.checks[open]")
    assert page.locator("details.checks[open]").count() > 3
    assert page.locator("details.checks tr.finding:visible").count() == 0
    page.locator(".filter input").fill("no such words")
    assert page.locator("details.checks:visible").count() == 0
    assert page.locator(".filter [role=status]").inner_text() == "0 shown"
    page.locator(".filter input").fill("")
    assert errors == []
    page.close()


def test_it_prints_whole(behind: tuple[Page, list[str]], tmp_path: Path) -> None:
    """Figures no wider than the paper, folds open; afterwards as before."""
    page, errors = behind
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert page.locator("details:not([open])").count() == 0
    widths = page.evaluate("[...document.querySelectorAll('.plot')].map((b) => b._fullLayout.width)")
    assert max(widths) <= 690
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    page.pdf(path=tmp_path / "printed.pdf", prefer_css_page_size=True, print_background=True)
    assert len(re.findall(rb"/Type\s*/Page\b", (tmp_path / "printed.pdf").read_bytes())) > 10
    assert errors == []


@pytest.mark.parametrize("name", ["report.html", "evidence.html"])
def test_a_phone_scrolls_down_only(browser: Browser, first_report: Finished, workspace: Path, name: str) -> None:
    page, errors = opened(browser, workspace / "report" / name, 390, 844)
    assert page.evaluate("document.documentElement.scrollWidth") == 390
    page.locator(".contents label").click()
    page.locator(".contents a", has_text="Strength").click()
    assert not page.locator(".contents .list").is_visible()
    page.evaluate("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
    assert page.evaluate("document.documentElement.scrollWidth") == 390
    assert errors == []
    page.close()


def test_wide_tables_scroll_in_their_own_frame(phone: tuple[Page, list[str]]) -> None:
    page, _ = phone
    page.evaluate("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
    out = page.evaluate("""[...document.querySelectorAll('main table')].filter((t) => t.scrollWidth > 358
        && !t.closest('.scroll')).map((t) => t.closest('section').id)""")
    assert out == []
    wider = page.evaluate("[...document.querySelectorAll('.scroll')].map((f) => f.scrollWidth - f.clientWidth)")
    assert sum(more > 0 for more in wider) > 3


@pytest.mark.parametrize("place", ["#scene-parts .stage", "#fe-curves"])
def test_a_swipe_over_a_figure_scrolls_the_page(phone: tuple[Page, list[str]], place: str) -> None:
    page, errors = phone
    x, y = middle(page, place)
    before = page.evaluate("scrollY")
    swipe(page, (x, y + 100), (x, y - 150))
    page.wait_for_function(f"scrollY > {before} + 100")
    assert errors == []


def test_a_finger_turns_a_scene_sideways_and_freely_after_a_tap(phone: tuple[Page, list[str]]) -> None:
    page, errors = phone
    x, y = middle(page, "#scene-parts .stage")
    eye = page.evaluate(EYE)
    swipe(page, (x - 60, y), (x + 60, y))
    page.wait_for_function(f"({EYE}) !== {eye!r}")
    turned = page.evaluate(EYE)
    assert json.loads(turned)["z"] == pytest.approx(json.loads(eye)["z"])
    page.touchscreen.tap(x, y)
    page.wait_for_selector("#scene-parts .stage.free")
    place = page.locator("#scene-parts .stage").bounding_box()
    swipe(page, (x, y + 80), (x, y - 80))
    page.wait_for_function(f"({EYE}) !== {turned!r}")
    assert json.loads(page.evaluate(EYE))["z"] != pytest.approx(json.loads(eye)["z"])
    assert page.locator("#scene-parts .stage").bounding_box() == place
    page.touchscreen.tap(x, max(y - 260, 60))
    assert page.locator(".stage.free").count() == 0
    assert errors == []


def middle(page: Page, place: str) -> tuple[float, float]:
    """Of a figure, brought to the middle of the screen and drawn, as all near it."""
    page.evaluate(f"document.querySelector('{place}').scrollIntoView({{ block: 'center', behavior: 'instant' }})")
    page.wait_for_selector(f"{place.split()[0]}[data-drawn='1']", state="attached")
    page.wait_for_function("!busy && waiting.length === 0")
    page.evaluate(f"document.querySelector('{place}').scrollIntoView({{ block: 'center', behavior: 'instant' }})")
    box = page.locator(place).bounding_box()
    assert box
    return box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"]


def swipe(page: Page, start: tuple[float, float], end: tuple[float, float], steps: int = 12) -> None:
    """One finger from here to there, as the browser gets it from a screen."""
    screen = page.context.new_cdp_session(page)
    for k in range(steps + 1):
        x, y = (a + (b - a) * k / steps for a, b in zip(start, end, strict=True))
        kind = "touchMove" if k else "touchStart"
        screen.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y}]})
    screen.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    screen.detach()


def test_control_a_damaged_figure_is_noticed(browser: Browser, first_report: Finished, workspace: Path) -> None:
    text = (workspace / "report" / "report.html").read_text(encoding="utf-8")
    damaged = re.sub(r'(data-for="model-curves">)\{', r"\1{{", text, count=1)
    assert damaged != text
    (workspace / "damaged.html").write_text(damaged, encoding="utf-8")
    page, errors = opened(browser, workspace / "damaged.html")
    assert errors
    assert "model-curves was not drawn" in errors[0]
    page.close()
