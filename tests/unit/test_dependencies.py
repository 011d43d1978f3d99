"""The pins with hashes are the pins, without addresses; the page of licences is what the installed packages say."""

from __future__ import annotations

import re
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs" / "hooks"))

import dependencies  # type: ignore[import-not-found]  # noqa: E402

PIN = re.compile(r"([a-z0-9.-]+)==(\S+)")


def pins(name: str) -> dict[str, str]:
    text = (ROOT / name).read_text(encoding="utf-8")
    return dict(PIN.findall("\n".join(line for line in text.splitlines() if not line.startswith("#"))))


def test_every_pin_has_its_hashes_and_no_address() -> None:
    text = (ROOT / "constraints-hashes.txt").read_text(encoding="utf-8")
    assert pins("constraints-hashes.txt") == pins("constraints.txt")
    assert len(pins("constraints.txt")) > 100
    body = "\n".join(line for line in text.splitlines() if not line.startswith("#"))
    for entry in re.split(r"\n(?=\S)", body):
        assert re.fullmatch(r"\S+==\S+(?: \\\n    --hash=sha256:[0-9a-f]{64})+", entry.strip()), entry[:80]
    assert not re.search(r"://|index|find-links|@", text)


def test_every_dependency_stands_on_the_page_with_its_licence() -> None:
    page = dependencies.PAGE.read_text(encoding="utf-8")
    direct, further = dependencies.run_time()
    assert {"gmsh", "numpy", "rasterio", "distributed"} <= direct.keys() == dependencies.PURPOSES.keys()
    assert len(further) > 40
    for name, found in (direct | further).items():
        assert re.search(rf"^\| {re.escape(name)} \|.*{re.escape(dependencies.licence(found))}", page, re.MULTILINE)
        assert name in pins("constraints.txt")
    assert dependencies.written(page) == page


def test_copyleft_is_marked() -> None:
    page = dependencies.PAGE.read_text(encoding="utf-8")
    assert re.search(r"^\| gmsh \|.*\*\*GNU General Public License v2 or later", page, re.MULTILINE)
    assert not re.search(r"^\| numpy \|.*\*\*", page, re.MULTILINE)
