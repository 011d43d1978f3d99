"""What tasks will take, known before they run: unknowns as solved, laws as measured, refusal in seconds."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from contracts.errors import InputError, MemoryLimitError
from contracts.hub_travel import Way
from contracts.memory import MemoryBound
from workbench.execution.memory import memory_warning
from workbench.execution.task import Task, chain_costs, task_keys
from workbench.questions.curve_graph import mesh_tasks, stiffness_tasks
from workbench.questions.fe.foresight import modes_bytes, solve_bytes, solve_seconds
from workbench.questions.modes.graph import AskedModes, modes_tasks
from workbench.questions.study_graph import report_tasks
from workbench.questions.travels import travel_tasks
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study

STUDY = read_study(built_in_study().parent / "exomars_hoops.toml")
MEASURED = {15600: 324, 25416: 368, 53028: 514, 112608: 762, 133224: 875, 228240: 1330}
MEASURED_ROUGH = {15600: 369, 25416: 443, 53028: 689, 112608: 1186, 133224: 1388, 228240: 2222}
MEASURED_MODES = {15600: 845, 25416: 876, 43008: 1087, 53028: 1286, 112608: 2202, 133224: 2532, 228240: 4197}
"""Unknowns -> largest resident memory [MB] of a process that solved the wheel, without and with friction, or found six
modes; benchmarks/README.md, "Memory foretold"."""
TIMED = {36612: 0.179, 91872: 0.464, 227196: 1.359}
"""Unknowns -> time of an iteration [s], benchmarks/README.md."""


def _finer(times: float) -> Study:
    mesh = STUDY.mesh
    sizes = {name: getattr(mesh, name) / times for name in ("element_size", "axial_size", "edge_size")}
    return STUDY.model_copy(update={"mesh": mesh.model_copy(update=sizes)})


def _solves(tasks: tuple[Task, ...]) -> list[Task]:
    return [task for task in tasks if task.function == "workbench.questions.fe.task:solve_orientation"]


def test_the_law_of_memory_is_what_was_measured() -> None:
    for unknowns, megabytes in MEASURED.items():
        assert solve_bytes(unknowns) == pytest.approx(1e6 * megabytes, rel=0.05)
    for unknowns, megabytes in MEASURED_ROUGH.items():
        assert solve_bytes(unknowns, rough=True) == pytest.approx(1e6 * megabytes, rel=0.05)
    for unknowns, megabytes in MEASURED_MODES.items():
        assert modes_bytes(unknowns) == pytest.approx(1e6 * megabytes, rel=0.05)


def test_the_law_of_time_is_what_was_measured() -> None:
    for unknowns, seconds in TIMED.items():
        assert (solve_seconds(unknowns, 1) - solve_seconds(1.0, 1)) / 3.0 == pytest.approx(seconds, rel=0.08)


def test_unknowns_are_those_that_are_solved() -> None:
    """53 028 on the mesh of the hoops' curves; the whole graph has an expectation for each mesh and solve."""
    tasks = report_tasks(STUDY)
    curve = next(task for task in _solves(tasks) if task.name == "fe_phi000")
    assert curve.unknowns == pytest.approx(53028, rel=0.05)
    assert all(task.memory > 2.8e8 and task.unknowns > 10_000 for task in _solves(tasks))
    assert all(task.memory > 0.0 for task in tasks if task.function == "workbench.questions.wheel.mesh_task:build")


def test_a_mesh_ten_times_finer_needs_7_gb() -> None:
    """By the law, far beyond what it is fitted to; and more than its share of the time."""
    (solve,), (own,) = (_solves(stiffness_tasks(study, "fe", (0.0,))) for study in (_finer(10.0), STUDY))
    assert solve.memory == pytest.approx(6.6e9, rel=0.05)
    assert solve.cost / own.cost > solve.unknowns / own.unknowns > 20.0


@pytest.mark.parametrize("times", [100.0, 1e6])
def test_a_mesh_that_nothing_could_hold_is_refused_when_the_graph_is_made(times: float) -> None:
    with pytest.raises(InputError, match="cells, at most"):
        stiffness_tasks(_finer(times), "fe", (0.0,))
    with pytest.raises(InputError, match="cells, at most"):
        mesh_tasks(_finer(times))


def test_friction_takes_more_memory_and_modes_most() -> None:
    """On the same mesh of 53 028 unknowns; a travel has friction whatever [fe] says."""
    rough = STUDY.model_copy(update={"fe": STUDY.fe.model_copy(update={"friction": 0.3})})
    (smooth,), (sliding,) = (_solves(stiffness_tasks(study, "fe", (0.0,))) for study in (STUDY, rough))
    moved = travel_tasks(STUDY, "fe", (Way.WIND_UP,), 100.0, (0.0,))[-1]
    modes = modes_tasks(STUDY, ("fe",), AskedModes(state="held", load=0.0, orientation_deg=0.0, count=6))[-1]
    assert smooth.unknowns == sliding.unknowns == moved.unknowns == modes.unknowns
    assert 1.3 * smooth.memory < sliding.memory == moved.memory < 0.6 * modes.memory


def test_expectations_are_no_part_of_a_key() -> None:
    tasks = stiffness_tasks(STUDY, "fe", (0.0,))
    bare = tuple(replace(task, cost=1.0, memory=0.0, unknowns=0) for task in tasks)
    assert task_keys(tasks) == task_keys(bare)


def test_sidewall_springs_are_counted() -> None:
    study = read_study(Path(__file__).parents[2] / "studies" / "amalia.toml")
    assert _solves(stiffness_tasks(study, "fe", (0.0,)))[0].unknowns > 10_000


def test_who_has_most_before_it_starts_first() -> None:
    """A short mesh that a long solve waits for goes before a task of middling length."""
    mesh = Task(name="mesh", function="m:f", inputs={}, cost=2.0)
    solve = Task(name="solve", function="m:f", inputs={}, needs=("mesh",), cost=50.0)
    other = Task(name="other", function="m:f", inputs={}, cost=30.0)
    assert chain_costs((mesh, other, solve)) == {"mesh": 52.0, "other": 30.0, "solve": 50.0}


def test_a_mesh_from_another_program_is_counted_before_it_is_solved() -> None:
    """The spiral wheel's 13 950 unknowns took 321 MB; divided in six along each axis they are many, and told."""
    study = read_study(built_in_study().parent / "spiral.toml")
    (own,) = _solves(stiffness_tasks(study, "fe", (0.0,)))
    assert own.unknowns == 13950
    assert own.memory == pytest.approx(321e6, rel=0.05)
    fine = study.model_copy(update={"mesh": study.mesh.model_copy(update={"factor": 6})})
    mesh, solve = stiffness_tasks(fine, "fe", (0.0,))
    assert solve.unknowns > 100 * own.unknowns
    with pytest.raises(MemoryLimitError, match="task fe_phi000 needs about"):
        memory_warning((mesh, solve), 1, total=MemoryBound(bytes=1e9, source="in a test"))
