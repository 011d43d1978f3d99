"""Who agrees with the continuum, by how much, and how surely. Verified by tests/unit/test_workbench_agreement.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.questions.mesh_study.results import MeshStudy
from workbench.questions.model_curves import ModelCurves, UserCurve
from workbench.questions.models.metrics import CurveMetrics
from workbench.study.model import LARGEST_WHEEL_LOAD

__all__ = ["Agreement", "Verdict", "agreements", "noted", "verdict"]

_SAMPLES = 401
LEAST_COMMON = 0.5
"""Share of a reference's range that has to be covered before it judges [-]: none from a sliver of it."""
Verdict = Literal["no difference", "agrees", "differs", "undecided", "not known"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """One pair of curves.

    Attributes
    ----------
    pair : key of the pair in the metrics
    distance : relative L2 difference over the range compared [-]
    uncertainty : how much of it the mesh of the continuum model may account for, with a curve of the study's reference
        also that curve's own, root-sum-square [-]; None if the mesh's is not known
    limit : the largest distance that counts as agreement [-]
    own : uncertainty of the study's reference alone [-]; None where the pair has no curve of it
    sliver : whether less than half of the reference's curve, up to the loads compared, was covered: too little to judge
    verdict : "no difference": smaller than its uncertainty; "agrees", "differs": inside or outside the limit, whatever
        the mesh adds; "undecided": the uncertainty reaches across the limit; "not known": no uncertainty
    """

    pair: str
    distance: float
    uncertainty: float | None
    limit: float
    verdict: Verdict
    own: float | None = None
    sliver: bool = False


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
    metrics: Mapping[str, CurveMetrics],
    fe: ModelCurves,
    study: MeshStudy | None,
    limit: float,
    users: Sequence[UserCurve] = (),
) -> dict[str, Agreement]:
    """Judge every pair of the metrics; each has a continuum curve in it, and ``user_0`` the first of ``users``."""
    judged = {}
    for pair, numbers in metrics.items():
        user = users[int(pair.removeprefix("user_"))] if pair.startswith("user_") else None
        curve = _continuum_curve(pair, fe, user)
        total, own = _uncertainty(numbers, curve, study, user)
        found = verdict(numbers.relative_l2, total, limit)
        judged[pair] = Agreement(
            pair=pair,
            distance=numbers.relative_l2,
            uncertainty=total,
            limit=limit,
            verdict=found,
            own=own,
            sliver=user is not None and _is_sliver(numbers, user.curve),
        )
    return judged


def _is_sliver(numbers: CurveMetrics, reference: StiffnessCurve) -> bool:
    """Whether the range compared is less than half of a reference's up to the loads compared."""
    first, last = reference.deflection[0], reference.deflection[-1]
    if reference.load.max() >= LARGEST_WHEEL_LOAD:
        last = reference.deflection_at(LARGEST_WHEEL_LOAD)
    return bool(numbers.end - numbers.start < LEAST_COMMON * (1.0 - 1e-9) * (last - first))


def _continuum_curve(pair: str, fe: ModelCurves, user: UserCurve | None) -> StiffnessCurve:
    orientation = float(pair.removeprefix("ancf_phi")) if pair.startswith("ancf_phi") else None
    orientation = orientation if user is None else user.orientation_deg
    return fe.average if orientation is None else fe.by_orientation[orientation]


def _uncertainty(
    numbers: CurveMetrics, curve: StiffnessCurve, study: MeshStudy | None, user: UserCurve | None
) -> tuple[float | None, float | None]:
    """Of a relative L2 difference: that of mesh and reference together, and of the reference alone [-].

    Loads known to +-U(d) move the norm of the difference by at most norm(U), of which each is sqrt(U_1^2 + U_2^2).
    """
    try:
        if user is None:
            return None if study is None else study.l2_uncertainty(curve, numbers.start, numbers.end), None
        d = np.linspace(numbers.start, numbers.end, _SAMPLES)
        norm = np.linalg.norm(user.curve.load_at(d))
        own = np.interp(d, user.curve.deflection, user.uncertainty)
    except InputError:
        return None, None
    alone = float(np.linalg.norm(own) / norm)
    try:
        mesh = None if study is None else study.relative_uncertainty(d) * curve.load_at(d)
    except InputError:
        mesh = None
    return None if mesh is None else float(np.linalg.norm(np.hypot(own, mesh)) / norm), alone


def noted(checks: Sequence[Check], judged: Mapping[str, Agreement]) -> list[Check]:
    """The checks of L2 differences with their uncertainty and verdict in the words of the tolerance.

    One whose uncertainty reaches across its limit is undecided.
    """
    pairs = {"ancf_vs_fe.relative_l2": "ancf_average", "brush_vs_fe.relative_l2": "brush"}
    pairs |= {f"{pair}.relative_l2": pair for pair in judged if pair.startswith("user_")}
    return [_note(check, judged[pairs[check.id]]) if pairs.get(check.id) in judged else check for check in checks]


def _note(check: Check, found: Agreement) -> Check:
    words = "numerical uncertainty not known"
    if found.uncertainty is not None:
        words = f"uncertainty ±{100.0 * found.uncertainty:.2g} %: {found.verdict}"
        words = f"numerical {words}" if found.own is None else f"{words} (of the reference ±{100.0 * found.own:.2g} %)"
    elif found.own is not None:
        words = f"uncertainty of the reference ±{100.0 * found.own:.2g} %, {words}"
    known = found.own if found.uncertainty is None else found.uncertainty
    across = known is not None and found.distance - known <= found.limit < found.distance + known
    words += "; less than half of the reference is covered" if found.sliver else ""
    status = "undecided" if across or found.sliver else check.status
    return replace(check, tolerance=f"{check.tolerance}; {words}", status=status)
