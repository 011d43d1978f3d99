"""Who may look at results, what a page may ask, what names in the folder may do; two windows do not steer each other.

Claim: without the token or its cookie nothing is answered; whatever a browser sends, nothing is written on the
terminal and the page goes on; a file's name is text; a link out of the folder is not followed.
"""

from __future__ import annotations

import asyncio
import math
import os
import shutil
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import aiohttp
import pytest

from tests.end_to_end.test_view import ARGUMENTS, CHROMIUM, PATIENCE, start
from tests.listening import listening
from tests.small_report_folder import write_small_report
from tests.viewer_client import Client, browser
from workbench.viewer.window import MOST

NAMES = (
    "<img src=x onerror=document.pwned=1>.csv",
    "{{ document.pwned=1 }}.csv",
    "two\nlines.csv",
    "\x1b[31mred.csv",
    "\udcff\udcfe.csv",
    "\u202egnp.csv",
    "' \" & $x^2$ `.csv",
    f"{'long' * 60}.csv",
)
"""Of curves; a lone surrogate stands for a byte that is no UTF-8."""
NONSENSE: tuple[Any, ...] = (
    *("", "abc", "1", "../../etc/passwd", "<b>", "\x00\n", "x" * 100_000, b"\xff", None, [], {}, [[]], ["nope"]),
    *(-1, 10**6, 2**63, 1.5, math.nan, math.inf, True, {"value": 1}),
)
KEYS = (
    *("tab", "model", "orientation", "load", "quantity", "mark_yield", "visible", "cut_axis", "cut_step"),
    *("cut_other_side", "scenario", "tire", "series", "chosen", "frame", "playing"),
    *("mode_file", "mode", "amplitude"),
)
FOREIGN = ("speed", "figure", "study", "models", "last_frame", "scene_view", "trame__title", "trame__scripts", "nope")
SENSIBLE = [
    *(("chosen", []), ("playing", True), ("visible", []), ("mark_yield", True), ("cut_axis", "")),
    ("cut_other_side", True),
]
TRIGGERS: tuple[tuple[Any, ...], ...] = (
    *((), (None,), (3,), ("nope", [], {}), ("__init__", [], {}), ("look", [1], {}), ("look", 3, {}), ("drawn", ["x"])),
    *(("probe", [one], {}) for one in (1, "x", {}, {"ray": 1}, {"ray": [[1, 2, 3]]}, {"ray": [["a", 0, 0]] * 2})),
    *(("probe", [{"ray": [[math.nan, 0, 0], [1, 1, 1]]}], {}), ("probe", [{"ray": [[1e300] * 3] * 2}], {})),
    *(("add_curve", one, {}) for one in ([], ["x"], [1, 2], ["x" * 10_000, "y"], [{}, []], ["bad.csv", "a,b\n1,x"])),
)
METHODS = (
    *(
        "application.exit",
        "application.exit.later",
        "viewport.image.push",
        "viewport.mouse.interaction",
        "nope",
        "../x",
    ),
    *("trame.force.push", "viewport.geometry.array.get", "trame.lifecycle.update", "trame.error.client"),
)
PIECES = (
    (b"", None, 0),
    (b"\xc1", None, 0),
    (b"\x81" * 9, 2**31, 0),
    (b"\x01", None, 2**31),
    (b"\x91" * 5000, None, 0),
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A report's folder with names that nobody means well, and links out of it."""
    root = tmp_path_factory.mktemp("safety")
    (path := root / "report").mkdir()
    write_small_report(path)
    for name in NAMES:
        shutil.copy(path / "curves" / "fe_phi000.csv", path / "curves" / name)
    shutil.copy(path / "fields" / "fe_phi000_200N.vtu", path / "fields" / "<i>\n_phi000_200N.vtu")
    shutil.copy(path / "motions" / "straight_brush.npz", path / "motions" / "<u>\x07_brush.npz")
    (root / "secret.csv").write_text("deflection_m,load_N\n0,0\n0.02,150\n", encoding="utf-8")
    (path / "curves" / "way\nout.csv").symlink_to(root / "secret.csv")
    (path / "curves" / "round.csv").symlink_to(path / "curves" / "round.csv")
    os.mkfifo(path / "curves" / "pipe.csv")
    return path


@pytest.fixture(scope="module")
def address(folder: Path) -> Iterator[str]:
    """Of one viewer for all tests; on the terminal it says what was left out, and nothing else until its end."""
    process = start(str(folder))
    assert process.stdout is not None
    line = process.stdout.readline().strip()
    assert line.startswith("http://127.0.0.1:"), process.communicate()[1]
    assert listening(process.pid) == {("tcp", "127.0.0.1")}
    yield line
    process.send_signal(signal.SIGINT)
    out, err = process.communicate()
    assert (process.returncode, out) == (0, "")
    said = [one.partition(" is left out")[0] for one in err.splitlines()]
    assert said == [f"workbench: warning: curves/{name}" for name in ("pipe.csv", "round.csv", "way\\nout.csv")]


def test_nobody_looks_without_the_address(address: str) -> None:
    asyncio.run(_nobody(address))


async def _nobody(address: str) -> None:
    parts = urlsplit(address)
    home, evil = f"http://{parts.netloc}", {"Origin": "http://elsewhere.example"}
    assert len(parts.query) > len("token=") + 40
    places = ("/", "/index.html", "/plotly/plotly.min.js", "/vue.global.js", "/ws", "/nowhere", "/?token=", "/?token=x")
    async with browser() as stranger:
        for place in places:
            async with stranger.get(f"{home}{place}") as answer:
                assert answer.status == 403, place
                assert "frame-ancestors 'none'" in answer.headers["Content-Security-Policy"]
        async with stranger.post(f"{home}/paraview/") as answer:
            assert answer.status == 403
        with pytest.raises(aiohttp.WSServerHandshakeError, match="403"):
            await stranger.ws_connect(f"{home}/ws")
    async with browser() as friend:
        async with friend.get(address) as answer:
            assert answer.status == 200
            cookie = answer.headers["Set-Cookie"]
            assert parts.query.removeprefix("token=") not in cookie
            assert cookie.startswith(f"workbench-view-{parts.port}=")
            assert {"HttpOnly", "SameSite=Strict"} <= set(cookie.split("; "))
        async with friend.get(f"{home}/") as answer:
            assert answer.status == 200
            said = answer.headers
            assert (said["X-Frame-Options"], said["X-Content-Type-Options"]) == ("DENY", "nosniff")
            assert (said["Referrer-Policy"], said["Cache-Control"]) == ("no-referrer", "no-store")
            assert "default-src 'none'" in said["Content-Security-Policy"]
            assert "http" not in said["Content-Security-Policy"].replace("http-equiv", "")
        for headers in ({"Host": f"elsewhere.example:{parts.port}"}, {"Host": "127.0.0.1:1"}, evil, {"Origin": "null"}):
            async with friend.get(f"{home}/", headers=headers) as answer:
                assert answer.status == 403, headers
        for origin in ("http://elsewhere.example", f"http://127.0.0.1:{parts.port - 1}", f"https://{parts.netloc}"):
            with pytest.raises(aiohttp.WSServerHandshakeError, match="403"):
                await friend.ws_connect(f"{home}/ws", headers={"Origin": origin})
        socket = Client(await friend.ws_connect(f"{home}/ws"))
        assert "error" in await socket.call("wslink.hello", {"secret": "wslink-secret"}, kind="system")
        assert "error" in await socket.call("trame.state.get")


def test_nonsense_is_answered_in_words_and_the_page_goes_on(address: str) -> None:
    assert asyncio.run(talk_nonsense(address)) >= 300


async def talk_nonsense(address: str) -> int:
    """Number of messages after which the state was what it had been, and a sensible one was heard."""
    async with browser() as session:
        client, count = await Client.open(session, address), 0
        before = {key: client.state[key] for key in KEYS}
        for key in (*KEYS, *FOREIGN):
            for value in NONSENSE:
                if (key, value) not in SENSIBLE:
                    _refused(await client.choose(**{key: value}))
                    count += 1
        for changes in (None, 3, "x", {}, [None], [[]], [{}], [{"key": 3}], [{"key": "load"}], [{"key": ["load"]}]):
            _refused(await client.call("trame.state.update", changes))
            count += 1
        for given in TRIGGERS:
            answer = await client.call("trame.trigger", *given)
            assert "Traceback" not in str(answer), answer
            count += 1
        for method in METHODS:
            for one in NONSENSE:
                answer = await client.call(method, one)
                assert "Traceback" not in str(answer), answer
                count += 1
        for content, size, offset in PIECES:
            await client.send_bytes(content, size=size, offset=offset)
        for message in (None, 3, [], {"id": 3}, {"id": "a"}, {"id": "a", "method": []}, {"id": "a", "method": "x"}):
            await client.send(message)
        await client.socket.send_str("text")
        count += len(PIECES) + 8
        after = await client.look()
        assert {key: after[key] for key in KEYS} == before
        assert "bad.csv" in after["message"]
        await client.choose(load=1)
        assert (await client.look())["load"] == 1
        return count


def _refused(answer: dict[str, Any]) -> None:
    assert "error" in answer
    assert "Traceback" not in str(answer)


def test_windows_do_not_steer_each_other(address: str) -> None:
    asyncio.run(_windows(address))


async def _windows(address: str) -> None:
    async with browser() as session:
        first, second = await Client.open(session, address), await Client.open(session, address)
        before = await second.look()
        await first.choose(orientation=30.0)
        await first.choose(load=1, quantity="displacement")
        await first.call("trame.trigger", "add_curve", ["mine.csv", "deflection_m,load_N\n0,0\n0.02,150\n"], {})
        await first.choose(playing=True)
        now = await first.look()
        assert (now["orientation"], now["quantity"]) == (30.0, "displacement")
        assert "mine.csv" in now["chosen"]
        assert await second.look() == before
        await first.socket.close()
        third = await Client.open(session, address)  # may have the first one's page, and finds it new
        assert {k: v for k, v in third.state.items() if k != "scene_view"} == {
            k: v for k, v in before.items() if k != "scene_view"
        }
        others = [await Client.open(session, address) for _ in range(MOST - 2)]
        async with session.get(f"http://{urlsplit(address).netloc}/") as answer:
            assert answer.status == 503
        await others[0].socket.close()
        async with asyncio.timeout(300):
            while (await session.get(f"http://{urlsplit(address).netloc}/")).status != 200:
                await asyncio.sleep(0.1)
        others[0] = await Client.open(session, address)
        assert await second.look() == before


def test_names_are_text_and_a_second_window_is_its_own(address: str) -> None:
    if CHROMIUM is None:
        assert os.environ.get("CI") != "true", "CI must have Chromium on PATH"
        pytest.skip("no Chromium on PATH")
    from playwright.sync_api import Page, sync_playwright

    complaints: list[str] = []

    def opened(page: Page, where: str) -> Page:
        page.set_default_timeout(PATIENCE)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("console", lambda said: complaints.append(said.text) if said.type == "error" else None)
        page.goto(where)
        page.locator("#caption", has_text="200 N").wait_for()
        page.wait_for_selector("#chart .main-svg")
        return page

    with sync_playwright() as playwright:
        context = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS).new_context()
        first = opened(context.new_page(), address)
        home = f"http://{urlsplit(address).netloc}/"
        assert first.url == home  # the token does not stay in the bar
        second = opened(context.new_page(), home)
        names = second.inner_text("#curves")
        for shown in (
            "<img src=x",
            "{{ document.pwned=1 }}",
            "two\\nlines",
            "\\x1b[31mred",
            "\\udcff\\udcfe",
            "\\u202egnp",
        ):
            assert shown in names
        for label in second.locator("#curves label").all():
            label.click()
        second.locator("#chart .legend", has_text="<img src=x").wait_for()
        assert second.evaluate("document.pwned") is None
        caption, picture = second.inner_text("#caption"), second.locator(".stage canvas").first.screenshot()
        first.click("#orientations button:has-text('30°')")
        first.locator("#caption", has_text="30° down").wait_for()
        first.click("#tab-rover")
        first.locator("#caption", has_text="brush tires").wait_for()
        assert second.inner_text("#caption") == caption
        assert second.locator(".stage canvas").first.screenshot() == picture
        assert complaints == []
        first.reload()
        first.locator("#caption", has_text="FE, 0° down, 200 N").wait_for()
        left = [said for said in complaints if "connection not open" not in said]  # of the page that was left
        context.browser.close() if context.browser else None
    assert left == []
