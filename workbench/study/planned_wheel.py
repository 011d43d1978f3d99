"""A study's wheel, built once: the plan of a report asks for it a hundred times.

Verified by tests/unit/test_workbench_study.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from workbench.study.wheel import WheelStudy
from workbench.study.wheel_design import wheel_design

if TYPE_CHECKING:
    from geometry.wheel import WheelDesign

__all__ = ["planned_wheel"]


@dataclass(frozen=True, slots=True, eq=False)
class _Wheel:
    """A study's wheel, equal where both sections are the same objects: they are never changed, and to compare them
    takes longer than to build the wheel."""

    study: WheelStudy

    @property
    def _key(self) -> tuple[int, int, str]:
        return id(self.study.wheel), id(self.study.materials), self.study.name

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Wheel) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)


def planned_wheel(study: WheelStudy) -> WheelDesign:
    """As `wheel_design`, from its last results; raises what it raises."""
    return _built(_Wheel(study))


@lru_cache(maxsize=16)
def _built(wheel: _Wheel) -> WheelDesign:
    return wheel_design(wheel.study)
