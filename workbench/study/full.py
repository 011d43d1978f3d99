"""The fine study of ``workbench report --full``: every orientation of one period of the wheel, on a finer mesh.

Verified by tests/unit/test_workbench_full_study.py and tests/end_to_end/test_full_report.py.
"""

from __future__ import annotations

import math

from contracts.curves import Around
from contracts.errors import InputError
from geometry.parts import SpringSet
from workbench.study.model import Study
from workbench.study.orientation import degrees
from workbench.study.own_mesh import own_mesh, sized_mesh, without_wheel
from workbench.study.reference import ReferenceSection
from workbench.study.sections import RoverSection
from workbench.study.wheel_design import wheel_design

__all__ = ["around", "full_study", "is_mirrored", "require_level", "rotational_period", "steps_around"]

_SAME = 1e-6
"""Two angles closer than this are one [deg]."""


def rotational_period(study: Study) -> float:
    """Smallest turn that maps the wheel onto itself [deg]: the full turn over the common divisor of all counts.

    Of a mesh from another program it is what ``mesh.repeats`` says.
    """
    if (section := own_mesh(study)) is not None:
        return 360.0 / section.repeats
    return 360.0 / math.gcd(*(count for count, _ in _patterns(study)))


def is_mirrored(study: Study) -> bool:
    """Whether the wheel is its own mirror image about position 0, so that phi and -phi give the same curve.

    Of a mesh from another program this is not known: no.
    """
    if own_mesh(study) is not None:
        return False
    two_sided = all(springs.shape == "hoop" for springs in _springs(study))
    return two_sided and all(_is_whole(2.0 * phase * count / 360.0) for count, phase in _patterns(study))


def around(study: Study) -> Around:
    """How the study's wheel repeats itself."""
    return Around(period=rotational_period(study), mirrored=is_mirrored(study))


def _springs(study: Study) -> list[SpringSet]:
    """Sets of springs that bear on the load: those on a rigid hub do not."""
    design = wheel_design(study)
    impact = design.impact_springs
    return [*design.spring_sets, *([impact] if impact is not None and study.fe.hub == "elastic" else [])]


def _patterns(study: Study) -> list[tuple[int, float]]:
    """(count, phase [deg]) of everything that repeats around the axle and bears on the load."""
    patterns = [(springs.count, degrees(springs.phase)) for springs in _springs(study)]
    design = wheel_design(study)
    others = (design.grousers, design.sidewall_springs)
    patterns += [(part.count, degrees(part.phase)) for part in others if part is not None]
    lattice = design.lattice
    return patterns if lattice is None else [*patterns, (lattice.cells, degrees(lattice.phase))]


def require_level(study: Study) -> None:
    """Refuse a study whose wheel is not pressed on level ground, which the rover's wheels stand on."""
    if study.fe.obstacle.shape != "plane" or study.fe.camber:
        shape, camber = study.fe.obstacle.shape, math.degrees(study.fe.camber)
        rule = "is not the level plane that the rover's wheel is pressed on"
        hint = 'give fe.obstacle = { shape = "plane" } and no camber'
        raise InputError("ground of [fe]", f"{shape}, camber {camber:g} deg", rule, hint)


def steps_around(study: Study) -> list[float]:
    """Orientations [deg] from 0 by ``full.orientation_step`` to where the wheel repeats itself.

    Raises
    ------
    InputError
        If the step does not divide the period.
    """
    period, step = rotational_period(study), degrees(study.full.orientation_step)
    if not _is_whole(period / step):
        rule = f"must divide {period:g} deg, after which the wheel repeats itself"
        raise InputError("full.orientation_step", f"{step:g} deg", rule, _steps_near(period, step))
    return [i * step for i in range(round(period / step))]


def full_study(study: Study) -> Study:
    """The study with all orientations from 0 to the period, its own mesh, and a mesh study at each of them.

    The initial tangent is still that of the study's own orientations, on which its strip was chosen: the same check
    on a finer mesh. That of the mean around the wheel is another check.

    Raises
    ------
    InputError
        If the step does not divide the period, or an orientation the study names is not one of its multiples.
    """
    if (reason := without_wheel(study, "a full study")) is not None:
        raise reason
    full, steps = study.full, steps_around(study)
    step = degrees(full.orientation_step)
    for orientation in (degrees(o) for o in study.fe.orientations):
        if not any(abs(orientation - o) < _SAME for o in steps):
            rule = f"is not among 0 to {steps[-1]:g} deg by {step:g} deg"
            raise InputError("fe.orientations", f"{orientation:g} deg", rule, "choose another full.orientation_step")
    mesh_study, around = study.mesh_study, tuple(math.radians(o) for o in steps)
    return study.model_copy(
        update={
            "reference": study.reference and _of_the_same_orientations(study.reference, study),
            "title": f"{study.title}: full study",
            "fe": study.fe.model_copy(update={"orientations": around}),
            "mesh": sized_mesh(study).model_copy(update={"factor": full.factor}),
            "rover": _all_runs(study.rover),
            "mesh_study": mesh_study
            and mesh_study.model_copy(update={"factors": full.mesh_study_factors, "orientations": around}),
        }
    )


def _of_the_same_orientations(reference: ReferenceSection, study: Study) -> ReferenceSection:
    """The slope stays that of the study's own orientations: it was stated for their mean."""
    if reference.slope is None:
        return reference
    around = reference.slope.orientations or study.fe.orientations
    return reference.model_copy(update={"slope": reference.slope.model_copy(update={"orientations": around})})


def _all_runs(rover: RoverSection | None) -> RoverSection | None:
    """Every run on ANCF tires, unless the rover does not run on ANCF tires at all."""
    if rover is None or rover.on_ancf_tires == "none":
        return rover
    return rover.model_copy(update={"on_ancf_tires": "all"})


def _steps_near(period: float, step: float) -> str:
    """What to try in place of a step [deg] that does not divide the period [deg]: the next that do, round if any is."""
    every = [period / count for count in range(1, 361)]
    known = [one for one in every if _is_whole(4.0 * one)] or every
    near = {min(known, key=lambda one: abs(one - step))}
    for side in ([one for one in known if one < step], [one for one in known if one > step]):
        near |= {min(side, key=lambda one: abs(one - step))} if side else set()
    return f"choose {' or '.join(f'{one:.10g}' for one in sorted(near))} deg"


def _is_whole(number: float) -> bool:
    return abs(number - round(number)) < _SAME
