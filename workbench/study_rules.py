"""Rules that bind several sections of a study file: part names, room for the deflection.

Asked once the wheel and the tire are known to fit together. Verified by tests/unit/test_workbench_study.py.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from workbench.study import Study
from workbench.study_models import wheel_design

__all__ = ["BrokenRule", "broken_rules"]


@dataclass(frozen=True, slots=True, kw_only=True)
class BrokenRule:
    """A key of the study file, its value, the rule it breaks and what to try."""

    key: str
    value: str
    rule: str
    hint: str


def broken_rules(study: Study) -> Iterator[BrokenRule]:
    """Every rule between sections that the study breaks, in the order of the file."""
    parts = tuple(wheel_design(study).materials)
    for name, size in study.mesh.refinement.items():
        if name not in parts:
            yield BrokenRule(
                key=f"mesh.refinement.{name}",
                value=f"{1e3 * size:g} mm",
                rule="names no part of the wheel",
                hint=f"use {', '.join(parts)}",
            )
    tire, ancf = study.wheel.tire, study.ancf
    yield from _room(
        "fe", study.fe.max_deflection, tire.outer_radius - tire.thickness - study.wheel.outer_hub.outer_radius
    )
    yield from _room("ancf", ancf.max_deflection, ancf.outer_radius - ancf.hub_radius)


def _room(section: str, deflection: float, gap: float) -> Iterator[BrokenRule]:
    """The ground must stay below the hub: ``deflection`` < ``gap``, both in metres."""
    if deflection >= gap:
        yield BrokenRule(
            key=f"{section}.max_deflection",
            value=f"{1e3 * deflection:g} mm",
            rule=f"must be less than the gap between rim and hub, {1e3 * gap:g} mm",
            hint="give a smaller deflection or a smaller hub",
        )
