"""The report in a real browser, as a reader has it: everything drawn, nothing complained of, on any width.

Claim: the page of the small study opens from disk without an error on its console, draws each figure and scene when
the reader comes to it, turns its scenes under the mouse and by finger, keeps to the width of a phone, gives its files
and prints whole. As large as the shipped study's page, it shows verdict and first figure within 3 s. Controls: a page
whose figure is damaged is caught by the same reading of the console; a free scene keeps the swipe that else scrolls.
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

from workbench.questions.speed.record import DATA

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
pytestmark = pytest.mark.skipif(CHROMIUM is None and os.environ.get("CI") != "true", reason="no Chromium on PATH")

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
    page.wait_for_selector(".plot[data-drawn='1'], .plot[data-failed]", state="attached")
    return page, errors


@pytest.fixture(scope="module")
def wide(browser: Browser, first_report: Finished, workspace: Path) -> tuple[Page, list[str]]:
    assert first_report.returncode == 0, first_report.stderr
    return opened(browser, workspace / "report" / "report.html")


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
    assert drawn[0] == drawn[1] < 0.2 * page.locator(".plot, .scene").count()
    page.evaluate("scrollTo(0, document.body.scrollHeight)")
    page.wait_for_function(f"document.querySelectorAll({DRAWN!r}).length > {drawn[1]}")
    page.close()


def full_size() -> int:
    """Bytes of the shipped study's page, as last measured by ``make bench NAME=report_page``."""
    rows = json.loads((DATA / "report_page.json").read_text(encoding="utf-8"))["rows"]
    return int(next(row["ours"] for row in rows if row["metric"] == "size of the page"))


def test_a_link_saves_the_file_of_the_folder(wide: tuple[Page, list[str]], tmp_path: Path, workspace: Path) -> None:
    page, errors = wide
    link = page.locator("a[href^='data:application/gzip']").first
    with page.expect_download() as waiting:
        link.click()
    name = waiting.value.suggested_filename
    waiting.value.save_as(tmp_path / name)
    assert (tmp_path / name).read_bytes() == (workspace / "report" / "series" / name).read_bytes()
    assert errors == []


def test_every_figure_is_drawn_when_it_is_seen(wide: tuple[Page, list[str]]) -> None:
    page, errors = wide
    boxes = page.locator(".plot, .scene")
    undrawn = page.evaluate("document.querySelectorAll('.plot:not([data-drawn])').length")
    assert undrawn > 10, "figures are drawn before they are seen"
    for number in range(boxes.count()):
        box = boxes.nth(number)
        box.scroll_into_view_if_needed()
        box.locator("svg, canvas").first.wait_for(state="attached")
    page.wait_for_function("[...document.querySelectorAll('.plot, .scene')].every((b) => b.dataset.drawn === '1')")
    assert boxes.count() > 20
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
    page.locator(".counts a.gate").first.click()
    assert page.locator("details.checks[open]").count() > 3
    assert page.locator("details.checks tr.finding:visible").count() == 0
    page.locator(".filter input").fill("no such words")
    assert page.locator("details.checks:visible").count() == 0
    assert page.locator(".filter [role=status]").inner_text() == "0 shown"
    page.locator(".filter input").fill("")
    assert errors == []


def test_it_prints_whole(wide: tuple[Page, list[str]], tmp_path: Path) -> None:
    """Figures no wider than the paper, folds open; afterwards as before."""
    page, errors = wide
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert page.locator("details:not([open])").count() == 0
    widths = page.evaluate("[...document.querySelectorAll('.plot')].map((b) => b._fullLayout.width)")
    assert max(widths) <= 690
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    page.pdf(path=tmp_path / "printed.pdf", prefer_css_page_size=True, print_background=True)
    assert len(re.findall(rb"/Type\s*/Page\b", (tmp_path / "printed.pdf").read_bytes())) > 10
    assert errors == []


def test_a_phone_scrolls_down_only(browser: Browser, first_report: Finished, workspace: Path) -> None:
    page, errors = opened(browser, workspace / "report" / "report.html", 390, 844)
    assert page.evaluate("document.documentElement.scrollWidth") == 390
    page.locator(".contents label").click()
    page.locator(".contents a", has_text="All checks").click()
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
    assert sum(more > 0 for more in wider) > 5


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
