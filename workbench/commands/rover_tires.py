"""The tires of ``workbench rover`` by name: those of a study, or the thesis' without one.

Verified by tests/unit/test_workbench_rover_inputs.py and tests/end_to_end/test_rover_study.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from contracts.errors import InputError
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.rover.scenarios.ground import on_brush_tires, on_friction, on_rigid_tires
from rover_dynamics.rover.scenarios.scenario import Scenario
from rover_dynamics.tires.brush_settings import Carcass
from workbench.execution.task import Task, needed_for
from workbench.questions.models.driving_brush import driving_brush
from workbench.study.model import Study
from workbench.study.model_parameters import rover_brush, rover_on_ancf
from workbench.study.own_mesh import own_mesh
from workbench.study.wheel_design import wheel_design

__all__ = ["FITTED", "TIRES", "TireSource", "check_tire", "file_name", "on_tires"]


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
    """The brush tire that [rover] names."""
    if source.study is None:
        return scenario
    tire, carcass = driving_brush(source.study)
    return on_brush_tires(scenario, tire, None if carcass is None else Carcass(*carcass))


def _on_stated_brush(scenario: Scenario, source: TireSource) -> Scenario:
    """That of [brush]: what rigid wheels and wheels that were solved have of a brush tire is not the wheel's."""
    return scenario if source.study is None else on_brush_tires(scenario, rover_brush(source.study))


def _on_rigid(scenario: Scenario, source: TireSource) -> Scenario:
    """Friction, slip and rolling resistance of the brush tire."""
    return on_rigid_tires(_on_stated_brush(scenario, source))


def _on_ancf(scenario: Scenario, source: TireSource) -> Scenario:
    from workbench.questions.rover.tires import on_ancf_tires
    from workbench.study.ancf_tire import tire_from

    return on_ancf_tires(scenario, None if source.study is None else tire_from(rover_on_ancf(source.study)))


def _on_fe(scenario: Scenario, source: TireSource) -> Scenario:
    """The study's wheel by its solid model: curves all around, and how it yields along the ground."""
    return _on_solved(scenario, source, "fe")


def _on_ancf_wheel(scenario: Scenario, source: TireSource) -> Scenario:
    """The same by its ANCF model, at rest at every instant: the plates' own inertia is in the wheel's body."""
    return _on_solved(scenario, source, "ancf_wheel")


def _on_solved(scenario: Scenario, source: TireSource, model: str) -> Scenario:
    """What is not kept is computed here."""
    from workbench.commands.computing import complain_of_early_ends, naming, warn
    from workbench.execution.result_files import early_ends
    from workbench.questions.models.wheel_curves import curves_around, on_solved_tires
    from workbench.questions.models.wheel_tasks import solved_tire

    study, path = _studied(source)
    with naming(path):
        values, tasks = solved_tire(study, model)
    folders = _computed(tasks, source, path)
    ended = early_ends(folders)
    with naming(path):
        if min(curve.deflection[-1] for curve in curves_around(values, folders)) < study.fe.max_deflection - 1e-9:
            complain_of_early_ends(path, ended)
        warn(path, [f"{task} ends early: {why}" for task, why in ended.items()])
        return on_solved_tires(_on_stated_brush(scenario, source), values, folders)


