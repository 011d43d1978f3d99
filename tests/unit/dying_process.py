"""Ends a child at its first, second, third ... file operation, as SIGKILL would: nothing is cleaned up.

A module of its own, run as a process: only one without threads may fork.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path

from workbench.execution.store import Store
from workbench.report.placing import new_files

OPERATIONS = ("open", "os.rename", "os.link", "os.remove", "os.mkdir", "os.rmdir", "shutil.rmtree")


def dies_at(number: int, act: Callable[[], object]) -> bool:
    """Whether the child that does this ended before its file operation of this number."""
    child = os.fork()
    if child == 0:
        count = 0

        def end(event: str, _: object) -> None:
            nonlocal count
            if event in OPERATIONS:
                count += 1
                if count == number:
                    os._exit(9)

        sys.addaudithook(end)
        act()
        os._exit(0)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 9


def publish(out: Path, texts: dict[str, str]) -> list[str]:
    """Write these as a command's whole set; what is told."""
    with new_files(out, "test", list(texts), whole_set=True) as new:
        for name, text in texts.items():
            (new.folder / name).write_text(text, encoding="utf-8")
    return new.told


def store_one(root: Path, key: str, text: str) -> None:
    """Store one result."""
    store = Store(root)
    store.sweep()
    folder = store.scratch()
    (folder / "a.txt").write_text(text, encoding="utf-8")
    store.put(key, folder, {"task": "t", "wall_s": 1.0})


if __name__ == "__main__":
    base, what = Path(sys.argv[1]), sys.argv[2]
    number = 1
    while True:
        out = base / str(number)
        if what == "publish":
            publish(out, {"c/stale.csv": "1", "c/edited.csv": "1", "page.html": "1"})
            (out / "c" / "edited.csv").write_text("user's", encoding="utf-8")
            (out / "c" / "new.csv").write_text("also user's", encoding="utf-8")
            died = dies_at(
                number, lambda out=out: publish(out, {"c/edited.csv": "2", "c/new.csv": "2", "page.html": "2"})
            )
        else:
            died = dies_at(number, lambda out=out: store_one(out, "ab" * 32, "result"))
        if not died:
            break
        number += 1
    print(number)
