"""``workbench view`` as a user runs it: the command, its page in headless Chromium, Ctrl-C.

Claim: the page shows results, turns, plays, probes and overlays; it saves pictures and asks nothing of any other
machine; bad input is one message and exit status 2. Pixels of the 3D view must change where the view does.
"""

from __future__ import annotations

import io
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

import numpy as np
import pytest
from PIL import Image

from tests.small_report_folder import write_small_report

if TYPE_CHECKING:
    from playwright.sync_api import Page

ROOT = Path(__file__).parents[2]
PATIENCE = 120_000
"""Milliseconds a busy machine is given for each step."""
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
ARGUMENTS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A report's folder, its name with a space and an umlaut."""
    path = tmp_path_factory.mktemp("view") / "mein Räder-Bericht"
    path.mkdir()
    write_small_report(path)
    (path.parent / "mine.csv").write_text("deflection_mm,load_kN\n0,0\n20,0.15\n", encoding="utf-8")
    (path.parent / "fe_phi000").write_text("deflection_m,load_N\n0,0\n0.02,999\n", encoding="utf-8")
    (path.parent / "long.csv").write_text("deflection_m,load_N\n" + "0,0\n" * 300_000, encoding="utf-8")
    (path.parent / "bad.csv").write_text("x,y\n0,0\n1,1\n", encoding="utf-8")
    return path


def start(*arguments: str) -> subprocess.Popen[str]:
    """The command, with its output to read."""
    return subprocess.Popen(
        [sys.executable, "-m", "workbench", "view", *arguments],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


@pytest.fixture(scope="module")
def address(folder: Path) -> Iterator[str]:
    """Where the page is; it ends by Ctrl-C, in silence, with exit status 0."""
    process = start(str(folder))
    assert process.stdout is not None
    line = process.stdout.readline().strip()
    assert line.startswith("http://127.0.0.1:"), process.communicate()[1]
    yield line
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=PATIENCE / 1000)
    assert (process.returncode, out, err) == (0, "", "")


def test_the_page_is_answered_on_loopback_only(address: str) -> None:
    port = urlsplit(address).port
    assert port is not None
    with socket.socket() as probe, pytest.raises(OSError):  # noqa: PT011 - refused or unreachable
        probe.connect(("127.0.0.2", port))


def test_a_port_in_use_is_one_message(folder: Path, address: str) -> None:
    process = start(str(folder), "--port", str(urlsplit(address).port))
    out, err = process.communicate(timeout=PATIENCE / 1000)
    assert (process.returncode, out) == (2, "")
    assert err.startswith("workbench: error: port = ")
    assert err.count("\n") == 1


def test_a_folder_of_modes_is_enough(folder: Path, tmp_path: Path) -> None:
    shutil.copytree(folder / "modes", tmp_path / "modes")
    process = start(str(tmp_path))
    assert process.stdout is not None
    line = process.stdout.readline()
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=PATIENCE / 1000)
    assert line.startswith("http://127.0.0.1:"), err
    assert (process.returncode, out, err) == (0, "", "")


def test_a_bad_file_or_an_empty_folder_is_one_message(folder: Path, tmp_path: Path) -> None:
    bad = shutil.copytree(folder, tmp_path / "bad")
    (bad / "fields" / "fe_phi000_200N.vtu").write_text("<VTKFile", encoding="utf-8")
    (tmp_path / "empty").mkdir()
    for name, message in (("bad", "field file = "), ("empty", "report folder = ")):
        process = start(str(tmp_path / name))
        out, err = process.communicate(timeout=PATIENCE / 1000)
        assert (process.returncode, out) == (2, "")
        assert err.startswith(f"workbench: error: {message}")
        assert err.count("\n") == 1


