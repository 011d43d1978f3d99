"""Settings shared by all tests: repeatable property tests, no display."""

from __future__ import annotations

import os

from hypothesis import settings

os.environ.setdefault("MPLBACKEND", "Agg")
os.environ.setdefault("OMP_NUM_THREADS", "1")
# No deadline: the first call of a compiled kernel takes seconds. Derandomised: a failure shows on every machine alike.
settings.register_profile("repeatable", deadline=None, derandomize=True)
settings.load_profile("repeatable")
