"""Serves the page on this machine's loopback interface until a signal ends it.

Verified by tests/end_to_end/test_view.py.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import socket
import sys
import webbrowser
from typing import Any

from contracts.errors import InputError

__all__ = ["HOST", "serve"]

HOST = "127.0.0.1"
_PATIENCE = 1.0
"""Longest wait for browsers to part [s]."""


def serve(server: Any, port: int, *, open_browser: bool) -> None:
    """Serve until SIGINT or SIGTERM; prints the address once.

    Parameters
    ----------
    server : trame's, with its page
    port : 0 for any that is free
    open_browser : whether to open the address

    Raises
    ------
    InputError
        If the port cannot be had.
    """
    _check_port(port)
    os.environ["WSLINK_READY_MSG"] = ""  # else it prints on stdout
    asyncio.run(_served(server, port, open_browser=open_browser))


def _check_port(port: int) -> None:
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((HOST, port))
        except OSError as error:
            rule = f"cannot be used ({error.strerror or error})"
            raise InputError("port", port, rule, "leave out --port for one that is free") from error


async def _served(server: Any, port: int, *, open_browser: bool) -> None:
    ended = asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        asyncio.get_running_loop().add_signal_handler(number, ended.set)

    def ready(**_: Any) -> None:
        address = f"http://{HOST}:{server.port}/"
        sys.stdout.write(f"{address}\n")
        sys.stdout.flush()
        if open_browser:
            webbrowser.open(address)

    server.controller.on_server_ready.add(ready)
    server.controller.on_server_bind.add(_guard)
    server.cli.parse_known_args = lambda *_: type(server.cli).parse_known_args(server.cli, [])  # ours is parsed
    running = server.start(
        host=HOST,
        port=port,
        exec_mode="task",
        open_browser=False,
        show_connection_info=False,
        disable_logging=True,
        thread=True,  # the signals are ours
        timeout=0,
    )
    await asyncio.wait({running, asyncio.create_task(ended.wait())}, return_when=asyncio.FIRST_COMPLETED)
    if running.done():
        running.result()
    with contextlib.suppress(TimeoutError):
        await asyncio.wait_for(server.stop(), _PATIENCE)


def _guard(bound: Any) -> None:
    """Answer only what was asked of this address, by a page of ours: no other site's script may look in."""
    from aiohttp import web

    @web.middleware
    async def ours(request: web.Request, handler: Any) -> web.StreamResponse:
        hosts = {f"{name}:{bound.get_port()}" for name in (HOST, "localhost")}
        origin = request.headers.get("Origin")
        if request.host not in hosts or (origin is not None and origin.partition("://")[2] not in hosts):
            raise web.HTTPForbidden(text="this page is for its own machine only")
        answer: web.StreamResponse = await handler(request)
        return answer

    async def session(_: web.Request) -> web.Response:
        return web.json_response({"sessionURL": "ws://USE_HOST/ws"})  # trame's page asks where to connect

    bound.app.middlewares.append(ours)
    bound.app.router.add_post("/paraview/", session)
