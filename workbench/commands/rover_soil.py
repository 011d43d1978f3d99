"""``workbench rover --soil``: a scenario on soil on the wheels of a study, and the ruts it leaves.

Verified by tests/end_to_end/test_rover_soil.py.
"""

from __future__ import annotations

import io
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from pydantic_core import PydanticCustomError

from contracts.errors import InputError
from rover_dynamics.rover.scenarios.on_soil import on_soil
from rover_dynamics.rover.scenarios.scenario import Scenario
from rover_dynamics.soil.field import CELL, Ruts
from soil.steady_wheel import WheelOnSoil
from workbench.commands.computing import naming, read_and_warn
from workbench.commands.options import computing
from workbench.commands.rover_tires import TireSource
from workbench.commands.soil_rim import check_soil_tire, rim_of
from workbench.execution.runner import Computing
from workbench.questions.soil.held_climbs import rim_and_settling
from workbench.study.model import Study
from workbench.study.quantities import to_si
from workbench.study.reading import built_in_study
from workbench.study.soil_file import soil_of

__all__ = ["SoilChoice", "on_chosen_soil", "ruts_npz", "wheel_of"]


@dataclass(frozen=True, slots=True, kw_only=True)
class SoilChoice:
    """A soil by name or file, and the length of its cells, as a user typed it; None for the usual one."""

    soil: str
    cell: str | None = None


def on_chosen_soil(scenario: Scenario, tire: str, source: TireSource, choice: SoilChoice) -> Scenario:
    """The scenario on soil, on the wheels of the source's study, or of the built-in one.

    Raises
    ------
    InputError
        For a tire that does not know soil, an unknown soil, a cell that is no length, and what `on_soil` refuses.
    """
    check_soil_tire(tire)
    soil, cell = soil_of(choice.soil), CELL if choice.cell is None else _length(choice.cell)
    path = source.path or built_in_study()
    study = source.study or read_and_warn(path)
    with naming(path):
        where = source.store, computing(None, 1, None)
        wheel, settling = wheel_of(study, tire, source.path, where)
    return replace(on_soil(scenario, soil, wheel, cell=cell, settling=settling), tire_model=tire)


def wheel_of(
    study: Study, tire: str, study_path: Path | None, where: tuple[Path, Computing]
) -> tuple[WheelOnSoil, float | None]:
    """A study's wheel by a tire of `soil_rim.SOIL_TIRES`, and the time in which its rim settles [s], None for usual.

    study_path, where : as `soil_rim.rim_of` has them
    """
    return rim_and_settling(study, tire, rim_of(study, tire, study_path, where))


def _length(text: str) -> float:
    try:
        return to_si(text, "m")
    except PydanticCustomError as error:
        told = error.context or {}
        rule, hint = str(told.get("rule", error)), str(told.get("hint", "give e.g. 10 mm"))
        raise InputError("cell of the soil", repr(text), rule, hint, key="cell") from error


def ruts_npz(ruts: Ruts) -> bytes:
    """A height field that ``workbench rover --terrain`` reads, with the largest depths beside it [m]."""
    spacing = [float(one[1] - one[0]) for one in (ruts.x, ruts.y)]
    stream = io.BytesIO()
    np.savez_compressed(
        stream, heights=ruts.surface - ruts.depth, spacing=spacing, origin=[ruts.x[0], ruts.y[0]], deepest=ruts.deepest
    )
    return stream.getvalue()
