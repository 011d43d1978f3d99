"""Numbers of the thesis that more than one question holds results against."""

from __future__ import annotations

__all__ = ["WHEEL_MASS"]

WHEEL_MASS = 4.44157
"""Mass of a wheel [kg] (Samarini 2020, Table I)."""
