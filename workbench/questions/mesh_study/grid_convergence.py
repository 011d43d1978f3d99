"""Grid convergence index: the numerical uncertainty of a number from three meshes.

Source: I. B. Celik et al., Procedure for Estimation and Reporting of Uncertainty Due to Discretization in CFD
Applications, *J. Fluids Eng.* 130 (2008) 078001, the procedure of ASME V&V 20-2009, section 2-4. Verified by
tests/unit/test_workbench_grid_convergence.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from contracts.errors import InputError

__all__ = ["Behaviour", "GridConvergence", "apparent_order", "grid_convergence"]

Behaviour = Literal["monotonic", "oscillatory", "divergent"]
"""How the number moves from mesh to mesh; "divergent": the second step is no smaller than the first."""

_SAFETY_THREE_MESHES = 1.25
_SAFETY_NO_ORDER = 3.0
_ASSUMED_ORDER = 2.0
_LARGEST_ORDER = 40.0


@dataclass(frozen=True, slots=True, kw_only=True)
class GridConvergence:
    """What three meshes say about one number.

    Attributes
    ----------
    values : the number on the fine, medium and coarse mesh
    ratios : r21, r32: element size of the coarser over that of the finer mesh [-]
    behaviour : whether the number converges, and how
    apparent_order : p of the paper [-]; None if the number does not converge
    order : the order used [-]: p where it is credible, 2 where it is not; None likewise
    safety : factor of safety [-]: 1.25 with p, 3 without
    extrapolated : value for vanishing element size, with ``order``; None likewise
    approximate_error : |fine - medium| / |fine| [-]
    extrapolated_error : |extrapolated - fine| / |extrapolated| [-]; None likewise
    index_fine, index_medium : grid convergence index of the fine and of the medium mesh [-]: ``safety`` times the
        estimated relative error; without an order 3 times the range of the three values
    index_coarse : the same for the coarse mesh, from its distance to ``extrapolated`` [-]; where the number oscillates,
        both of medium and coarse are at least half the range of the three values, because the formulas take the error
        to have one sign
    """

    values: tuple[float, float, float]
    ratios: tuple[float, float]
    behaviour: Behaviour
    apparent_order: float | None
    order: float | None
    safety: float
    extrapolated: float | None
    approximate_error: float
    extrapolated_error: float | None
    index_fine: float
    index_medium: float
    index_coarse: float


def grid_convergence(
    values: Sequence[float], sizes: Sequence[float], credible: tuple[float, float] | None = None
) -> GridConvergence:
    """Apparent order, extrapolated value and grid convergence index.

    Parameters
    ----------
    values : the number on the fine, medium and coarse mesh, none of them zero
    sizes : representative element sizes h1 < h2 < h3 of these meshes, any unit
    credible : smallest and largest apparent order that is believed, of a number that converges from one side [-]: else
        the error is estimated with order 2 and factor 3, Roache's for two meshes. None: every order is believed

    Raises
    ------
    InputError
        If there are not three of each, the sizes do not increase, or a value is zero.

    Notes
    -----
    With e32 = phi3 - phi2, e21 = phi2 - phi1 and s = sign(e32 / e21), p solves

        p ln r21 = | ln |e32 / e21| + ln((r21^p - s) / (r32^p - s)) |,

    the extrapolated value is (r21^p phi1 - phi2) / (r21^p - 1) and GCI21 = 1.25 |(phi1 - phi2) / phi1| / (r21^p - 1).
    """
    fine, medium, coarse, r21, r32 = _checked(values, sizes)
    e21, e32 = medium - fine, coarse - medium
    behaviour, p = apparent_order(e21, e32, r21, r32)
    approximate = abs(e21 / fine)
    if p is None:
        spread = _SAFETY_NO_ORDER * (max(values) - min(values))
        order, limit, safety = None, None, _SAFETY_NO_ORDER
        indices = [spread / abs(value) for value in (fine, medium, coarse)]
    else:
        believed = credible is None or (behaviour == "monotonic" and credible[0] <= p <= credible[1])
        order, safety = (p, _SAFETY_THREE_MESHES) if believed else (_ASSUMED_ORDER, _SAFETY_NO_ORDER)
        limit = fine - e21 / (r21**order - 1.0)
        errors = e21 / (r21**order - 1.0), e32 / (r32**order - 1.0), coarse - limit
        indices = [safety * abs(e / v) for e, v in zip(errors, (fine, medium, coarse), strict=True)]
        if behaviour == "oscillatory":
            half_range = 0.5 * (max(values) - min(values))
            indices[1:] = [max(i, half_range / abs(v)) for i, v in zip(indices[1:], (medium, coarse), strict=True)]
    return GridConvergence(
        values=(fine, medium, coarse),
        ratios=(r21, r32),
        behaviour=behaviour,
        apparent_order=p,
        order=order,
        safety=safety,
        extrapolated=limit,
        approximate_error=approximate,
        extrapolated_error=None if limit is None else abs((limit - fine) / limit),
        index_fine=indices[0],
        index_medium=indices[1],
        index_coarse=indices[2],
    )


def apparent_order(e21: float, e32: float, r21: float, r32: float) -> tuple[Behaviour, float | None]:
    """How the differences shrink, and the order p at which they do; None if they do not.

    The paper iterates its equation for p to a fixed point. That diverges where r32 is much larger than r21, so its root
    is bracketed: |e32 / e21| = r21^p (r32^p - s) / (r21^p - s) has a right side that grows with p.
    """
    s = -1.0 if e21 * e32 < 0.0 else 1.0
    shrink = abs(e32 / e21) if e21 else math.inf
    lowest = 1.0 if s < 0.0 else math.log(r32) / math.log(r21)
    if e32 == 0.0 or not shrink > lowest:
        return "divergent", None

    def excess(p: float) -> float:
        return float(r21**p * (r32**p - s) / (r21**p - s)) - shrink

    low, high = 1e-9, _LARGEST_ORDER
    if excess(high) < 0.0:
        return _behaviour(s), high
    while high - low > 1e-12 * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(middle) < 0.0 else (low, middle)
    return _behaviour(s), 0.5 * (low + high)


def _behaviour(s: float) -> Behaviour:
    return "monotonic" if s > 0.0 else "oscillatory"


def _checked(values: Sequence[float], sizes: Sequence[float]) -> tuple[float, float, float, float, float]:
    """Fine, medium and coarse value, r21, r32."""
    if len(values) != 3 or len(sizes) != 3:
        raise InputError("meshes", f"{len(values)} values, {len(sizes)} sizes", "must be three", "solve three meshes")
    if not 0.0 < sizes[0] < sizes[1] < sizes[2]:
        shown = ", ".join(f"{size:.4g}" for size in sizes)
        raise InputError("element sizes", shown, "must increase from fine to coarse", "refine further apart")
    if not all(math.isfinite(value) and value for value in values):
        rule = "must be finite and not zero: the index is relative to it"
        raise InputError("value", ", ".join(f"{v:g}" for v in values), rule, "compare another number")
    return *values, sizes[1] / sizes[0], sizes[2] / sizes[1]  # type: ignore[return-value]
