"""The question of the ANCF tire's number of plates: tasks, numbers and the finding."""

from __future__ import annotations

from pathlib import Path

import pytest

from workbench.questions.ancf_mesh.question import ANCF_MESH, FACTORS, AncfMeshRow, AncfMeshStudy
from workbench.questions.ancf_mesh.task import solve_refined
from workbench.study.reading import built_in_study, read_study


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> AncfMeshStudy:
    """Computed as the report does, on its own folders; only the two coarsest meshes, the finer ones copied."""
    study, folders = read_study(built_in_study()), dict[str, Path]()
    for task in ANCF_MESH.tasks(study):
        folder = tmp_path_factory.mktemp(task.name)
        inputs = task.inputs | {"plates": min(task.inputs["plates"], 8), "deflections": [0.01, 0.02, 0.03]}
        assert solve_refined(inputs, {}, folder, lambda fraction: None) > 0
        folders[task.name] = folder
    found = ANCF_MESH.read(study, folders)
    assert isinstance(found, AncfMeshStudy)
    return found


def test_rows_carry_what_was_computed(results: AncfMeshStudy) -> None:
    assert [row.plates for row in results.rows] == [4 * factor for factor in FACTORS]
    own, finer = results.rows[:2]
    assert own.outer_face_error == pytest.approx(3.66e-3, rel=1e-2)
    assert finer.outer_face_error < 0.3 * own.outer_face_error
    assert [orientation for orientation, _ in own.loads] == [0.0, 45.0]
    assert own.loads[0][1][1] == pytest.approx(173.8, rel=1e-2)  # theory notes, section 7
    assert finer.dofs > own.dofs


def test_excess_is_that_of_the_coarsest_over_the_finest() -> None:
    rows = tuple(
        AncfMeshRow(plates=n, dofs=n, outer_face_error=0.0, loads=((0.0, (10.0 * n, None)), (45.0, (n, 7.0))))
        for n in (4, 8)
    )
    assert AncfMeshStudy(deflections=(0.01, 0.02), rows=rows).largest_excess == pytest.approx(0.5)


def test_a_coarse_rim_is_a_finding_not_an_error(results: AncfMeshStudy) -> None:
    (check,) = ANCF_MESH.checks(read_study(built_in_study()), results)
    assert check.role == "finding"
    assert check.status == "fail"
    assert check.value is not None
    assert check.value == results.largest_excess > 0.3
