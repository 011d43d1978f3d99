"""The mesh study: index at solved deflections, band of a curve, uncertainty of a distance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.execution.task import task_keys
from workbench.questions.mesh_study.question import MESH_STUDY
from workbench.questions.mesh_study.results import MeshFamily, MeshRun, MeshStudy, sorted_runs
from workbench.questions.model_curves import RunNumbers
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study

D = (0.010, 0.020, 0.030)
EXACT = (80.0, 160.0, 240.0)


def _curve(deflections: Sequence[float], loads: Sequence[float]) -> StiffnessCurve:
    d, f = (np.array([0.0, *values]) for values in (deflections, loads))
    return StiffnessCurve(model="fe", orientation_deg=15.0, deflection=d, load=f)


def _family(
    errors: Sequence[float] = (0.01, 0.02, 0.03), factor: float = 1.0, factors: Sequence[float] = (1.0, 2.0, 4.0)
) -> MeshFamily:
    """Errors of the coarse mesh at the three deflections, second order in the element size."""
    runs = []
    for k in factors:
        loads = [f * (1.0 + e / k**2) for f, e in zip(EXACT, errors, strict=True)]
        cells = RunNumbers(cells=round(100 * k**2), dofs=1)
        runs.append(MeshRun(factor=float(k), curve=_curve(D, loads), numbers=cells))
    return MeshFamily(orientation_deg=15.0, deflections=D, runs=sorted_runs(runs), curves_factor=factor)


def _study(*errors: Sequence[float], factor: float = 1.0) -> MeshStudy:
    """A family for each set of errors."""
    return MeshStudy(families=tuple(_family(e, factor) for e in errors or ((0.01, 0.02, 0.03),)))


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
    study = _study((0.02, 0.02, 0.02))
    curve = study.runs[-1].curve
    assert study.l2_uncertainty(curve, 0.0, 0.030) == pytest.approx(study.index(0.020))


def test_loads_are_never_interpolated_and_a_short_curve_is_left_out() -> None:
    study = _family()
    fine, medium, _ = study.runs
    short = MeshRun(factor=1.0, curve=_curve(D[:2], (80.8, 163.2)), numbers=study.runs[2].numbers)
    cut = replace(study, runs=(fine, medium, short))
    with pytest.raises(InputError, match="was not solved"):
        cut.index(0.030)
    with pytest.raises(InputError, match="was not solved"):
        study.convergence(0.015)
    assert [row.found is None for row in cut.rows] == [False, False, True]
    both = MeshStudy(families=(cut, study))
    assert both.relative_uncertainty(np.array([0.030])) == pytest.approx([study.index(0.030)])
    assert MeshStudy(families=(cut,)).relative_uncertainty(np.array([0.030])) == pytest.approx([study.index(0.020)])


def test_the_least_certain_orientation_speaks_for_all() -> None:
    study = _study((0.01, 0.02, 0.03), (0.02, 0.01, 0.06))
    first, second = study.families
    assert [study.index(d) for d in D] == [second.index(D[0]), first.index(D[1]), second.index(D[2])]
    assert study.relative_uncertainty(np.array(D)) == pytest.approx([study.index(d) for d in D])
    assert len(study.runs) == 6


@pytest.mark.parametrize("factors", [(1.0, 1.5, 2.0), (1.0, 1.2, 2.0), (4.0, 5.0, 8.0)])
def test_meshes_that_are_not_similar_or_too_near_have_no_order_that_is_believed(factors: tuple[float, ...]) -> None:
    """The loads are of second order still, so that it is the meshes that are doubted: 3 in place of 1.25."""
    doubted = _family(factor=factors[0], factors=factors)
    assert not doubted.similar
    assert _family().similar
    found = doubted.convergence(0.020)
    assert (found.order, found.safety) == (2.0, 3.0)
    error = 0.02 / factors[0] ** 2
    assert doubted.index(0.020) == pytest.approx(3.0 * error / (1.0 + error), rel=1e-3)


def test_stress_is_that_which_decides_first_yield_at_the_last_deflection() -> None:
    """Linearised stress of second order; the notch, which has no limit, and a part of less stress decide nothing."""

    def stressed(run: MeshRun) -> MeshRun:
        d, k = run.curve.deflection / D[-1], run.factor
        columns = {
            "max_linearised_springs_Pa": 900e6 * d * (1.0 - 0.04 / k**2),
            "max_von_mises_springs_Pa": 900e6 * d * (1.0 + 0.2 * k),
            "max_von_mises_tire_Pa": 400e6 * d,
        }
        return replace(run, curve=replace(run.curve, columns=columns))

    plain = _family()
    fine, medium, coarse = (stressed(run) for run in plain.runs)
    family = replace(plain, runs=(fine, medium, coarse))
    strengths = {"springs": 1000e6, "tire": 1000e6}
    assert family.stress_convergence(strengths).values == pytest.approx((0.89775, 0.891, 0.864))
    assert MeshStudy(families=(family,)).stress_index(strengths) == pytest.approx(1.25 * 0.04 / 0.96)
    with pytest.raises(InputError, match="has no stress"):
        plain.stress_index(strengths)


@pytest.fixture(scope="module")
def shipped() -> Study:
    return read_study(built_in_study())


def test_tasks_solve_every_other_mesh_at_the_deflections_and_no_further(shipped: Study) -> None:
    tasks = {task.name: task for task in MESH_STUDY.tasks(shipped)}
    two = ["mesh_x2", "fe_x2_phi000", "fe_x2_phi015"]
    assert list(tasks) == [*two, "mesh_x3", "fe_x3_phi000", "fe_x3_phi015"]
    assert tasks["fe_x2_phi015"].needs == ("mesh_x2",)
    assert tasks["fe_x2_phi015"].inputs["deflections"] == [0.01, 0.03]
    assert tasks["mesh_x2"].inputs["options"]["factor"] == 2.0
    finer = shipped.model_copy(update={"mesh": shipped.mesh.model_copy(update={"factor": 3.0})})
    assert [task.name for task in MESH_STUDY.tasks(finer)] == ["mesh_x1", "fe_x1_phi000", "fe_x1_phi015", *two]


def test_deflections_of_the_study_change_its_keys(shipped: Study) -> None:
    section = shipped.mesh_study.model_copy(update={"deflections": (0.01, 0.02)})
    other = shipped.model_copy(update={"mesh_study": section})
    before, after = (task_keys(tuple(MESH_STUDY.tasks(study))) for study in (shipped, other))
    assert {name for name in before if before[name] != after[name]} == {
        *("fe_x2_phi000", "fe_x2_phi015", "fe_x3_phi000", "fe_x3_phi015")
    }


def test_check_is_a_gate_that_a_coarse_mesh_fails(shipped: Study) -> None:
    """The built-in study asks for 1 %."""
    for errors, status in (((0.004, 0.006, 0.007), "pass"), ((0.004, 0.006, 0.009), "fail")):
        load, stress = MESH_STUDY.checks(shipped, _study(errors))
        assert (load.id, load.role, load.status) == ("fe.mesh_uncertainty", "gate", status)
        assert (stress.id, stress.role, stress.status) == ("fe.stress_uncertainty", "finding", "error")
