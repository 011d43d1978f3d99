"""The known table of the thesis' ANCF tire, against which a study with this preset is held.

Verified by tests/unit/test_workbench_checks.py.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

__all__ = ["COLUMNS", "preset_table"]

COLUMNS = {0.0: 1, 45.0: 2}
"""Orientation [deg] -> column of the table."""


@cache
def preset_table() -> NDArray[np.float64]:
    """(n, 3) float: deflection [m], load at 0 deg and at 45 deg [N]; from the package's data file."""
    path = Path(__file__).parent / "ancf_thesis_preset.csv"
    return np.loadtxt(path, delimiter=",", comments="#", skiprows=3)
