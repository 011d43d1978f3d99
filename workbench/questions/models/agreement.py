"""Who agrees with the continuum, by how much, and how surely. Verified by tests/unit/test_workbench_agreement.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.questions.mesh_study.results import MeshStudy
from workbench.questions.model_curves import ModelCurves
from workbench.questions.models.metrics import CurveMetrics

__all__ = ["Agreement", "Verdict", "agreements", "noted", "verdict"]

Verdict = Literal["no difference", "agrees", "differs", "undecided", "not known"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """One pair of curves.

    Attributes
    ----------
    pair : key of the pair in the metrics
    distance : relative L2 difference over the range compared [-]
    uncertainty : how much of it the mesh of the continuum model may account for [-]; None if not known
    limit : the largest distance that counts as agreement [-]
    verdict : "no difference": smaller than its uncertainty; "agrees", "differs": inside or outside the limit, whatever
        the mesh adds; "undecided": the uncertainty reaches across the limit; "not known": no uncertainty
    """

    pair: str
    distance: float
    uncertainty: float | None
    limit: float
    verdict: Verdict


def verdict(distance: float, uncertainty: float | None, limit: float) -> Verdict:
    """Judge a distance known to +-uncertainty against a limit, all relative [-]."""
    if uncertainty is None:
        return "not known"
    if distance <= uncertainty:
        return "no difference"
    if distance + uncertainty <= limit:
        return "agrees"
    return "differs" if distance - uncertainty > limit else "undecided"


def agreements(
    metrics: Mapping[str, CurveMetrics], fe: ModelCurves, study: MeshStudy | None, limit: float
) -> dict[str, Agreement]:
    """Judge every pair of the metrics; each has a continuum curve in it."""
    return {pair: _judge(pair, numbers, _continuum_curve(pair, fe), study, limit) for pair, numbers in metrics.items()}


def _continuum_curve(pair: str, fe: ModelCurves) -> StiffnessCurve:
    return fe.by_orientation[float(pair.removeprefix("ancf_phi"))] if pair.startswith("ancf_phi") else fe.average


def _judge(pair: str, numbers: CurveMetrics, curve: StiffnessCurve, study: MeshStudy | None, limit: float) -> Agreement:
    distance = numbers.relative_l2
    try:
        uncertainty = None if study is None else study.l2_uncertainty(curve, numbers.start, numbers.end)
    except InputError:
        uncertainty = None
    return Agreement(
        pair=pair,
        distance=distance,
        uncertainty=uncertainty,
        limit=limit,
        verdict=verdict(distance, uncertainty, limit),
    )


def noted(checks: Sequence[Check], judged: Mapping[str, Agreement]) -> list[Check]:
    """The checks of L2 differences with their numerical uncertainty and verdict in the words of the tolerance.

    One whose uncertainty reaches across its limit is undecided.
    """
    pairs = {"ancf_vs_fe.relative_l2": "ancf_average", "brush_vs_fe.relative_l2": "brush"}
    pairs |= {f"{pair}.relative_l2": pair for pair in judged if pair.startswith("user_")}
    return [_note(check, judged[pairs[check.id]]) if pairs.get(check.id) in judged else check for check in checks]


def _note(check: Check, found: Agreement) -> Check:
    if found.uncertainty is None:
        return replace(check, tolerance=f"{check.tolerance}; numerical uncertainty not known")
    words = f"numerical uncertainty ±{100.0 * found.uncertainty:.2g} %: {found.verdict}"
    status = "undecided" if found.verdict == "undecided" else check.status
    return replace(check, tolerance=f"{check.tolerance}; {words}", status=status)
