"""The report in a real browser, as a reader has it: everything drawn, nothing complained of, on any width.

Claim: the page of the small study opens from disk without an error on its console, draws each figure and scene when
the reader comes to it, turns its scenes under the mouse, keeps to the width of a phone, and prints whole. Control: a
page whose figure is damaged is caught by the same reading of the console.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
pytestmark = pytest.mark.skipif(CHROMIUM is None and os.environ.get("CI") != "true", reason="no Chromium on PATH")

SHOWN_S = 10.0
"""First figure at the latest, of a machine that has a core to spare."""
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
    page = browser.new_page(viewport={"width": width, "height": height})
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


def test_the_verdict_is_first_and_soon_there(wide: tuple[Page, list[str]]) -> None:
    page, errors = wide
    shown = page.evaluate("performance.getEntriesByName('first-figure')[0].startTime")
    assert shown < 1e3 * SHOWN_S or os.getloadavg()[0] > (os.cpu_count() or 1)
    for words in ("gates passed", "Who agrees with the continuum?", "Does the continuum meet the reference?"):
        box = page.locator("#verdict").get_by_text(words).first.bounding_box()
        assert box, words
        assert box["y"] < 900, words
    assert page.locator("nav.contents a.here").inner_text() == "Verdict"
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


def test_control_a_damaged_figure_is_noticed(browser: Browser, first_report: Finished, workspace: Path) -> None:
    text = (workspace / "report" / "report.html").read_text(encoding="utf-8")
    damaged = re.sub(r'(data-for="model-curves">)\{', r"\1{{", text, count=1)
    assert damaged != text
    (workspace / "damaged.html").write_text(damaged, encoding="utf-8")
    page, errors = opened(browser, workspace / "damaged.html")
    assert errors
    assert "model-curves was not drawn" in errors[0]
    page.close()
