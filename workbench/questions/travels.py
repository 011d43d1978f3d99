"""Tasks of a pressed wheel whose hub is moved over the ground. Verified by tests/unit/test_workbench_travels.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from contracts.errors import InputError
from contracts.hub_travel import Way
from workbench.execution.task import Task
from workbench.questions.ancf_wheel.graph import ancf_wheel_curve_tasks
from workbench.questions.fe.foresight import foreseen
from workbench.questions.fe.graph import fe_curve_tasks, fe_inputs, without_fields
from workbench.questions.travel_files import path_name, travel_name
from workbench.questions.wheel.graph import MESH, mesh_task, wheel_meshes
from workbench.study.full import require_level
from workbench.study.hub_path import LONGEST_STEP
from workbench.study.model import Study
from workbench.study.orientation import degrees
from workbench.study.own_mesh import own_mesh

__all__ = ["FRICTION", "STEPS", "WORKING_LOAD", "path_tasks", "travel_tasks"]

MESH_FULL = "mesh_full"
"""Name of the task."""
_SOLID = "workbench.questions.fe.task:solve_orientation"
"""Function of a solid curve's task."""
STEPS: Mapping[Way, tuple[float, ...]] = {
    Way.FORE_AFT: (1e-3, 2e-3, 4e-3),
    Way.LATERAL: (1e-3, 2e-3, 4e-3),
    Way.TURNING: (5e-3, 10e-3, 20e-3, 40e-3),
    Way.RADIAL: (1e-3, 2e-3),
    Way.LEANING: (5e-3, 10e-3, 20e-3),
    Way.WIND_UP: (5e-3, 10e-3, 20e-3, 40e-3),
}
"""Steps of the hub over the ground [m; rad of a turn]."""
SMALL_STEP, SMALL_TURN = 0.1e-3, 1e-3
"""Steps of a stiffness matrix [m; rad]: what touches sticks, the solver's tolerance is a thousandth of the change."""
WORKING_LOAD = 200.0
"""Between the 160 and 250 N on a wheel of Samarini 2020, section 3.2 [N]."""
_LEAST_LOAD = 0.1
"""Below it a wheel is pressed by less than iterations leave [N]."""
FRICTION = 0.6
"""Of the thesis' contact, eq. 2.22, where neither [fe] nor [ground] states one [-]."""


def travel_tasks(
    study: Study,
    model: str,
    ways: Sequence[Way],
    load: float,
    orientations_deg: Sequence[float] = (),
    *,
    small: bool = False,
) -> tuple[Task, ...]:
    """Each way from a load [N] at each orientation [deg], none means those of [fe], with the curves they start from.

    Of a ``small`` one a single small step is made, for a stiffness matrix.

    Raises
    ------
    InputError
        For another model than fe and ancf_wheel, a load beyond the curves or next to none, and a study whose wheel is
        not pressed on level ground.
    """
    asked = _orientations(study, model, orientations_deg)
    if not _LEAST_LOAD <= load <= study.fe.max_load:
        rule = f"must lie between {_LEAST_LOAD:g} N and fe.max_load, {study.fe.max_load:g} N, at which curves end"
        raise InputError("load", f"{load:g} N", rule, f"{WORKING_LOAD:g} N is usual")
    mirrored = all(way.mirrored for way in ways)
    meshes, curves = _meshes_and_curves(study, model, asked, mirrored=mirrored)
    tasks = [
        _task(study, curve, travel_name(model, way, o, small=small), _asked(study, way, load, small), way.mirrored)
        for curve, o in zip(curves, asked, strict=True)
        for way in ways
    ]
    return foreseen([*meshes, *curves, *tasks])


def path_tasks(
    study: Study, model: str, places: Sequence[Mapping[Way, float]], orientations_deg: Sequence[float] = ()
) -> tuple[Task, ...]:
    """A path of the hub, as `workbench.study.hub_path` reads it, at each orientation [deg]; see `travel_tasks`."""
    asked = _orientations(study, model, orientations_deg)
    mirrored = all(way.mirrored for place in places for way in place)
    meshes, curves = _meshes_and_curves(study, model, asked, mirrored=mirrored)
    path = [{way.value: value for way, value in place.items()} for place in places]
    travel = {"path": path, "longest": LONGEST_STEP, "friction": _friction(study)}
    tasks = [_task(study, curve, path_name(model, o), travel, mirrored) for curve, o in zip(curves, asked, strict=True)]
    needed = {name for task in tasks for name in task.needs}
    return foreseen([*(mesh for mesh in meshes if mesh.name in needed), *tasks])


def _orientations(study: Study, model: str, orientations_deg: Sequence[float]) -> tuple[float, ...]:
    if model not in ("fe", "ancf_wheel"):
        raise InputError("model", model, "has no hub that could be moved", "give fe or ancf_wheel")
    require_level(study)
    return tuple(orientations_deg) or tuple(degrees(o) for o in study.fe.orientations)


def _friction(study: Study) -> float:
    return study.fe.friction or study.ground.friction or FRICTION


def _asked(study: Study, way: Way, load: float, small: bool) -> dict[str, object]:
    steps = [SMALL_TURN if way.turns else SMALL_STEP] if small else list(STEPS[way])
    return {"way": way.value, "load": load, "steps": steps, "friction": _friction(study)}


def _meshes_and_curves(
    study: Study, model: str, orientations_deg: Sequence[float], *, mirrored: bool
) -> tuple[list[Task], Sequence[Task]]:
    """Of ways that are ``mirrored`` half a wheel will do, if that is what the study has."""
    if model == "ancf_wheel":
        return [], ancf_wheel_curve_tasks(study, orientations_deg)
    meshes = [wheel_meshes(study)[0]]
    if not mirrored and study.mesh.half_width:
        if (own := own_mesh(study)) is not None:
            rule = "is half a wheel, whose hub can be moved and turned forwards alone"
            raise InputError("mesh.symmetry", own.symmetry, rule, "mesh the whole wheel")
        meshes.append(mesh_task(study, MESH_FULL, {"half_width": False}))
    return meshes, fe_curve_tasks(study, orientations_deg)


def _task(study: Study, curve: Task, name: str, travel: Mapping[str, object], mirrored: bool) -> Task:
    """One travel at the orientation of a curve, which it needs where it begins at a load."""
    begin = {"curve": curve.name} if "load" in travel else {}
    if curve.function != _SOLID:
        kept = ("wheel", "contact_stiffness", "inner_contact_stiffness", "orientation_deg")
        options = curve.inputs["options"] | ({} if mirrored else {"half_width": False})
        return Task(
            name=name,
            function="workbench.questions.ancf_wheel.travel_task:solve_travel",
            inputs={one: curve.inputs[one] for one in kept} | {"options": options, "travel": travel} | begin,
            needs=tuple(begin.values()),
            cost=2.0 * curve.cost,
        )
    mesh = MESH if mirrored or not study.mesh.half_width else MESH_FULL
    inputs = without_fields(fe_inputs(study, curve.inputs["orientation_deg"], ()))
    return Task(
        name=name,
        function="workbench.questions.fe.travel_task:solve_travel",
        inputs=inputs | {"travel": travel, "mesh": mesh} | begin,
        needs=(mesh, *begin.values()),
        resumable=True,
        shared=True,
    )
