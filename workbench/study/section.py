"""What every section of a study file is.

Verified by tests/unit/test_workbench_study.py.
"""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field
from pydantic_core import PydanticCustomError

__all__ = ["Positive", "Section", "in_key"]

Positive = Field(gt=0.0)


class Section(BaseModel):
    """Base of every section: frozen, no unknown keys."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def in_key(key: str, value: object, rule: str, hint: str) -> PydanticCustomError:
    """Error of one key that only its whole section can find."""
    context = {"key": key, "value": str(value), "rule": rule, "hint": hint}
    return PydanticCustomError("key_in_section", "{key} {rule}; {hint}", context)
