"""Tasks of the wheel's modes. Verified by tests/unit/test_workbench_modes.py."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any

from contracts.errors import InputError
from workbench.execution.task import Task
from workbench.questions.ancf_wheel.graph import ancf_wheel_curve_tasks
from workbench.questions.fe.foresight import foreseen
from workbench.questions.fe.graph import fe_inputs, without_end
from workbench.questions.wheel.graph import MESH_WHOLE, mesh_task, wheel_meshes
from workbench.study.model import Study
from workbench.study.orientation import orientation_name
from workbench.study.own_mesh import own_mesh

__all__ = ["COMPARED", "LOAD", "MODELS", "STATES", "AskedModes", "modes_name", "modes_tasks"]

MODELS, STATES = ("fe", "ancf_wheel"), ("free", "held", "standing")
LOAD = 200.0
"""Load on a wheel that stands where none is given [N]."""
COMPARED = "modes_compared"
"""Name of the task that pairs both models' modes."""
_MESH_ALL = "mesh_all"
_MOST = 100
"""Modes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AskedModes:
    """State and number of modes.

    Attributes
    ----------
    state : one of `STATES`
    load : on the ground of a wheel that stands [N]; 0 for others
    orientation_deg : what of it faces the ground [deg]; 0 for others
    count : of modes besides those of a rigid body
    grip : whether points that touch the ground stick to it, else they slide freely

    Raises
    ------
    InputError
        For what no such state has.
    """

    state: str
    load: float
    orientation_deg: float
    count: int
    grip: bool = False

    def __post_init__(self) -> None:
        if self.state not in STATES:
            raise InputError("state", repr(self.state), "is not known", f"give {', '.join(STATES)}")
        if self.state == "standing" and not 0.1 <= self.load <= 1e6:
            raise InputError("load", f"{self.load:g} N", "must lie between 0.1 and 1e6 N", f"{LOAD:g} N is usual")
        if self.grip and self.state != "standing":
            raise InputError("grip", "", f"is of no use to --state {self.state}", "leave it out")
        if not 1 <= self.count <= _MOST:
            raise InputError("count", self.count, f"must lie between 1 and {_MOST}", "10 is usual")

    @property
    def name(self) -> str:
        """For files: ``held``, ``free``, ``standing_phi000_200N``, ``standing_phi000_200N_grip``."""
        if self.state != "standing":
            return self.state
        return f"{orientation_name(self.state, self.orientation_deg)}_{self.load:g}N" + "_grip" * self.grip

    @property
    def words(self) -> str:
        """Title of the state."""
        if self.state != "standing":
            return {"free": "free in space", "held": "held at its hub"}[self.state]
        grips = ", gripping" if self.grip else ""
        return f"held at its hub, standing on {self.orientation_deg:g} deg under {self.load:g} N{grips}"


def modes_name(model: str, asked: AskedModes) -> str:
    """Name of a task, such as ``modes_fe_held``."""
    return f"modes_{model}_{asked.state}"


def modes_tasks(study: Study, models: tuple[str, ...], asked: AskedModes) -> tuple[Task, ...]:
    """The modes by some models with what they need; by both, the comparison too.

    Raises
    ------
    InputError
        For a model that is not known, and a study that it cannot take.
    """
    if asked.grip and study.fe.obstacle.shape != "plane":
        raise InputError("grip", f"on {study.fe.obstacle.shape}", "needs a plane", "leave it out")
    tasks = list[Task]()
    for model in models:
        if model not in MODELS:
            raise InputError("model", repr(model), "has no modes", f"give {', '.join(MODELS)} or both")
        tasks += _fe_tasks(study, asked) if model == "fe" else _ancf_tasks(study, asked)
    if len(models) > 1:
        names = {model: modes_name(model, asked) for model in models}
        wheel = {name: tasks[-1].inputs[name] for name in ("wheel", "options")}
        function = "workbench.questions.modes.compare_task:compare"
        tasks.append(
            Task(name=COMPARED, function=function, inputs=wheel | names, needs=tuple(names.values()), cost=5.0)
        )
    return foreseen(tasks)


def _given(asked: AskedModes) -> dict[str, Any]:
    return {name: value for name, value in asdict(asked).items() if name != "orientation_deg"}


def _fe_tasks(study: Study, asked: AskedModes) -> list[Task]:
    mesh = wheel_meshes(study)[0]
    if asked.state == "free" and own_mesh(study) is None and study.fe.hub == "rigid":
        mesh = mesh_task(study, _MESH_ALL, {"parts": "all"})
    inputs = without_end(fe_inputs(study, asked.orientation_deg, ())) | {"friction": 0.0, "modes": _given(asked)}
    function = "workbench.questions.modes.fe_task:solve"
    return [mesh, Task(name=modes_name("fe", asked), function=function, inputs=inputs, needs=(mesh.name,))]


def _ancf_tasks(study: Study, asked: AskedModes) -> list[Task]:
    curve = ancf_wheel_curve_tasks(study, (asked.orientation_deg,))[0]
    names = ("wheel", "contact_stiffness", "inner_contact_stiffness", "orientation_deg", "obstacle", "camber_deg")
    inputs = {name: curve.inputs[name] for name in names} | {
        "options": curve.inputs["options"] | {"half_width": False},
        "modes": _given(asked),
    }
    task = Task(
        name=modes_name("ancf_wheel", asked),
        function="workbench.questions.modes.ancf_task:solve",
        inputs=inputs,
        cost=60.0 if asked.state == "standing" else 15.0,
    )
    if asked.state != "free":
        return [task]
    whole = wheel_meshes(study)[1]
    return [whole, replace(task, inputs=inputs | {"mesh": MESH_WHOLE}, needs=(MESH_WHOLE,))]
