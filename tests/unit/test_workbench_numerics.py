"""The table of increments says of each run what its result holds, of a partial and of a missing curve too."""

from __future__ import annotations

from typing import cast

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import IncrementRecord
from workbench.questions.model_curves import ModelCurves, RunNumbers
from workbench.questions.numerics.question import Numerics
from workbench.questions.wheel.question import WheelMeshes

D = np.linspace(0.0, 0.02, 5)
INCREMENTS = (
    IncrementRecord(target=0.01, step=0.01, converged=True, residuals=(1.0, 1e-4, 3e-9)),
    IncrementRecord(target=0.02, step=0.01, converged=False, residuals=(1.0, 2.0)),
    IncrementRecord(target=0.015, step=0.005, converged=True, residuals=(0.5, 1e-9)),
)


def _numerics(points: int, increments: tuple[IncrementRecord, ...]) -> Numerics:
    imbalance = {"force_imbalance": np.linspace(0.0, -2e-9, points), "moment_imbalance": np.full(points, 1e-10)}
    curve = StiffnessCurve(
        model="fe",
        orientation_deg=15.0,
        deflection=D[:points],
        load=8e3 * D[:points],
        columns=imbalance,
        partial=points < len(D),
    )
    run = RunNumbers(dofs=12, solve_s=0.5, increments=increments)
    return Numerics(
        fe=ModelCurves(model="fe", by_orientation={15.0: curve}, average=curve, runs={15.0: run}),
        others=(),
        meshes=cast(WheelMeshes, None),  # no row needs them
        early_ends={},
    )


def test_a_row_counts_what_converged_and_what_was_cut_back() -> None:
    (row,) = _numerics(5, INCREMENTS).rows
    assert (row.orientation, len(row.run.converged), row.cuts, row.run.iterations) == (15.0, 2, 1, 4)
    assert (row.curve.partial, row.curve.unloaded, row.residual) == (False, False, 3e-9)
    assert (row.largest("force_imbalance"), row.largest("moment_imbalance")) == (2e-9, 1e-10)


def test_a_run_without_a_converged_increment_has_no_residual() -> None:
    (row,) = _numerics(1, INCREMENTS[1:2]).rows
    assert (len(row.run.converged), row.cuts, row.residual) == (0, 1, None)
