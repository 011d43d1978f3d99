"""Serves the page on this machine's loopback interface until a signal ends it.

Verified by tests/end_to_end/test_view.py.
"""

from __future__ import annotations

import asyncio
import contextlib
import functools
import logging
import os
import signal
import socket
import sys
import webbrowser

from aiohttp import web

from contracts.errors import InputError
from workbench.viewer.access import Access
from workbench.viewer.page import open_page
from workbench.viewer.results import Results
from workbench.viewer.site import site
from workbench.viewer.window import Windows

__all__ = ["HOST", "serve"]

HOST = "127.0.0.1"
_PATIENCE = 1.0
"""Longest wait for browsers to part [s]."""


def serve(results: Results, port: int, *, open_browser: bool) -> None:
    """Serve until SIGINT or SIGTERM; prints the address once.

    Parameters
    ----------
    results : what the page shows
    port : 0 for any that is free
    open_browser : whether to open the address

    Raises
    ------
    InputError
        If the port cannot be had.
    """
    for name in ("wslink", "trame", "trame_server", "trame_vtk", "aiohttp"):  # what a browser does wrong is no news
        logging.getLogger(name).addHandler(logging.NullHandler())
        logging.getLogger(name).propagate = False
    with _listening(port) as listener:
        asyncio.run(_served(results, listener, open_browser=open_browser))


def _listening(port: int) -> socket.socket:
    try:
        return socket.create_server((HOST, port))
    except OSError as error:
        rule = f"cannot be used ({os.strerror(error.errno) if error.errno else error})"
        raise InputError("port", port, rule, "leave out --port for one that is free") from error


async def _served(results: Results, listener: socket.socket, *, open_browser: bool) -> None:
    ended = asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        asyncio.get_running_loop().add_signal_handler(number, ended.set)
    access = Access(HOST, listener.getsockname()[1])
    windows = Windows(functools.partial(open_page, results, access.secret))
    application = site(windows, access, await windows.begin())
    runner = web.AppRunner(application, handle_signals=False, access_log=None, shutdown_timeout=_PATIENCE)
    await runner.setup()
    await web.SockSite(runner, listener).start()
    sys.stdout.write(f"{access.address}\n")
    sys.stdout.flush()
    if open_browser:
        webbrowser.open(access.address)
    await ended.wait()
    with contextlib.suppress(TimeoutError):
        await asyncio.wait_for(runner.cleanup(), 2.0 * _PATIENCE)