def check_pictures(page: Page, folder: Path) -> None:
    """What is saved has the scene's pixels, its words at their places and its colours; the chart is sharp."""
    scene, chart = folder / "scene.png", folder / "chart.png"
    for button, path, name in (
        ("#save-scene", scene, "FE_0_down_200_N.png"),
        ("#save-chart", chart, "chart_of_FE_0_down_200_N.png"),
    ):
        with page.expect_download() as saved:
            page.click(button)
        assert saved.value.suggested_filename == name
        saved.value.save_as(path)
    found = np.asarray(Image.open(io.BytesIO(scene.read_bytes())).convert("RGB")).astype(int)
    seen = np.asarray(Image.open(io.BytesIO(page.locator(".stage").screenshot())).convert("RGB")).astype(int)
    assert np.abs(np.subtract(found.shape, seen.shape)).max() <= 1  # the page's place has parts of pixels
    high, wide = np.minimum(found.shape, seen.shape)[:2]
    found, seen = found[:high, :wide], seen[:high, :wide]
    middle = tuple(slice(n // 3, 2 * n // 3) for n in found.shape[:2])
    np.testing.assert_array_equal(found[middle], seen[middle])
    assert np.ptp(found[middle]) > 50
    home = page.locator(".stage").bounding_box()
    assert home is not None
    for words in ("#caption", "#bar .title", "#legend"):
        box = page.locator(words).bounding_box()
        assert box is not None
        top, left = round(box["y"] - home["y"]), round(box["x"] - home["x"])
        here = slice(top, top + round(box["height"])), slice(left, left + round(box["width"]))
        assert (found[here].max(axis=2) < 100).sum() > 50, f"{words} is not on the picture"
        assert abs((found[here] < 100).mean() - (seen[here] < 100).mean()) < 0.05
    warning = (found == (0xD5, 0x5E, 0x00)).all(axis=2)
    assert warning.sum() > 100  # of the legend
    width = page.locator("#chart").evaluate("(one) => one.clientWidth")
    with Image.open(chart) as picture:
        assert picture.width == 2 * width


def test_a_colleague_looks_at_results(folder: Path, address: str) -> None:
    if CHROMIUM is None:
        assert os.environ.get("CI") != "true", "CI must have Chromium on PATH"
        pytest.skip("no Chromium on PATH")
    from playwright.sync_api import sync_playwright

    asked: list[str] = []
    complaints: list[str] = []

    def pixels(page: Page) -> bytes:
        return page.locator(".stage canvas").first.screenshot()

    def until_changed(page: Page, before: bytes, again: Callable[[], None] = lambda: None) -> bytes:
        end = time.monotonic() + PATIENCE / 1000
        while (now := pixels(page)) == before:
            assert time.monotonic() < end, "the picture does not change"
            again()
            page.wait_for_timeout(100)
        return now

    def caption(page: Page, text: str) -> None:
        page.locator("#caption", has_text=text).wait_for()

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        page = browser.new_page(viewport={"width": 1000, "height": 700})
        page.set_default_timeout(PATIENCE)
        page.on("request", lambda request: asked.append(request.url))
        page.on("websocket", lambda one: asked.append(one.url))
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("console", lambda said: complaints.append(said.text) if said.type == "error" else None)
        page.goto(address)
        caption(page, "FE, 0° down, 200 N")
        page.wait_for_selector("#chart .main-svg")
        shown = pixels(page)

        page.locator("#frame").fill("3")  # a point of the curve
        caption(page, "75 N")
        lighter = until_changed(page, shown)
        page.click("#play")
        caption(page, "FE, 0° down, 200 N")
        shown = until_changed(page, lighter)

        page.select_option("#quantity", "smallest_principal")  # kept at two of the loads
        page.locator("#bar", has_text="smallest principal stress [MPa]").wait_for()
        assert page.locator("#bar .ticks span").all_inner_texts() == ["300", "150", "0", "-150", "-300"]
        assert page.locator("#loads button").all_inner_texts() == ["0 N", "100 N", "200 N"]
        signed = until_changed(page, shown)
        page.select_option("#quantity", "stress")
        page.locator("#bar", has_text="von Mises stress [MPa]").wait_for()
        shown = until_changed(page, signed)

        page.locator("#mark-yield").check()
        page.locator("#legend", has_text="above yield strength: 250 MPa hub, 355 MPa tire (").wait_for()
        marked = until_changed(page, shown)
        check_pictures(page, folder.parent)
        page.locator("#mark-yield").uncheck()
        page.wait_for_selector("#legend", state="detached")
        until_changed(page, marked)

        page.click("#orientations button:has-text('30°')")
        caption(page, "30° down")
        turned = until_changed(page, shown)

        page.locator("#parts label", has_text="tire").click()
        hidden = until_changed(page, turned)
        page.select_option("#cut-axis", "y")
        page.locator("#cut-text", has_text="y = 0.0 mm").wait_for()
        cut = until_changed(page, hidden)
        page.locator("#cut-step").fill("100")  # nothing is left before the eye
        page.locator("#cut-text", has_text="y = 50.0 mm").wait_for()
        caption(page, "200 N: nothing left of it")
        until_changed(page, cut)
        page.select_option("#cut-axis", "")
        page.click("#all-parts")
        page.wait_for_selector("#all-parts", state="detached")
        end = time.monotonic() + PATIENCE / 1000
        while pixels(page) != turned:
            assert time.monotonic() < end, "the whole wheel does not come back"
            page.wait_for_timeout(100)

        box = page.locator(".stage canvas").first.bounding_box()
        assert box is not None
        x, y = box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"]

        def drag() -> None:
            page.mouse.move(x, y)
            page.mouse.down()
            for k in range(1, 6):
                page.mouse.move(x + 18 * k, y + 2 * k)
                page.evaluate("() => new Promise(requestAnimationFrame)")  # vtk.js turns once a frame
            page.mouse.up()

        seen = until_changed(page, turned, drag)
        assert page.locator("table#probe").count() == 0  # a drag is no click

        page.click("#reset")
        until_changed(page, seen)
        for share in (0.28, 0.25, 0.31, 0.22):  # rim at the left of the ring
            page.mouse.click(x - share * box["height"], y)
            page.wait_for_timeout(300)
        page.wait_for_selector("table#probe")
        told = page.inner_text("table#probe")
        assert "MPa" in told
        assert "node" in told
        assert "tire" in told or "hub" in told

        page.click("#loads button:has-text('0 N') >> nth=0")
        caption(page, "(unloaded)")
        assert "0 MPa" in page.inner_text("table#probe")
        page.click("#play")
        caption(page, "200 N")

        page.set_input_files("#own-curve", folder.parent / "bad.csv")
        page.locator("#message", has_text="bad.csv").wait_for()
        page.set_input_files("#own-curve", folder.parent / "long.csv")
        page.locator("#message", has_text="long.csv: is empty, or larger than 1 MB").wait_for()
        page.set_input_files("#own-curve", folder.parent / "fe_phi000")  # takes no place of a curve of the folder
        page.locator("#chart .legend", has_text="fe_phi000 (yours)").wait_for()
        page.locator("#curves label", has_text="fe_phi000 (yours)").click()
        page.locator("#chart .legend", has_text="fe_phi000 (yours)").wait_for(state="detached")
        page.set_input_files("#own-curve", folder.parent / "mine.csv")
        page.locator("#chart .legend", has_text="mine.csv").wait_for()
        page.locator("#curves label", has_text="FE 0°").click()
        page.locator("#chart .legend", has_text="FE 0°").wait_for()
        page.fill("#curve-search", "0° fe")
        page.locator("#curves label", has_text="average").wait_for(state="detached")
        assert page.locator("#curves label").all_inner_texts() == ["FE 0°", "FE 30°"]
        page.click("#curves .group button:has-text('none')")  # of what is found alone
        page.locator("#chart .legend", has_text="FE 0°").wait_for(state="detached")
        page.fill("#curve-search", "")
        assert page.locator("#curves input:checked").count() == 2  # the average, and mine
        page.click("#curves .group:has-text('FE') button:has-text('all')")
        page.locator("#chart .legend", has_text="FE 0°").wait_for()

        wheel = pixels(page)
        page.click("#tab-rover")
        caption(page, "straight, brush tires")
        rover = until_changed(page, wheel)
        page.locator("#chart .legend", has_text="front left").wait_for()
        page.click("#play")
        page.locator(".player output", has_text="4.00 of 4.00 s").wait_for()
        until_changed(page, rover)
        places = page.evaluate("[document.querySelector('#frame').value, document.querySelector('#frame').max]")
        assert places == ["39", "39"]

        rover = pixels(page)
        page.click("#tab-modes")
        page.select_option("#mode-file", label="FE, held at its hub")
        caption(page, "mode 1: 18.54 Hz, torsional")
        first = until_changed(page, rover)
        page.select_option("#mode", label="2: 32.20 Hz, lateral")
        caption(page, "mode 2: 32.20 Hz, lateral")
        second = until_changed(page, first)
        page.locator("#amplitude").fill("20")
        until_changed(page, second)
        page.click("#play")
        seen = set()
        while len(seen) < 20:  # all moments of a turn, which goes on
            seen.add(page.inner_text(".player output"))
        page.click("#play")
        page.wait_for_selector("#play[aria-label='play']")
        browser.close()
    assert complaints == []
    home = address.partition("?")[0]
    strange = [url for url in asked if not url.startswith((home, "ws://127.0.0.1:", "data:", "blob:"))]
    assert strange == []
    assert any(url.startswith("ws://127.0.0.1:") for url in asked)