def _on_fitted(scenario: Scenario, source: TireSource, design: RoverDesign, name: str) -> Scenario:
    """One of the study's fitted ANCF tires, fitted here if it is not kept; warns of one that does not stand."""
    from workbench.commands.computing import warn
    from workbench.execution.result_files import FAILURE, read_result
    from workbench.questions.ancf_fit.graph import fit_name, stand_name, stand_task
    from workbench.questions.ancf_fit.stand_task import reasons_against
    from workbench.questions.rover_ancf.runs import fitted_run
    from workbench.questions.study_graph import report_tasks
    from workbench.study.ancf_tire import preset_from

    study, path = _studied(source)
    tires = () if study.ancf_fit is None else study.ancf_fit.tires
    if name not in [one.name for one in tires]:
        known = ", ".join(one.name for one in tires) or "it has none"
        raise InputError("fitted tire", repr(name), f"is not one of the study's ({known})", "name one of [ancf_fit]")
    needed = needed_for(fit_name(name), report_tasks(study))
    folders = _computed([*needed, stand_task(study, name)], source, path)
    found, stands = read_result(folders[fit_name(name)]), read_result(folders[stand_name(name)])
    if found.get(FAILURE):
        raise InputError("fitted tire", repr(name), f"is none: {found[FAILURE]}", "change its start or bounds")
    warn(path, [f"fitted tire {name}: {reason}" for reason in reasons_against(stands)])
    driven = fitted_run(scenario.name, preset_from(found["preset"]), design)
    return replace(driven, name=scenario.name, tire_model=file_name(f"{FITTED}{name}"))


def _studied(source: TireSource) -> tuple[Study, Path]:
    """The study, the built-in one without any, and its file."""
    from workbench.commands.computing import read_and_warn
    from workbench.study.reading import built_in_study

    path = source.path or built_in_study()
    return source.study or read_and_warn(path), path


def _computed(tasks: Iterable[Task], source: TireSource, path: Path) -> dict[str, Path]:
    from workbench.commands.computing import computed
    from workbench.commands.options import computing

    entries = computed(path, tuple(tasks), source.store, computing(None, 1, None))
    return {name: entry.path for name, entry in entries.items()}


TIRES: Mapping[str, Callable[[Scenario, TireSource], Scenario]] = {
    "rigid": _on_rigid,
    "brush": _on_brush,
    "fe": _on_fe,
    "ancf": _on_ancf,
    "ancf_wheel": _on_ancf_wheel,
}
"""Name on the command line -> what puts a study's tires of that kind, or the thesis' without one, under a scenario."""
FITTED = "ancf_fit:"
"""Before the name of a fitted tire of the study."""


def check_tire(name: str) -> None:
    """Refuse a tire that is not known."""
    if name not in TIRES and not name.startswith(FITTED):
        raise InputError("tire", repr(name), "is not known", f"give {', '.join(TIRES)} or {FITTED}NAME")


def file_name(tire: str) -> str:
    """What series and files call a tire."""
    return tire.replace(":", "_")


def on_tires(scenario: Scenario, name: str, source: TireSource, design: RoverDesign) -> Scenario:
    """The scenario on tires and ground of a study, on those of the thesis without one.

    Raises
    ------
    InputError
        For a study whose wheel has another radius than the rover's.
    """
    study = source.study
    if study is not None:
        _check_wheel(source, study, design)
    if name.startswith(FITTED):
        driven = _on_fitted(scenario, source, design, name.removeprefix(FITTED))
    else:
        driven = TIRES[name](scenario, source)
    return driven if study is None else on_friction(driven, study.ground.friction)


def _check_wheel(source: TireSource, study: Study, design: RoverDesign) -> None:
    """The rover must stand on the study's wheel: places of its joints and its own wheels are those of one size."""
    if own_mesh(study) is not None:
        from workbench.commands.computing import naming
        from workbench.execution.result_files import read_result
        from workbench.questions.wheel.graph import MESH, own_mesh_task
        from workbench.questions.wheel.own_mesh_task import require_rover_wheel

        _, path = _studied(source)
        found = read_result(_computed([own_mesh_task(study)], source, path)[MESH])
        with naming(path):
            require_rover_wheel(found["outer_radius"], found["least_reach"], design.wheel_radius)
        return
    radius = wheel_design(study).tire.outer_radius
    if abs(radius - design.wheel_radius) > 1e-9:
        rule = f"is not that of the rover's wheels, {1e3 * design.wheel_radius:g} mm"
        hint = "give --rover FILE, a rover with such wheels, or a study of the rover's wheel"
        raise InputError("radius of the study's wheel", f"{1e3 * radius:g} mm", rule, hint)
