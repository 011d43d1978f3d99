"""Windows that are open, each with a page of its own, and pages that wait for the next.

Verified by tests/end_to_end/test_view_safety.py.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable

from workbench.viewer.window import Window

__all__ = ["MOST", "Windows"]

MOST = 16
"""Windows at once; each holds a copy of what it shows."""


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
