"""One aim for speed: what was wanted, and what was found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

__all__ = ["Aim"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Aim:
    """One aim: what was wanted (at least ``limit``, more than it, or at most it), and what was found.

    Verified by tests/unit/test_workbench_speed.py.
    """

    title: str
    found: float
    limit: float
    unit: str = "times"
    rule: Literal["at least", "more than", "at most"] = "at least"

    @property
    def met(self) -> bool:
        """Whether the number found lies on the right side of the limit."""
        if self.rule == "at most":
            return self.found <= self.limit
        return self.found >= self.limit if self.rule == "at least" else self.found > self.limit
