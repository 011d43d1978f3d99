"""The mesh study: index at solved deflections, band of a curve, uncertainty of a distance."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.execution.task import task_keys
from workbench.questions.mesh_study.question import MESH_STUDY
from workbench.questions.mesh_study.results import MeshRun, MeshStudy, sorted_runs
from workbench.questions.model_curves import RunNumbers
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study

D = (0.010, 0.020, 0.030)
EXACT = (80.0, 160.0, 240.0)


def _curve(deflections: Sequence[float], loads: Sequence[float]) -> StiffnessCurve:
    d, f = (np.array([0.0, *values]) for values in (deflections, loads))
    return StiffnessCurve(model="fe", orientation_deg=15.0, deflection=d, load=f)


def _study(errors: Sequence[float] = (0.01, 0.02, 0.03), factor: float = 1.0) -> MeshStudy:
    """Errors of the coarse mesh at the three deflections, second order in the element size."""
    runs = []
    for k in (1, 2, 4):
        loads = [f * (1.0 + e / k**2) for f, e in zip(EXACT, errors, strict=True)]
        runs.append(MeshRun(factor=float(k), curve=_curve(D, loads), numbers=RunNumbers(cells=100 * k**2, dofs=1)))
    return MeshStudy(orientation_deg=15.0, deflections=D, runs=sorted_runs(runs), curves_factor=factor)


def test_index_is_that_of_the_curves_own_mesh() -> None:
    for factor, error in ((1.0, 0.02), (2.0, 0.005), (4.0, 0.00125)):
        assert _study(factor=factor).index(0.020) == pytest.approx(1.25 * error / (1.0 + error), rel=1e-6)


def test_band_holds_the_exact_curve_and_is_linear_between_the_deflections() -> None:
    study = _study()
    curve = study.runs[-1].curve
    low, high = study.band(curve)
    assert np.all(low[1:] < EXACT)
    assert np.all(high >= curve.load)
    middle = study.relative_uncertainty(np.array([0.0, 0.015, 0.040]))
    assert middle == pytest.approx([study.index(0.010), 0.5 * (study.index(0.010) + study.index(0.020)),
                                    study.index(0.030)])  # fmt: skip


def test_uncertainty_of_a_distance_is_the_band_s_norm() -> None:
    study = _study(errors=(0.02, 0.02, 0.02))
    curve = study.runs[-1].curve
    assert study.l2_uncertainty(curve, 0.0, 0.030) == pytest.approx(study.index(0.020))


def test_loads_are_never_interpolated_and_a_short_curve_is_left_out() -> None:
    study = _study()
    fine, medium, _ = study.runs
    short = MeshRun(factor=1.0, curve=_curve(D[:2], (80.8, 163.2)), numbers=study.runs[2].numbers)
    cut = MeshStudy(orientation_deg=15.0, deflections=D, runs=(fine, medium, short), curves_factor=1.0)
    with pytest.raises(InputError, match="was not solved"):
        cut.index(0.030)
    with pytest.raises(InputError, match="was not solved"):
        study.convergence(0.015)
    assert [row.found is None for row in cut.rows] == [False, False, True]
    assert cut.relative_uncertainty(np.array([0.030])) == pytest.approx([study.index(0.020)])


@pytest.fixture(scope="module")
def shipped() -> Study:
    return read_study(built_in_study())


def test_tasks_solve_every_other_mesh_at_the_deflections_and_no_further(shipped: Study) -> None:
    tasks = {task.name: task for task in MESH_STUDY.tasks(shipped)}
    assert list(tasks) == ["mesh_x1.5", "fe_x1.5", "mesh_x2", "fe_x2"]
    assert tasks["fe_x2"].needs == ("mesh_x2",)
    assert tasks["fe_x2"].inputs["deflections"] == [0.01, 0.02, 0.03]
    assert tasks["mesh_x2"].inputs["options"]["factor"] == 2.0
    finer = shipped.model_copy(update={"mesh": shipped.mesh.model_copy(update={"factor": 1.5})})
    assert [task.name for task in MESH_STUDY.tasks(finer)] == ["mesh_x1", "fe_x1", "mesh_x2", "fe_x2"]


def test_deflections_of_the_study_change_its_keys(shipped: Study) -> None:
    section = shipped.mesh_study.model_copy(update={"deflections": (0.01, 0.02)})
    other = shipped.model_copy(update={"mesh_study": section})
    before, after = (task_keys(tuple(MESH_STUDY.tasks(study))) for study in (shipped, other))
    assert {name for name in before if before[name] != after[name]} == {"fe_x1.5", "fe_x2"}


def test_check_is_a_gate_that_a_coarse_mesh_fails(shipped: Study) -> None:
    for errors, status in (((0.01, 0.02, 0.03), "pass"), ((0.01, 0.02, 0.06), "fail")):
        (check,) = MESH_STUDY.checks(shipped, _study(errors))
        assert (check.id, check.role, check.status) == ("fe.mesh_uncertainty", "gate", status)
