"""A broken connection is an exception and no end, with PETSc loaded too: Dask workers had died of theirs."""

from __future__ import annotations

import subprocess
import sys

import pytest

from reference_fe.solver.signals import leave_signals_alone

BROKEN = """
import os
{loaded}
read, write = os.pipe()
os.close(read)
try:
    os.write(write, b"x")
except BrokenPipeError:
    print("told")
"""
OURS = "import reference_fe.dolfinx_api"
PLAIN = "import dolfinx_solver, dolfinx; from petsc4py import PETSc"


def _told(loaded: str) -> bool:
    run = subprocess.run(
        [sys.executable, "-c", BROKEN.format(loaded=loaded)], capture_output=True, text=True, check=False
    )
    return run.stdout == "told\n" and run.returncode == 0


def test_a_broken_pipe_is_an_exception() -> None:
    assert _told(OURS)


def test_negative_control_petsc_by_itself_ends_the_process(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("dolfinx_solver")
    monkeypatch.delenv("PETSC_OPTIONS", raising=False)
    assert not _told(PLAIN)


def test_options_of_the_user_s_stay() -> None:
    asked = {"PETSC_OPTIONS": "-log_view"}
    leave_signals_alone(asked)
    leave_signals_alone(asked)
    assert asked["PETSC_OPTIONS"] == "-log_view -no_signal_handler"
