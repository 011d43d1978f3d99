"""Two curves held against each other with uncertainty and tolerance: the numbers of ``workbench compare``.

Verified by tests/unit/test_workbench_curve_pair.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.models.metrics import CurveMetrics, compare_curves
from workbench.questions.two_curves.shape import tangent_stiffness, work_between
from workbench.study.curve_file import MeasuredCurve

__all__ = ["CurvePair", "Energies", "Judgement", "Outcome", "Samples", "TangentDifference", "compared", "judged"]

type Outcome = Literal["passed", "failed", "undecided", "not judged"]
_SAMPLES = 401
_LARGEST_LOAD = 1e12
_REACH = 0.1
"""Smallest reach of the tangents' regression over the range compared [-]."""
_ROUND_OFF = 1e-9
_LEAST_COMMON = 0.5
"""Share of the reference's range that has to be common before a verdict is given [-]: none from a sliver of it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Samples:
    """Both curves on one uniform grid of the range they share; each (401,) float.

    Attributes
    ----------
    deflection : [m]
    load, reference : [N]
    uncertainty : half width of the interval of ``load - reference`` [N]; None if neither file states one
    tangent, reference_tangent : [N/m]
    """

    deflection: NDArray[np.float64]
    load: NDArray[np.float64]
    reference: NDArray[np.float64]
    uncertainty: NDArray[np.float64] | None
    tangent: NDArray[np.float64]
    reference_tangent: NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class TangentDifference:
    """Largest difference of the tangents [N/m], its place [m], its share of the reference's tangent there [-] (None
    where that is zero), and the relative L2 norm of the difference [-] (None if the reference is flat)."""

    largest: float
    at: float
    share: float | None
    relative_l2: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Energies:
    """Work under both curves [J] from load ``low`` to load ``high`` [N]."""

    low: float
    high: float
    work: float
    reference: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Judgement:
    """A relative L2 difference, its uncertainty and its tolerance [-], and what follows; `why` in words, and what is
    `missing` for a verdict."""

    difference: float
    uncertainty: float | None
    tolerance: float | None
    outcome: Outcome
    why: str
    missing: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class CurvePair:
    """Everything found about a curve and its reference.

    ``energies`` is None if they share no range of load; ``iso_rating`` if nobody asked, NaN if it is not defined.
    """

    curve: MeasuredCurve
    reference: MeasuredCurve
    metrics: CurveMetrics
    samples: Samples
    tangents: TangentDifference
    energies: Energies | None
    judgement: Judgement
    iso_rating: float | None = None


def compared(
    curve: MeasuredCurve, reference: MeasuredCurve, max_load: float | None = None, tolerance: float | None = None
) -> CurvePair:
    """Compare two curves of one kind of deformation over the deflections they share, and judge the difference.

    Uncertainties of both loads are taken as independent: U = sqrt(U_curve^2 + U_reference^2) at each deflection (ASME
    V&V 20-2009, eq. 1-5-9). A difference that moves by U(d) everywhere moves its relative L2 norm by at most
    norm(U) / norm(F_ref). Where less than half of the reference's range, up to ``max_load``, is common, the verdict is
    undecided.

    Parameters
    ----------
    curve, reference : the curve under test and the one it is held against
    max_load : the range ends where the reference reaches this load [N]; None for all they share
    tolerance : largest relative L2 difference allowed [-]; None for no judgement

    Raises
    ------
    InputError
        If one is a radial deflection and the other a change of diameter, or as `compare_curves`.
    """
    if curve.kind != reference.kind:
        value = f"{curve.curve.model}: {curve.kind}; {reference.curve.model}: {reference.kind}"
        rule = "differ: between two plates the hub carries nothing, on the ground all; neither follows from the other"
        raise InputError("deformations", value, rule, "compare two curves of one kind")
    for one in (curve.curve, reference.curve):
        if np.abs(one.load).max() > _LARGEST_LOAD:
            rule = f"must not exceed {_LARGEST_LOAD:g} N"
            raise InputError(f"load of {one.model}", f"{np.abs(one.load).max():g} N", rule, "check its unit")
    metrics = compare_curves(curve.curve, reference.curve, max_load)
    samples = _samples(curve, reference, metrics)
    spread = None
    if samples.uncertainty is not None:
        spread = float(np.linalg.norm(samples.uncertainty) / np.linalg.norm(samples.reference))
    return CurvePair(
        curve=curve,
        reference=reference,
        metrics=metrics,
        samples=samples,
        tangents=_tangent_difference(samples),
        energies=_energies(curve.curve, reference.curve, max_load),
        judgement=judged(metrics.relative_l2, spread, tolerance, _missing(curve.curve, reference.curve, max_load)),
    )


def judged(difference: float, uncertainty: float | None, tolerance: float | None, missing: str = "") -> Judgement:
    """Judge a difference known to +-``uncertainty`` against a tolerance, all relative [-].

    Passed if the whole interval lies within the tolerance, failed if all of it lies beyond, else undecided. An
    uncertainty that nobody stated counts as zero. ``missing`` says what of the range was not compared, where that is
    too much for a verdict: it is undecided then.
    """
    width = uncertainty or 0.0
    known = "no uncertainty stated" if uncertainty is None else f"known to ±{100.0 * width:.3g} %"
    outcome: Outcome
    if tolerance is None:
        outcome, why = "not judged", f"{known}; no tolerance given{missing and f'; {missing}'}"
    elif missing:
        outcome, why = "undecided", f"of the common range alone: {missing}"
    elif difference + width <= tolerance:
        outcome, why = "passed", f"{known}; within {100.0 * tolerance:.3g} % whatever it is"
    elif difference - width > tolerance:
        outcome, why = "failed", f"{known}; beyond {100.0 * tolerance:.3g} % whatever it is"
    elif width >= tolerance:
        outcome, why = "undecided", f"{known}, which is more than the tolerance of {100.0 * tolerance:.3g} %"
    else:
        outcome, why = "undecided", f"{known}, which reaches across the tolerance of {100.0 * tolerance:.3g} %"
    return Judgement(
        difference=difference, uncertainty=uncertainty, tolerance=tolerance, outcome=outcome, why=why, missing=missing
    )


def _missing(curve: StiffnessCurve, reference: StiffnessCurve, max_load: float | None) -> str:
    """Why what was compared is too little of the reference, up to ``max_load`` [N], for a verdict; empty if enough."""
    first, last = reference.deflection[0], reference.deflection[-1]
    if max_load is not None and max_load < reference.load.max():
        last = reference.deflection_at(max_load)
    start, end = max(curve.deflection[0], first), min(curve.deflection[-1], last)
    if end - start >= (_LEAST_COMMON - _ROUND_OFF) * (last - first):
        return ""
    common = f"{1e3 * start:.4g} to {1e3 * end:.4g} mm of {1e3 * first:.4g} to {1e3 * last:.4g} mm"
    least = f"less than {100.0 * _LEAST_COMMON:g} %"
    return f"{curve.model} covers only {common} of {reference.model}, {least}; --max-load judges the range up to a load"


def _samples(curve: MeasuredCurve, reference: MeasuredCurve, metrics: CurveMetrics) -> Samples:
    d = np.linspace(metrics.start, metrics.end, _SAMPLES)
    reach = _REACH * (metrics.end - metrics.start)
    stated = [
        np.interp(d, one.curve.deflection, one.uncertainty) for one in (curve, reference) if one.uncertainty is not None
    ]
    return Samples(
        deflection=d,
        load=curve.curve.load_at(d),
        reference=reference.curve.load_at(d),
        uncertainty=np.asarray(np.sqrt(sum(u**2 for u in stated))) if stated else None,
        tangent=tangent_stiffness(curve.curve, d, reach),
        reference_tangent=tangent_stiffness(reference.curve, d, reach),
    )


def _tangent_difference(samples: Samples) -> TangentDifference:
    difference = np.abs(samples.tangent - samples.reference_tangent)
    worst = int(difference.argmax())
    there, norm = abs(float(samples.reference_tangent[worst])), float(np.linalg.norm(samples.reference_tangent))
    return TangentDifference(
        largest=float(difference[worst]),
        at=float(samples.deflection[worst]),
        share=float(difference[worst]) / there if there > 0.0 else None,
        relative_l2=float(np.linalg.norm(difference)) / norm if norm > 0.0 else None,
    )


def _energies(curve: StiffnessCurve, reference: StiffnessCurve, max_load: float | None) -> Energies | None:
    """Work up to ``max_load``, or to the largest load both reach; from zero load, or the larger of the first loads."""
    low = max(0.0, float(curve.load[0]), float(reference.load[0]))
    high = min(float(curve.load.max()), float(reference.load.max()))
    high = high if max_load is None else min(high, max_load)
    if not high > low:
        return None
    return Energies(
        low=low, high=high, work=work_between(curve, low, high), reference=work_between(reference, low, high)
    )
