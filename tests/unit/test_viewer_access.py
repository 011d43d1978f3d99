"""Keys of one start, and what every answer says."""

from __future__ import annotations

import base64
import hashlib
from pathlib import Path

import pytest
from trame.app import get_server

from workbench.viewer import page
from workbench.viewer.access import Access, headers

ACCESS = Access("127.0.0.1", 8765)


def test_each_start_has_keys_of_its_own() -> None:
    other = Access("127.0.0.1", 8765)
    keys = {one for access in (ACCESS, other) for one in (access.token, access.cookie[1], access.secret)}
    assert len(keys) == 6
    assert min(map(len, keys)) >= 43  # 256 bits
    assert ACCESS.cookie[0] != Access("127.0.0.1", 8766).cookie[0]


def test_the_token_and_the_cookie_open_and_nothing_like_them() -> None:
    name, value = ACCESS.cookie
    assert ACCESS.opens(ACCESS.token)
    assert ACCESS.knows([("other", "x"), (name, value)])
    for wrong in ("", ACCESS.token[:-1], f"{ACCESS.token} ", value, "ü", "\udcff"):
        assert not ACCESS.opens(wrong)
    for cookies in ([], [(name, "")], [(name, ACCESS.token)], [("other", value)], [(name, "\udcff")]):
        assert not ACCESS.knows(cookies)


@pytest.mark.parametrize(
    ("host", "origin", "ours"),
    [
        ("127.0.0.1:8765", None, True),
        ("localhost:8765", "http://localhost:8765", True),
        ("127.0.0.1:8765", "http://127.0.0.1:8765", True),
        ("127.0.0.1:8766", None, False),
        ("127.0.0.1", None, False),
        ("rebound.example:8765", None, False),
        ("127.0.0.1:8765", "http://elsewhere.example", False),
        ("127.0.0.1:8765", "http://127.0.0.1:8766", False),
        ("127.0.0.1:8765", "https://127.0.0.1:8765", False),
        ("127.0.0.1:8765", "null", False),
        ("127.0.0.1:8765", "", False),
    ],
)
def test_only_our_own_pages_ask(host: str, origin: str | None, ours: bool) -> None:
    assert ACCESS.asked_of_us(host, origin) is ours


def test_the_policy_names_the_page_s_scripts_and_no_other_host() -> None:
    said = headers("<p><script>go()</script><script src='x.js'></script>", ACCESS)
    policy = dict(rule.split(" ", 1) for rule in said["Content-Security-Policy"].split("; "))
    digest = base64.b64encode(hashlib.sha256(b"go()").digest()).decode()
    assert policy["script-src"] == f"'self' 'unsafe-eval' 'sha256-{digest}'"
    assert policy["default-src"] == policy["frame-ancestors"] == policy["form-action"] == "'none'"
    assert "unsafe-inline" not in policy["script-src"]
    hosts = {word for rule in policy.values() for word in rule.split() if "//" in word}
    assert hosts == {"ws://127.0.0.1:8765", "ws://localhost:8765"}


def test_a_secret_may_begin_with_a_dash() -> None:
    """One in 64 does; behind a blank it was taken for an option, and the viewer did not start."""
    server = get_server("secret with a dash")
    assert server.cli.parse_known_args(["--authKey=-abc"])[0].authKey == "-abc"
    source = Path(page.__file__).read_text(encoding="utf-8")
    assert 'f"--authKey={secret}"' in source
