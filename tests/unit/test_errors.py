"""Every error text gives what, the value, the rule and what to try; errors survive a worker process."""

from __future__ import annotations

import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import pytest

from contracts.errors import ConvergenceError, IncrementRecord, InputError, MeshError, StudyError, WorkbenchError


class SectionError(InputError):
    """A subclass with another constructor, as packages may define one."""

    def __init__(self, section: str) -> None:
        super().__init__("what", "value", "rule", "hint")
        self.section = section


RECORDS = (
    IncrementRecord(target=1e-3, step=1e-3, converged=True, residuals=(1.0, 1e-9)),
    IncrementRecord(target=3e-3, step=2e-3, converged=False, residuals=(1.0, 0.5, 0.7)),
)


def test_input_error_text() -> None:
    error = InputError("tire thickness", "-0.6 mm", "must be greater than zero", "give a thickness such as 0.6 mm")
    assert str(error) == "tire thickness = -0.6 mm: must be greater than zero; give a thickness such as 0.6 mm"
    assert (error.what, error.value) == ("tire thickness", "-0.6 mm")
    assert (error.rule, error.hint) == ("must be greater than zero", "give a thickness such as 0.6 mm")


def test_study_error_names_file_and_key() -> None:
    error = StudyError(Path("a/b.toml"), "wheel.thickness", "0.6 kg", "must be a length", "use mm or m")
    assert str(error) == "a/b.toml: wheel.thickness = 0.6 kg: must be a length; use mm or m"
    assert (error.path, error.key, error.value) == ("a/b.toml", "wheel.thickness", "0.6 kg")


def test_study_error_of_a_whole_file_names_the_file_only() -> None:
    assert str(StudyError("b.toml", "", "", "is empty", "copy a study")) == "b.toml: is empty; copy a study"


def test_convergence_error_carries_history_and_last_good_state() -> None:
    error = ConvergenceError("stopped at 3 mm", list(RECORDS), last_good="state")
    assert str(error) == "stopped at 3 mm"
    assert error.history == RECORDS
    assert error.last_good == "state"


@pytest.mark.parametrize("kind", [InputError, StudyError, MeshError, ConvergenceError])
def test_one_tree(kind: type[Exception]) -> None:
    assert issubclass(kind, WorkbenchError)


def test_input_errors_are_value_errors() -> None:
    assert issubclass(InputError, ValueError)
    assert issubclass(StudyError, ValueError)
    assert not issubclass(ConvergenceError, ValueError)


@pytest.mark.parametrize(
    "error",
    [
        InputError("a", "1 m", "rule", "hint"),
        StudyError("f.toml", "k", "v", "rule", "hint"),
        SectionError("wheel.tire"),
        MeshError("text"),
        ConvergenceError("text", RECORDS, last_good=(1.0, 2.0)),
    ],
)
def test_errors_survive_pickling(error: WorkbenchError) -> None:
    copy = pickle.loads(pickle.dumps(error))
    assert type(copy) is type(error)
    assert str(copy) == str(error)
    assert vars(copy) == vars(error)


def _fail() -> None:
    raise InputError("worker value", "1 m", "rule", "hint")


def test_an_error_in_a_worker_process_reaches_the_caller() -> None:
    with (
        ProcessPoolExecutor(max_workers=1, mp_context=get_context("spawn")) as pool,
        pytest.raises(InputError, match="worker value = 1 m: rule; hint"),
    ):
        pool.submit(_fail).result()
