"""What is answered at the page's address: its files, and a connection for each window.

Verified by tests/end_to_end/test_view_safety.py.
"""

from __future__ import annotations

import contextlib
from collections.abc import Awaitable, Callable, Mapping
from pathlib import Path
from typing import Any

from aiohttp import WSMsgType, web

from workbench.viewer.access import Access, entry_page, headers
from workbench.viewer.requests import LONGEST
from workbench.viewer.window import MOST, Windows

__all__ = ["site"]

_HEARTBEAT = 30.0
"""Time after which a browser that is gone is noticed [s]."""
_CLOSED = "this page is for the browser that was given its address: open the one that `workbench view` printed"
_FULL = f"{MOST} windows are open: close one, then reload this one"

type _Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


def site(windows: Windows, access: Access, files: Mapping[str, str]) -> web.Application:
    """An application that lets in who has the token or its cookie.

    files : folders by their place in the address, ``/`` being the page's
    """
    page = (Path(files["/"]) / "index.html").read_text(encoding="utf-8")

    async def index(_: web.Request) -> web.Response:
        if windows.full:
            raise web.HTTPServiceUnavailable(text=_FULL)
        return web.Response(text=page, content_type="text/html")

    async def where(_: web.Request) -> web.Response:
        """trame's page asks where to connect, and what to say there."""
        return web.json_response({"sessionURL": "ws://USE_HOST/ws", "secret": access.secret})

    async def connection(request: web.Request) -> web.WebSocketResponse:
        if windows.full:
            raise web.HTTPServiceUnavailable(text=_FULL)
        return await _connected(request, windows)

    application = web.Application(middlewares=[_guard(access)])
    said = headers(page, access)

    async def say(_: web.Request, response: web.StreamResponse) -> None:
        response.headers.update(said)

    application.on_response_prepare.append(say)
    application.router.add_get("/", index)
    application.router.add_get("/index.html", index)
    application.router.add_post("/paraview/", where)
    application.router.add_get("/ws", connection)
    for place in sorted(files, reverse=True):
        application.router.add_static(f"/{place.strip('/')}", files[place])
    return application


def _guard(access: Access) -> Any:
    @web.middleware
    async def ours(request: web.Request, handler: _Handler) -> web.StreamResponse:
        """Nothing for another site's script, and nothing without a key."""
        if not access.asked_of_us(request.headers.get("Host", ""), request.headers.get("Origin")):
            raise web.HTTPForbidden(text="this page is for its own machine only")
        if request.path == "/" and access.opens(request.query.get("token", "")):
            answer = web.Response(text=entry_page(), content_type="text/html")
            answer.set_cookie(*access.cookie, httponly=True, samesite="Strict", path="/")
            return answer
        if not access.knows(request.cookies.items()):
            raise web.HTTPForbidden(text=_CLOSED)
        return await handler(request)

    return ours


async def _connected(request: web.Request, windows: Windows) -> web.WebSocketResponse:
    """One window, from its opening to its end."""
    answer = web.WebSocketResponse(max_msg_size=LONGEST, heartbeat=_HEARTBEAT, compress=False)
    await answer.prepare(request)
    window = await windows.take()
    connection = await window.endpoint.connect()

    async def send(_: bool, message: bytes) -> None:
        with contextlib.suppress(ConnectionError, RuntimeError):  # it is gone
            await answer.send_bytes(message)

    connection.on_message(send)
    try:
        async for message in answer:
            if message.type is WSMsgType.BINARY:
                await window.hear(message.data, connection.client_id)
    finally:
        await connection.close()
        windows.give_back(window)
    return answer
