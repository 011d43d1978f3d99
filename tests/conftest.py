"""Settings shared by all tests: repeatable property tests, no display, short tests last."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import settings

os.environ.setdefault("MPLBACKEND", "Agg")
os.environ.setdefault("OMP_NUM_THREADS", "1")
# No deadline: the first call of a compiled kernel takes seconds. Derandomised: a failure shows on every machine alike.
settings.register_profile("repeatable", deadline=None, derandomize=True)
settings.load_profile("repeatable")

ROOMS = ("end_to_end", "verification", "regression", "unit")
"""Folders of the tests, those with the longest files first."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Sort by folder: where two processes share the files, the many short ones at the end keep both busy."""
    items.sort(key=lambda item: ROOMS.index(room) if (room := _room(item.path)) in ROOMS else len(ROOMS))


def _room(path: Path) -> str:
    return path.relative_to(Path(__file__).parent).parts[0]
