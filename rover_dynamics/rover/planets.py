"""Gravity of the planets a rover may stand on. Verified by tests/unit/test_rover_file.py."""

from __future__ import annotations

from contracts.errors import InputError

__all__ = ["GRAVITIES", "gravity_named"]

GRAVITIES = {"mars": 3.711, "earth": 9.81}
"""[m/s^2]."""


def gravity_named(name: str, what: str = "gravity") -> float:
    """Gravity of a planet [m/s^2]; raises InputError for one that is not known."""
    if name not in GRAVITIES:
        raise InputError(what, repr(name), "is not known", f"give {' or '.join(GRAVITIES)}")
    return GRAVITIES[name]
