"""Who may look: the page answers the one browser that was given the address, and no page of another site.

The address holds a token, new at each start; the first visit exchanges it for a cookie, so that reloading and further
windows do without. Verified by tests/unit/test_viewer_access.py and tests/end_to_end/test_view_safety.py.
"""

from __future__ import annotations

import base64
import hashlib
import re
import secrets
from collections.abc import Iterable

__all__ = ["Access", "entry_page", "headers"]

_INLINE = re.compile(r"<script>(.*?)</script>", re.DOTALL)


class Access:
    """The keys of one start.

    Attributes
    ----------
    token : in the address
    cookie : name and value of what it is exchanged for; the name holds the port, as cookies are shared by all ports
    secret : that a window says first over its connection
    """

    def __init__(self, host: str, port: int) -> None:
        self.host, self.port = host, port
        self.token, self.secret = secrets.token_urlsafe(32), secrets.token_urlsafe(32)
        self.cookie = (f"workbench-view-{port}", secrets.token_urlsafe(32))

    @property
    def address(self) -> str:
        """Of the page, with the token."""
        return f"http://{self.host}:{self.port}/?token={self.token}"

    def asked_of_us(self, host: str, origin: str | None) -> bool:
        """Whether a request names this address as its target, and comes from one of its pages or from no page."""
        ours = {f"{name}:{self.port}" for name in (self.host, "localhost")}
        if self.port == 80:
            ours |= {self.host, "localhost"}
        return host in ours and (origin is None or origin in {f"http://{one}" for one in ours})

    def opens(self, token: str) -> bool:
        """Whether this is the token."""
        return secrets.compare_digest(token.encode(errors="replace"), self.token.encode())

    def knows(self, cookies: Iterable[tuple[str, str]]) -> bool:
        """Whether our cookie is among these."""
        name, value = self.cookie
        return any(
            one == name and secrets.compare_digest(given.encode(errors="replace"), value.encode())
            for one, given in cookies
        )


def entry_page() -> str:
    """What the token's address answers: on to the page, as a step of our own, with which a strict cookie travels."""
    return (
        '<!doctype html><meta charset="utf-8"><meta http-equiv="refresh" content="0;url=/">'
        '<title>wheel workbench</title><p><a href="/">Results</a></p>'
    )


def headers(page: str, access: Access) -> dict[str, str]:
    """Of every answer: nothing from elsewhere, in no frame, kept by nobody.

    page : the HTML whose own scripts may run

    Relaxations of the policy: ``unsafe-eval``, since Vue compiles the page's template in the browser; ``unsafe-inline``
    for styles, since Plotly and Vue write them into elements; ``data:`` and ``blob:`` for pictures, which Plotly and
    vtk.js draw so. Scripts within the HTML are named by their hash.
    """
    digests = (hashlib.sha256(script.encode()).digest() for script in _INLINE.findall(page))
    hashes = " ".join(f"'sha256-{base64.b64encode(digest).decode()}'" for digest in digests)
    sockets = " ".join(f"ws://{name}:{access.port}" for name in (access.host, "localhost"))
    policy = {
        "default-src": "'none'",
        "script-src": f"'self' 'unsafe-eval' {hashes}".strip(),
        "style-src": "'self' 'unsafe-inline'",
        "img-src": "'self' data: blob:",
        "font-src": "'self' data:",
        "connect-src": f"'self' {sockets}",
        "base-uri": "'self'",
        "form-action": "'none'",
        "frame-ancestors": "'none'",
    }
    return {
        "Content-Security-Policy": "; ".join(f"{name} {value}" for name, value in policy.items()),
        "X-Frame-Options": "DENY",
        "X-Content-Type-Options": "nosniff",
        "Referrer-Policy": "no-referrer",
        "Cross-Origin-Opener-Policy": "same-origin",
        "Cross-Origin-Resource-Policy": "same-origin",
        "Cache-Control": "no-store",
    }
