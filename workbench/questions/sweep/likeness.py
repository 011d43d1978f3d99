"""Which rows of a parameter study may be ranked together: those of one model, one resolution and one kind of stress.

Verified by tests/unit/test_workbench_trade_offs.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from workbench.questions.sweep.results import Outcome
from workbench.questions.sweep.wheel_facts import stress_kinds
from workbench.study.key_units import as_written
from workbench.study.model import Study
from workbench.study.sections import AncfWheelSection
from workbench.study.sweep import SweptModel

__all__ = ["alike", "unlike"]

_NOT_OF_A_SECTION = ("mesh.axial_size", "mesh.edge_size")


def alike(found: Sequence[Outcome]) -> list[int | None]:
    """Number of the kind of each outcome, from 1 as they come; None for one without a curve."""
    kinds = [None if one.curve is None else tuple(sorted(_kind(one).items())) for one in found]
    order = list(dict.fromkeys(kind for kind in kinds if kind is not None))
    return [None if kind is None else order.index(kind) + 1 for kind in kinds]


def unlike(found: Sequence[Outcome]) -> str:
    """What tells the kinds apart, a sentence; ``""`` where there is one kind."""
    kinds = [_kind(one) for one in found if one.curve is not None]
    differ = []
    for key in dict.fromkeys(key for kind in kinds for key in kind):
        values = list(dict.fromkeys(kind[key] for kind in kinds if key in kind))
        if len(values) > 1:
            differ.append(f"{key} ({'; '.join(values)})")
    if not differ:
        return ""
    return (
        f"not all points are alike in {', '.join(differ)}: compare those alone that have one number in the column alike"
    )


def _kind(outcome: Outcome) -> dict[str, str]:
    study, model = outcome.run.point.study, outcome.run.model
    stress = stress_kinds(outcome.wheel, outcome.by_orientation)
    return {"model": model, **resolution(study, model)} | ({"stress that is judged": stress} if stress else {})


def resolution(study: Study, model: SweptModel) -> dict[str, str]:
    """Keys that say how finely a model is divided, with their values as one writes them."""
    if model in ("fe", "section"):
        found = _written("mesh", study.mesh.model_dump(exclude={"half_width"}))
        return {key: value for key, value in found.items() if model == "fe" or key not in _NOT_OF_A_SECTION}
    if model == "ancf_wheel":
        return _written("ancf_wheel", (study.ancf_wheel or AncfWheelSection()).model_dump())
    if model == "ancf" and study.ancf is not None:
        plates = {name: value for name, value in study.ancf.model_dump().items() if "plates" in name}
        return _written("ancf", plates)
    return {}


def _written(section: str, values: Mapping[str, Any]) -> dict[str, str]:
    return {
        f"{section}.{name}": as_written(f"{section}.{name}", value) if isinstance(value, float) else str(value)
        for name, value in values.items()
    }
