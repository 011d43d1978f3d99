"""Checks of the solver: residual and balance of every run. Verified by tests/unit/test_workbench_checks.py."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.questions.mesh_study.results import MeshRun
from workbench.questions.model_curves import ModelCurves, RunNumbers
from workbench.study.sections import ToleranceSection
from workbench.verdict.rules import Claim, at_most

__all__ = ["largest_residual", "solver_checks"]

_EQUILIBRIUM = "equilibrium of the discrete weak form, Bonet & Wood 2008, ch. 8; the limit is the solver's own"
_SUMS = "Euler's laws of motion at rest; the limit is ours"


def solver_checks(fe: ModelCurves, others: Sequence[MeshRun], tol: ToleranceSection) -> list[Check]:
    """Residual and balance of every run, those of the mesh study included."""
    curves = [*fe.by_orientation.values(), *(run.curve for run in others)]
    numbers = [*fe.runs.values(), *(run.numbers for run in others)]
    moments = "FE: largest imbalance of moments about the hub's centre over contact force times radius"
    residual = "FE: largest residual of any converged increment, relative to the nodal support and contact forces"
    return [
        at_most(
            _gate("fe.residual", residual, "residual", _EQUILIBRIUM),
            lambda: largest_residual(numbers),
            tol.fe_residual,
        ),
        at_most(
            _gate("fe.balance", "FE: largest imbalance of forces over contact force", "imbalance", _SUMS),
            partial(_largest, curves, "force_imbalance"),
            tol.fe_balance,
        ),
        at_most(
            _gate("fe.moment_balance", moments, "imbalance", _SUMS),
            partial(_largest, curves, "moment_imbalance"),
            tol.fe_balance,
        ),
    ]


def _largest(curves: Sequence[StiffnessCurve], column: str) -> float:
    """Largest absolute value of a column on any curve that carries load; NaN without any."""
    return max((float(np.abs(c.columns[column]).max()) for c in curves if not c.unloaded), default=math.nan)


def largest_residual(runs: Sequence[RunNumbers]) -> float:
    """Largest relative residual at the end of any converged increment of any run [-]."""
    found = [one.residuals[-1] for run in runs for one in run.converged]
    if not found:
        raise InputError("increments", 0, "converged", "see the runs' messages")
    return max(found)


def _gate(id: str, title: str, quantity: str, source: str) -> Claim:
    return Claim(id=id, title=title, quantity=quantity, unit="-", role="gate", source=source)
