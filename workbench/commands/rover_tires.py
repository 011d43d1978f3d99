"""The tires of ``workbench rover`` by name: those of a study, or the thesis' without one.

Verified by tests/unit/test_workbench_rover_inputs.py and tests/end_to_end/test_rover_study.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from contracts.errors import InputError
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.rover.scenarios.ground import on_brush_tires, on_friction, on_rigid_tires
from rover_dynamics.rover.scenarios.scenario import Scenario
from workbench.study.model import Study
from workbench.study.model_parameters import rover_brush, rover_on_ancf
from workbench.study.wheel_design import wheel_design

__all__ = ["TIRES", "check_tire", "on_tires"]


def _on_brush(scenario: Scenario, study: Study | None) -> Scenario:
    return scenario if study is None else on_brush_tires(scenario, rover_brush(study))


def _on_rigid(scenario: Scenario, study: Study | None) -> Scenario:
    """Friction, slip and rolling resistance of the brush tire."""
    return on_rigid_tires(_on_brush(scenario, study))


def _on_ancf(scenario: Scenario, study: Study | None) -> Scenario:
    from workbench.questions.rover.tires import on_ancf_tires
    from workbench.study.ancf_tire import tire_from

    return on_ancf_tires(scenario, None if study is None else tire_from(rover_on_ancf(study)))


TIRES: Mapping[str, Callable[[Scenario, Study | None], Scenario]] = {
    "rigid": _on_rigid,
    "brush": _on_brush,
    "ancf": _on_ancf,
}
"""Name on the command line -> what puts a study's tires of that kind, or the thesis' without one, under a scenario."""


def check_tire(name: str) -> None:
    """Refuse a tire that is not known."""
    if name not in TIRES:
        *most, last = TIRES
        raise InputError("tire", repr(name), "is not known", f"give {', '.join(most)} or {last}")


def on_tires(scenario: Scenario, name: str, study: Study | None, design: RoverDesign) -> Scenario:
    """The scenario on tires and ground of a study, on those of the thesis without one.

    Raises
    ------
    InputError
        For a study whose wheel has another radius than the rover's.
    """
    if study is not None:
        _check_wheel(study, design)
    driven = TIRES[name](scenario, study)
    return driven if study is None else on_friction(driven, study.ground.friction)


def _check_wheel(study: Study, design: RoverDesign) -> None:
    """The rover must stand on the study's wheel: places of its joints and its own wheels are those of one size."""
    radius = wheel_design(study).tire.outer_radius
    if abs(radius - design.wheel_radius) > 1e-9:
        rule = f"is not that of the rover's wheels, {1e3 * design.wheel_radius:g} mm"
        hint = "give --rover FILE, a rover with such wheels, or a study of the rover's wheel"
        raise InputError("radius of the study's wheel", f"{1e3 * radius:g} mm", rule, hint)
