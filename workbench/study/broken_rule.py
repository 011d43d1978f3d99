"""What a study breaks.

Verified by tests/unit/test_workbench_study.py.
"""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["BrokenRule"]


@dataclass(frozen=True, slots=True, kw_only=True)
class BrokenRule:
    """A key of the study file, its value, the rule it breaks and what to try."""

    key: str
    value: str
    rule: str
    hint: str
