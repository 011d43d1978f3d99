"""Question: the rover on fitted ANCF tires against the continuum's curves, at every orientation of the wheel.

Verified by tests/unit/test_workbench_rover_crosscheck.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from contracts.curves import read_curve
from contracts.errors import InputError
from contracts.materials_temperature import temperature_data
from contracts.records import Check, Role
from rover_dynamics.rover.rover_file import read_rover
from workbench.execution.result_files import FAILURE, read_result
from workbench.execution.task import Task
from workbench.questions.ancf_fit.graph import fit_name
from workbench.questions.fe.graph import curve_deflections
from workbench.questions.mesh_study.question import mesh_study_inputs
from workbench.questions.mesh_study.results import read_mesh_study
from workbench.questions.model_curves import CURVE, model_curves
from workbench.questions.question import Question
from workbench.questions.rover_crosscheck.figures import crosscheck_figures
from workbench.questions.rover_crosscheck.results import (
    ALLOWED,
    CrossCheck,
    Difference,
    StoodTire,
    Warmth,
    WheelPoint,
    unsolved,
)
from workbench.questions.section.graph import section_task, without_planar_model
from workbench.study.full import around, is_mirrored, rotational_period
from workbench.study.model import Study, stated
from workbench.study.model_parameters import fits_rover
from workbench.study.orientation import degrees, orientation_name
from workbench.verdict.rules import Claim, at_most

__all__ = ["ROVER_CROSSCHECK"]

SWEEP = (160.0, 175.0, 190.0, 205.0, 220.0, 235.0, 250.0)
"""Mean wheel loads of the thesis' sweep [N]."""
TEMPERATURES = (130.15, 233.15, 293.15, 308.15)
"""-143, -40, 20 and 35 C [K]."""
_REACH = 0.03
"""Deflection [m] that the FE curves must reach at least, for a wheel of the rover to stand on them."""


def _tasks(study: Study) -> Sequence[Task]:
    """One for each fitted tire, the kept one with the load sweep; planar models of orientations without a solid one."""
    section = stated(study.ancf_fit, "ancf_fit")
    tasks = [
        Task(
            name=f"rover_stands_{tire.name}",
            function="workbench.questions.rover_crosscheck.task:stand",
            inputs={
                "fit": fit_name(tire.name),
                "loads": list(SWEEP) if tire == section.kept else [],
                "modulus_ratios": [ratio for _, ratio in _modulus_ratios()] if tire == section.kept else [],
            },
            needs=(fit_name(tire.name),),
            cost=10.0,
        )
        for tire in section.tires
    ]
    points = curve_deflections(study)
    return tasks + [section_task(study, _section_name(o), o, points) for o in _section_orientations(study)]


def _modulus_ratios() -> list[tuple[float, float]]:
    """Temperature [K] and modulus of Ti-6Al-4V over that at 20 C."""
    table = temperature_data("Ti-6Al-4V").modulus_ratio
    return [(T, table.at(T)) for T in TEMPERATURES]


def _section_name(orientation: float) -> str:
    return orientation_name("crosscheck", orientation)


def _section_orientations(study: Study) -> list[float]:
    if without_planar_model(study) is not None:
        return []
    return unsolved([degrees(o) for o in study.fe.orientations], rotational_period(study), is_mirrored(study))


def _read(study: Study, folders: Mapping[str, Path]) -> CrossCheck:
    section, fe = stated(study.ancf_fit, "ancf_fit"), model_curves("fe", folders, around(study))
    planar = {
        o: read_curve(folders[_section_name(o)] / CURVE, model="section", orientation_deg=o)
        for o in _section_orientations(study)
    }
    return CrossCheck(
        stood=tuple(_stood(tire.name, folders[f"rover_stands_{tire.name}"], tire.spokes) for tire in section.tires),
        kept=section.kept.name,
        solid=fe.loaded,
        section={o: curve for o, curve in planar.items() if not curve.unloaded},
        average=fe.average,
        period=rotational_period(study),
        mirrored=is_mirrored(study),
        mesh_study=read_mesh_study(**mesh_study_inputs(study), folders=folders),
        static_load=read_rover().static_load,
        warmth=_warmth(folders[f"rover_stands_{section.kept.name}"]),
    )


def _warmth(folder: Path) -> tuple[Warmth, ...]:
    found = read_result(folder).get("deflections_at_modulus", [])
    pairs = zip(_modulus_ratios(), found, strict=False)
    return tuple(Warmth(temperature=T, modulus_ratio=ratio, deflection=d) for (T, ratio), d in pairs)


def _stood(name: str, folder: Path, spokes: int) -> StoodTire:
    numbers = read_result(folder)
    points = tuple(WheelPoint(**row) for row in numbers["points"])
    return StoodTire(name=name, period=360.0 / spokes, points=points, failure=numbers.get(FAILURE))


def _checks(study: Study, results: CrossCheck) -> Sequence[Check]:
    """Findings: how near a fitted tire comes is what it is asked."""
    return [
        _check(results, "static_average", "static equilibrium, mean over the orientations", "finding"),
        _check(results, "sweep_average", "160 to 250 N, mean over the orientations", "finding"),
        _check(results, "static_orientations", "static equilibrium, worst orientation", "finding"),
        _check(results, "sweep_orientations", "160 to 250 N, worst orientation", "finding"),
    ]


def _check(results: CrossCheck, name: str, what: str, role: Role) -> Check:
    """The difference that lies furthest beyond the numerical uncertainty, against what is allowed there."""
    claim = Claim(
        id=f"rover_crosscheck.{name}",
        title=f"Rover on the fitted ANCF tire against FE, {what}: load or deflection",
        quantity="difference",
        unit="-",
        role=role,
        source="our own continuum model, solid or planar; limit: its grid convergence index and 5 %",
    )
    try:
        worst = max(_differences(results, name), key=lambda d: d.beyond)
    except InputError as error:
        return at_most(claim, _raiser(error), ALLOWED)
    return at_most(claim, lambda: worst.largest, round(worst.allowed, 4))


def _differences(results: CrossCheck, name: str) -> list[Difference]:
    sweep, average = name.startswith("sweep"), name.endswith("average")
    tire = results.best
    loads = tire.loads if sweep else [results.static_load]
    return [d for f in loads for d in ([results.on_average(tire, f)] if average else results.around(tire, f))]


def _raiser(error: InputError) -> Callable[[], float]:
    def number() -> float:
        raise error

    return number


def _applies(study: Study) -> bool:
    asked = study.rover is not None and study.ancf_fit is not None
    return asked and study.fe.max_deflection >= _REACH and fits_rover(study)


ROVER_CROSSCHECK = Question(
    name="rover_crosscheck",
    title="Rover against FE",
    group="Rover",
    tasks=_tasks,
    read=_read,
    checks=_checks,
    figures=crosscheck_figures,
    applies=_applies,
    budget=1030,
)
