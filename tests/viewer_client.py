"""A browser's side of the viewer's connection, to say what no browser would: wslink's framing by hand."""

from __future__ import annotations

import asyncio
from typing import Any
from urllib.parse import urlsplit

import aiohttp
import msgpack

__all__ = ["Client", "browser"]

PATIENCE = 300.0
"""Longest wait for an answer on a busy machine [s]."""


def browser() -> aiohttp.ClientSession:
    """One that keeps cookies of addresses without a name."""
    return aiohttp.ClientSession(cookie_jar=aiohttp.CookieJar(unsafe=True))


class Client:
    """One window."""

    def __init__(self, socket: aiohttp.ClientWebSocketResponse) -> None:
        self.socket = socket
        self.state: dict[str, Any] = {}
        self._count = 0

    @classmethod
    async def open(cls, session: aiohttp.ClientSession, address: str) -> Client:
        """As the page does: where to connect, what to say, the whole state."""
        home = f"http://{urlsplit(address).netloc}"
        async with session.get(address) as answer:
            assert answer.status == 200
        async with session.post(f"{home}/paraview/") as answer:
            told = await answer.json()
        client = cls(await session.ws_connect(f"{home.replace('http', 'ws')}/ws", max_msg_size=0))
        hello = await client.call("wslink.hello", {"secret": told.get("secret", "wslink-secret")}, kind="system")
        assert "clientID" in hello["result"]
        client.state = (await client.call("trame.state.get"))["result"]["state"]
        return client

    async def send(self, message: object) -> None:
        """Pack and frame anything."""
        await self.send_bytes(msgpack.packb(message))

    async def send_bytes(self, content: bytes, *, size: int | None = None, offset: int = 0) -> None:
        """Frame bytes, truly or not."""
        self._count += 1
        numbers = (self._count % 2**32, offset, len(content) if size is None else size)
        await self.socket.send_bytes(b"".join(n.to_bytes(4, "little") for n in numbers) + content)

    async def call(self, method: str, *args: object, kind: str = "rpc") -> dict[str, Any]:
        """Ask and wait for the answer; what is published meanwhile is taken up."""
        number = f"{kind}:c0:{self._count}"
        await self.send({"wslink": "1.0", "id": number, "method": method, "args": list(args), "kwargs": {}})
        while True:
            told = await self.hear()
            if told.get("id") == number:
                return told

    async def hear(self) -> dict[str, Any]:
        """The next message; changes of the state are kept."""
        whole = b""
        while True:
            piece = await asyncio.wait_for(self.socket.receive_bytes(), PATIENCE)
            whole += piece[12:]
            if len(whole) >= int.from_bytes(piece[8:12], "little"):
                break
        told: dict[str, Any] = msgpack.unpackb(whole, strict_map_key=False)
        if str(told.get("id")).startswith("publish:trame.state.topic"):
            self.state |= told["result"]
        return told

    async def look(self) -> dict[str, Any]:
        """The whole state as the server has it now."""
        self.state = (await self.call("trame.state.get"))["result"]["state"]
        return self.state

    async def choose(self, **choices: object) -> dict[str, Any]:
        """Change the page's choices."""
        return await self.call("trame.state.update", [{"key": k, "value": v} for k, v in choices.items()])
