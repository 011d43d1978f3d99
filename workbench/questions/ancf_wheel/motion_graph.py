"""The task of an ANCF wheel in motion. Verified by tests/unit/test_workbench_roll.py."""

from __future__ import annotations

from dataclasses import asdict, dataclass

from contracts.errors import InputError
from workbench.execution.task import Task
from workbench.questions.ancf_wheel.graph import require_ancf_wheel
from workbench.questions.fe.graph import INNER_STIFFNESS
from workbench.questions.travels import FRICTION
from workbench.questions.wheel.graph import wheel_inputs
from workbench.study.model import Study
from workbench.study.sections import AncfWheelSection

__all__ = ["CASES", "MotionCase", "motion_task"]

CASES = {"rolling": 1.0, "drop": 0.3, "half_round": 2.0}
"""What the wheel does -> for how long where nothing is said [s]."""
_SPACING = 1e-3
"""Of points that may touch the ground [m]."""
_MOST_SECONDS, _MOST_SPEED, _LEAST_LOAD = 600.0, 1.0, 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class MotionCase:
    """One motion of a wheel, from rest.

    Attributes
    ----------
    case : one of `CASES`
    seconds : simulated [s]
    speed : that its drive keeps, of a rigid wheel that rolls [m/s]; nothing for a drop
    height : from which it falls [m]
    radius : of the half-round it rolls over [m]
    load : weight on the ground of wheel and what is on its hub [N]
    gravity : [m/s^2]

    Raises
    ------
    InputError
        For what no such motion has.
    """

    case: str
    seconds: float
    speed: float
    height: float
    radius: float
    load: float
    gravity: float

    def __post_init__(self) -> None:
        if self.case not in CASES:
            raise InputError("case", repr(self.case), "is not known", f"give {', '.join(CASES)}")
        limits = (
            ("seconds", self.seconds, 1e-3, _MOST_SECONDS, "s", "1 s is usual"),
            ("speed", self.speed, -_MOST_SPEED, _MOST_SPEED, "m/s", "70 m/h is usual, 0.0194 m/s"),
            ("load", self.load, _LEAST_LOAD, 1e6, "N", "198 N stand on a wheel of the thesis' rover on Mars"),
        )
        for what, value, least, most, unit, hint in limits:
            if not least <= value <= most:
                rule = f"must lie between {least:g} and {most:g} {unit}"
                raise InputError(what, f"{value:g} {unit}", rule, hint)

    @property
    def words(self) -> str:
        """Title of the motion."""
        under = f"under {self.load:g} N"
        if self.case == "drop":
            return f"dropped by {1e3 * self.height:g} mm {under}"
        rolls = f"rolls from rest to {3600.0 * self.speed:g} m/h {under}"
        return rolls if self.case == "rolling" else f"{rolls}, over a half-round of {1e3 * self.radius:g} mm"


def motion_task(study: Study, asked: MotionCase) -> Task:
    """The task ``roll_{case}`` of a study's wheel as thin plates of the sizes of [ancf_wheel], on its [ground].

    Raises
    ------
    InputError
        If the study has what the model has not.
    """
    require_ancf_wheel(study)
    section = study.ancf_wheel or AncfWheelSection()
    ground = None if study.ground is None else study.ground.friction
    inputs = {
        "wheel": wheel_inputs(study),
        "options": {
            "element_size": section.element_size,
            "axial_size": section.axial_size,
            "half_width": study.mesh.half_width,
            "ground_spacing": _SPACING,
            "hub": study.fe.hub,
        },
        "contact_stiffness": study.fe.contact_stiffness,
        "inner_contact_stiffness": INNER_STIFFNESS if study.fe.inner_contact else 0.0,
        "friction": FRICTION if ground is None else ground,
        "title": f"{study.name}, {asked.words}",
        **asdict(asked),
    }
    function = "workbench.questions.ancf_wheel.motion_task:move"
    return Task(name=f"roll_{asked.case}", function=function, inputs=inputs, cost=40.0 * asked.seconds)
