"""Standard streams that are closed or full: the exit status still tells, and nothing ends in a traceback."""

from __future__ import annotations

import shlex
import subprocess
from pathlib import Path

import pytest

from tests.end_to_end.small_study import command, environment


@pytest.mark.parametrize(
    ("arguments", "streams", "status"),
    [
        (("--help",), ">&-", 0),
        (("compare", "a.csv", "b.csv"), "2>&-", 2),
        (("compare", "a.csv", "b.csv"), "2>/dev/full", 2),
    ],
)
def test_closed_or_full(arguments: tuple[str, ...], streams: str, status: int, tmp_path: Path) -> None:
    line = f"{shlex.join(map(str, command(*arguments)))} {streams}"
    ended = subprocess.run(
        ["/bin/sh", "-c", line], cwd=tmp_path, env=environment(), capture_output=True, text=True, timeout=300
    )
    assert (ended.returncode, ended.stderr) == (status, "")
