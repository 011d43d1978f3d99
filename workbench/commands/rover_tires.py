"""The tires of ``workbench rover`` by name: those of a study, or the thesis' without one.

Verified by tests/unit/test_workbench_rover_inputs.py and tests/end_to_end/test_rover_study.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from contracts.errors import InputError
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.rover.scenarios.ground import on_brush_tires, on_friction, on_rigid_tires, on_wheel_curves
from rover_dynamics.rover.scenarios.scenario import Scenario
from workbench.study.model import Study
from workbench.study.model_parameters import rover_brush, rover_on_ancf
from workbench.study.wheel_design import wheel_design

__all__ = ["TIRES", "TireSource", "check_tire", "on_tires"]


@dataclass(frozen=True, slots=True, kw_only=True)
class TireSource:
    """Where the rover's tires come from.

    Attributes
    ----------
    study, path : the study and its file, or None for the thesis' tires
    store : where results of its wheel are kept and found again
    """

    study: Study | None
    path: Path | None
    store: Path


def _on_brush(scenario: Scenario, source: TireSource) -> Scenario:
    return scenario if source.study is None else on_brush_tires(scenario, rover_brush(source.study))


def _on_rigid(scenario: Scenario, source: TireSource) -> Scenario:
    """Friction, slip and rolling resistance of the brush tire."""
    return on_rigid_tires(_on_brush(scenario, source))


def _on_ancf(scenario: Scenario, source: TireSource) -> Scenario:
    from workbench.questions.rover.tires import on_ancf_tires
    from workbench.study.ancf_tire import tire_from

    return on_ancf_tires(scenario, None if source.study is None else tire_from(rover_on_ancf(source.study)))


def _on_fe(scenario: Scenario, source: TireSource) -> Scenario:
    """The study's wheel by its solid model's curves all around, computed here if they are not kept."""
    from workbench.commands.computing import complain_of_early_ends, computed, naming, read_and_warn
    from workbench.commands.options import computing
    from workbench.execution.result_files import early_ends
    from workbench.questions.models.wheel_curves import curves_around, orientations_to_solve, wheel_potential_of
    from workbench.questions.study_graph import stiffness_tasks
    from workbench.study.reading import built_in_study

    path = source.path or built_in_study()
    study = source.study or read_and_warn(path)
    tasks = stiffness_tasks(study, "fe", orientations_to_solve(study))
    entries = computed(path, tasks, source.store, computing(None, 1, None))
    folders = {name: entry.path for name, entry in entries.items()}
    complain_of_early_ends(path, early_ends(folders))
    with naming(path):
        curves = curves_around(study, folders)
        potential = wheel_potential_of(study, curves)
    words = f"{len(curves)} curves of the solid model of {study.name}"
    return on_wheel_curves(_on_brush(scenario, source), potential, words)


TIRES: Mapping[str, Callable[[Scenario, TireSource], Scenario]] = {
    "rigid": _on_rigid,
    "brush": _on_brush,
    "fe": _on_fe,
    "ancf": _on_ancf,
}
"""Name on the command line -> what puts a study's tires of that kind, or the thesis' without one, under a scenario."""


def check_tire(name: str) -> None:
    """Refuse a tire that is not known."""
    if name not in TIRES:
        *most, last = TIRES
        raise InputError("tire", repr(name), "is not known", f"give {', '.join(most)} or {last}")


def on_tires(scenario: Scenario, name: str, source: TireSource, design: RoverDesign) -> Scenario:
    """The scenario on tires and ground of a study, on those of the thesis without one.

    Raises
    ------
    InputError
        For a study whose wheel has another radius than the rover's.
    """
    study = source.study
    if study is not None:
        _check_wheel(study, design)
    driven = TIRES[name](scenario, source)
    return driven if study is None else on_friction(driven, study.ground.friction)


def _check_wheel(study: Study, design: RoverDesign) -> None:
    """The rover must stand on the study's wheel: places of its joints and its own wheels are those of one size."""
    radius = wheel_design(study).tire.outer_radius
    if abs(radius - design.wheel_radius) > 1e-9:
        rule = f"is not that of the rover's wheels, {1e3 * design.wheel_radius:g} mm"
        hint = "give --rover FILE, a rover with such wheels, or a study of the rover's wheel"
        raise InputError("radius of the study's wheel", f"{1e3 * radius:g} mm", rule, hint)
