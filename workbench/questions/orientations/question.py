"""Question: load over orientation, and what the wheel's own symmetry says about the curves.

Verified by tests/unit/test_workbench_full_study.py and tests/end_to_end/test_full_report.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from contracts.records import Check
from workbench.questions.model_curves import model_curves
from workbench.questions.orientations.figures import orientation_figures
from workbench.questions.orientations.results import OrientationMap
from workbench.questions.question import Question
from workbench.study.full import around, is_mirrored, rotational_period
from workbench.study.model import Study
from workbench.verdict.rules import Claim, at_most

__all__ = ["ORIENTATIONS"]


_FEWEST = 3
_MIRROR_LIMIT = 0.005


def _read(study: Study, folders: Mapping[str, Path]) -> OrientationMap:
    fe = model_curves("fe", folders, around(study))
    return OrientationMap(
        curves=fe.loaded, missing=tuple(fe.missing), period=rotational_period(study), mirrored=is_mirrored(study)
    )


def _checks(study: Study, results: OrientationMap) -> Sequence[Check]:
    if not results.mirror_pairs:
        return ()
    claim = Claim(
        id="fe.mirror_symmetry",
        title=f"FE: largest difference of load between {len(results.mirror_pairs)} pairs of mirrored orientations",
        quantity="difference",
        unit="-",
        role="finding",
        source="the wheel is its own mirror image: what differs is mesh and solver; the limit is ours",
    )
    return [at_most(claim, results.mirror_error, _MIRROR_LIMIT)]


ORIENTATIONS = Question(
    name="orientations",
    title="Load over orientation",
    group="Wheel",
    read=_read,
    checks=_checks,
    figures=orientation_figures,
    applies=lambda study: len(study.fe.orientations) >= _FEWEST,
    budget=650,
)
