"""The curves of each model from the folders of its tasks. Verified by tests/unit/test_workbench_words.py."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from contracts.curves import StiffnessCurve, read_curve
from workbench.questions.model_curves import CURVE, model_curves
from workbench.study.full import around
from workbench.study.model import Study
from workbench.study.model_parameters import brush_parameters

__all__ = ["brush_curve", "stiffness_curves"]


def brush_curve(study: Study, folder: Path) -> StiffnessCurve:
    """The brush line of the task ``brush``, with the source that the study states for its parameters."""
    from rover_dynamics.tires.brush_tire import line_source

    return replace(read_curve(folder / CURVE, model="brush"), source=line_source(brush_parameters(study)))


def stiffness_curves(study: Study, model: str, folders: Mapping[str, Path]) -> list[StiffnessCurve]:
    """Curves of one model from its tasks' folders, in order of orientation, and behind them their average.

    The brush has one line at every orientation, its average.
    """
    if model == "brush":
        return [brush_curve(study, folders["brush"])]
    found = model_curves(model, folders, around(study) if model in ("fe", "section", "ancf_wheel") else None)
    return [*found.by_orientation.values(), found.average]
