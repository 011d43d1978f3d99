"""Question: did every run of the finite elements come to its end in equilibrium, and on what mesh?

Verified by tests/unit/test_workbench_checks.py and tests/end_to_end/test_partial_curve.py.
"""

from __future__ import annotations

from collections.abc import Sequence

from contracts.records import Check
from workbench.questions.numerics.checks import solver_checks
from workbench.questions.numerics.completeness import completeness_check
from workbench.questions.numerics.energy import energy_check
from workbench.questions.numerics.results import Numerics, read_numerics
from workbench.questions.question import Question
from workbench.study.model import Study

__all__ = ["NUMERICS"]


def _checks(study: Study, results: Numerics) -> Sequence[Check]:
    tolerances, curves = study.tolerances, list(results.fe.by_orientation.values())
    return [
        completeness_check(results.early_ends),
        *solver_checks(results.fe, results.others, tolerances),
        energy_check(curves, tolerances.fe_energy),
    ]


NUMERICS = Question(name="numerics", title="Mesh and solver", group="Solvers", read=read_numerics, checks=_checks)
