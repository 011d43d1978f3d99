"""One browser window: its connection is read, what makes sense is done by its own session, the rest answered in words.

And all that are open, each with a page of its own, and pages that wait for the next.

Verified by tests/end_to_end/test_view.py and tests/end_to_end/test_view_safety.py.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Coroutine
from typing import Any

from workbench.viewer.requests import CHOICES, Refused, Request, allowed_change, allowed_trigger, read_request
from workbench.viewer.session import Session

__all__ = ["MOST", "Window", "Windows"]

MOST = 16
"""Windows at once; each holds a copy of what it shows."""
_REFUSED, _FAILED = -32602, -32001
"""Codes of answers."""
_UNHEARD = ("trame.lifecycle.update", "trame.error.client")
"""What trame's page tells on its own and nobody here needs."""


class Window:
    """A page's server and session, used by one connection after the other and never by two at once.

    Parameters
    ----------
    server : trame's, running without a port of its own
    session : that the page's choices steer
    """

    def __init__(self, server: Any, session: Session) -> None:
        self.server, self.session = server, session
        self._bound: Any = None
        self._running: set[asyncio.Task[None]] = set()

    def bind(self, bound: Any) -> None:
        """Take what trame would have others connect to."""
        self._bound = bound

    @property
    def endpoint(self) -> Any:
        """Where connections are made."""
        return self._bound["ws"]

    @property
    def files(self) -> dict[str, str]:
        """Folders that the page loads from, by their place in its address."""
        return dict(self._bound.config["static"])

    def run(self, deed: Coroutine[Any, Any, None]) -> None:
        """Do something beside the connection, until it ends."""
        task = asyncio.create_task(deed)
        self._running.add(task)
        task.add_done_callback(self._running.discard)

    def renew(self) -> None:
        """Get ready for another browser."""
        for task in self._running:
            task.cancel()
        self.session.renew()

    async def hear(self, message: bytes, client: str) -> None:
        """Do what a message asks, and answer it."""
        endpoint = self.endpoint
        try:
            request = read_request(message)
        except Refused:
            return  # nobody can be told, as its number is not known
        if request.method == "wslink.hello" or not endpoint.isClientAuthenticated(client):
            call = {"id": request.number, "method": request.method, "args": _hello(request)}
            await endpoint.onCompleteMessage(call, client)
            return
        self._bound.last_active_client_id = client
        try:
            answer = await self._done(request)
        except Refused as refusal:
            await endpoint.sendWrappedError(request.number, _REFUSED, str(refusal), client_id=client)
        except Exception as error:  # the page goes on, whatever happens
            text = f"this could not be done ({type(error).__name__}); a defect of the workbench, please report it"
            await endpoint.sendWrappedError(request.number, _FAILED, text, client_id=client)
        else:
            await endpoint.sendWrappedMessage(request.number, answer, method=request.method, client_id=client)

    async def _done(self, request: Request) -> Any:
        """The answer; raises Refused."""
        method, arguments = request.method, request.arguments
        if method == "trame.state.get":
            return self.server.protocol_call(method)
        if method == "trame.state.update":
            return self._changed(arguments[0] if arguments else None)
        if method == "trame.trigger":
            name, given = allowed_trigger(arguments)
            return await self.server.protocol_call(method, name, given, {})
        if method == "viewport.geometry.array.get":
            return self._array(arguments)
        if method in _UNHEARD:
            return None
        raise Refused("there is no such method")

    def _changed(self, changes: object) -> None:
        """One change after the other, as each decides what is on offer to the next; a refused one is put right."""
        if not isinstance(changes, list):
            raise Refused("changes come as a list")
        refusal = None
        for change in changes:
            try:
                name, value = allowed_change(self.session, change)
                self.server.protocol_call("trame.state.update", [{"key": name, "value": value}])
            except Refused as error:
                refusal = error
                self._put_right(change)
        if refusal is not None:
            raise refusal

    def _put_right(self, change: object) -> None:
        """Tell the page what a choice of its own is here."""
        name = change.get("key") if isinstance(change, dict) else None
        if isinstance(name, str) and name in CHOICES:
            self.server.protocol_call("trame.force.push", name)

    def _array(self, arguments: list[Any]) -> Any:
        """Numbers of the scene, by the name it has for them."""
        if not arguments or not isinstance(arguments[0], str):
            raise Refused("an array has a name")
        try:
            return self.server.protocol_call("viewport.geometry.array.get", arguments[0], True)
        except KeyError:
            raise Refused("there is no such array") from None


class Windows:
    """A page for each connection. The page of a window that was closed is made new for the next one and never let go:
    its scene's objects keep their addresses, by which the browsers know them.

    Parameters
    ----------
    open_page : makes another page, by its number
    """

    def __init__(self, open_page: Callable[[int], Awaitable[Window]]) -> None:
        self._open_page = open_page
        self._waiting: list[Window] = []
        self._opened = 0

    @property
    def full(self) -> bool:
        """Whether no further window can be opened."""
        return not self._waiting and self._opened >= MOST

    async def begin(self) -> dict[str, str]:
        """Open the first page; folders that all of them load from, by their place in the address."""
        self._waiting.append(await self._another())
        return self._waiting[0].files

    async def take(self) -> Window:
        """A page for a new window, if not `full`."""
        return self._waiting.pop() if self._waiting else await self._another()

    def give_back(self, window: Window) -> None:
        """Of a window that was closed."""
        window.renew()
        self._waiting.append(window)

    async def _another(self) -> Window:
        self._opened += 1
        return await self._open_page(self._opened)


def _hello(request: Request) -> list[Any]:
    """Its one argument, as wslink takes it."""
    first = request.arguments[0] if request.arguments else None
    secret = first.get("secret") if isinstance(first, dict) else None
    return [{"secret": secret if isinstance(secret, str) else ""}]
