"""Question: how does the study's ANCF tire carry load, and is it the thesis' where it says so?

Verified by tests/unit/test_workbench_checks.py, tests/unit/test_workbench_ancf_surfaces.py,
tests/unit/test_workbench_graph.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.execution.result_files import read_result
from workbench.execution.task import Task
from workbench.questions.ancf.figures import ancf_figures
from workbench.questions.ancf.preset_table import COLUMNS, preset_table
from workbench.questions.ancf.results import AncfTireResults
from workbench.questions.model_curves import ModelCurves, model_curves
from workbench.questions.question import Question
from workbench.study.full import around
from workbench.study.model import Study, stated
from workbench.study.model_parameters import ancf_tire
from workbench.study.orientation import degrees, orientation_name
from workbench.study.sections import AncfSection, ToleranceSection
from workbench.study.thesis import WHEEL_MASS
from workbench.verdict.rules import Claim, at_most, near

__all__ = [
    "ANCF",
    "SURFACES",
    "ancf_checks",
    "ancf_curve_tasks",
    "preset_error",
    "read_ancf",
    "report_surfaces_task",
    "surfaces_check",
    "surfaces_task",
]


def ancf_curve_tasks(study: Study, orientations_deg: Sequence[float] = ()) -> list[Task]:
    """A curve at each orientation [deg]; none means those of the study."""
    ancf = stated(study.ancf, "ancf")
    grid = np.linspace(0.0, ancf.max_deflection, ancf.points + 1).round(12).tolist()
    points = sorted({*grid, *_table_deflections(ancf)})
    tire = ancf_tire(study)
    return [
        Task(
            name=orientation_name("ancf", orientation),
            function="workbench.questions.ancf.task:solve_orientation",
            inputs=tire | {"orientation_deg": orientation, "deflections": points},
            cost=10.0,
        )
        for orientation in orientations_deg or [degrees(o) for o in ancf.orientations]
    ]


def _table_deflections(ancf: AncfSection) -> list[float]:
    """Deflections of the preset's table [m] that the study reaches, solved themselves and never interpolated."""
    if not ancf.thesis_preset:
        return []
    return [d for d in preset_table()[:, 0].round(12).tolist() if d <= ancf.max_deflection]


SURFACES = "ancf_surfaces"
"""Name of the task."""
_REPORTED_DEFLECTION = 0.010
"""Deflection [m] of the loaded tire in the report, where a study reaches it."""


def surfaces_task(study: Study, orientation_deg: float, deflections: Sequence[float]) -> Task:
    """The tire unloaded, and at deflections [m] in increasing order at one orientation."""
    return Task(
        name=SURFACES,
        function="workbench.questions.ancf.surfaces_task:write_surfaces",
        inputs=ancf_tire(study) | {"orientation_deg": orientation_deg, "deflections": list(deflections)},
        cost=3.0,
    )


def report_surfaces_task(study: Study) -> Task:
    """What the report states: the first orientation, unloaded and at 10 mm."""
    ancf = stated(study.ancf, "ancf")
    return surfaces_task(study, degrees(ancf.orientations[0]), [min(_REPORTED_DEFLECTION, ancf.max_deflection)])


def read_ancf(study: Study, folders: Mapping[str, Path]) -> AncfTireResults:
    """The results from the folders of their tasks."""
    return AncfTireResults(
        ancf=model_curves("ancf", folders),
        fe_average=model_curves("fe", folders, around(study)).average,
        read_back=read_result(folders[SURFACES])["read_back_m"],
    )


_PRESET_SOURCE = (
    "two independent codes computed for this project, which agree (workbench/questions/ancf/ancf_thesis_preset.csv)"
)
_SMALLEST_LOAD = 5.0
"""Load [N] below which an entry of the preset's table counts absolutely."""


def preset_error(ancf: ModelCurves, orientation_deg: float) -> float:
    """Largest |F - F_table| / max(F_table, 5 N) over the table's entries [-].

    Each entry above 5 N counts relative to itself; at or below 5 N, 1 % of this error is 0.05 N.
    """
    if orientation_deg not in ancf.by_orientation:
        known = ", ".join(f"{o:g}" for o in ancf.by_orientation)
        rule = f"was not computed (only {known} deg)"
        raise InputError("orientation", f"{orientation_deg:g} deg", rule, "add it to ancf.orientations")
    table = preset_table()
    known_loads = table[:, COLUMNS[orientation_deg]]
    found = ancf.by_orientation[orientation_deg].load_at(table[:, 0])
    return float((np.abs(found - known_loads) / np.maximum(known_loads, _SMALLEST_LOAD)).max())


def ancf_checks(ancf: ModelCurves, tolerances: ToleranceSection) -> list[Check]:
    """The thesis preset's curves against their table, and its flexible mass against Table I."""
    checks = [
        at_most(
            Claim(
                id=f"ancf.preset_phi{o:03.0f}",
                title=f"ANCF thesis preset at {o:g} deg against its known table, 2 to 35 mm",
                quantity="largest difference / load, 5 N at least",
                unit="-",
                role="gate",
                source=_PRESET_SOURCE,
            ),
            partial(preset_error, ancf, o),
            tolerances.ancf_preset,
        )
        for o in COLUMNS
    ]
    mass = Claim(
        id="ancf.flexible_mass",
        title="ANCF thesis preset: mass of the flexible plates against the wheel of Table I",
        quantity="mass",
        unit="kg",
        role="gate",
        source="Samarini 2020, Table I",
    )
    first = next(iter(ancf.runs.values()))
    return [*checks, near(mass, lambda: first.flexible_mass, WHEEL_MASS, tolerances.flexible_mass)]


def surfaces_check(distance: Callable[[], float], tolerances: ToleranceSection) -> Check:
    """The ANCF tire's surfaces in STEP files, unloaded and loaded, against the plates' own [m]."""
    return at_most(
        Claim(
            id="ancf.surfaces",
            title="ANCF tire as B-spline surfaces in STEP files, read back by gmsh: unloaded and loaded",
            quantity="largest distance",
            unit="m",
            role="gate",
            source="thesis eq. 2.13 at points of every plate's faces and mid-surface",
        ),
        distance,
        tolerances.surface_distance,
    )


def _checks(study: Study, results: AncfTireResults) -> Sequence[Check]:
    tolerances = study.tolerances
    preset = ancf_checks(results.ancf, tolerances) if stated(study.ancf, "ancf").thesis_preset else []
    return [surfaces_check(lambda: results.surface_distance, tolerances), *preset]


def _curves(study: Study, results: AncfTireResults) -> Sequence[StiffnessCurve]:
    return [*results.ancf.by_orientation.values(), results.ancf.average]


ANCF = Question(
    name="ancf",
    title="ANCF",
    group="ANCF tire",
    tasks=lambda study: [*ancf_curve_tasks(study), report_surfaces_task(study)],
    read=read_ancf,
    checks=_checks,
    figures=ancf_figures,
    curves=_curves,
    applies=lambda study: study.ancf is not None,
)
