"""How far one curve lies from another, as numbers. Verified by tests/unit/test_workbench_metrics.py."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError

__all__ = ["CurveMetrics", "compare_curves", "largest_spread"]

_SAMPLES = 401
_LARGEST_LOAD = 1e12


@dataclass(frozen=True, slots=True, kw_only=True)
class CurveMetrics:
    """Distance of a curve from a reference curve over their common deflections.

    Attributes
    ----------
    start, end : range compared [m]
    relative_l2 : ||F - F_ref|| / ||F_ref||, both at equal deflection on a uniform grid [-]
    max_error : largest |F - F_ref| [N]
    max_error_at : where it lies [m]
    tangent, tangent_reference : mean slope over the range, least squares with free intercept [N/m]
    reference_load : largest load of the reference over the range [N]

    Verified by tests/unit/test_workbench_metrics.py.
    """

    start: float
    end: float
    relative_l2: float
    max_error: float
    max_error_at: float
    tangent: float
    tangent_reference: float
    reference_load: float

    def as_dict(self) -> dict[str, float]:
        """The numbers by name, for JSON."""
        return asdict(self)


def compare_curves(curve: StiffnessCurve, reference: StiffnessCurve, max_load: float | None = None) -> CurveMetrics:
    """Compare two curves at equal deflection over the range they share.

    Parameters
    ----------
    curve, reference : the curve under test and the one it is held against
    max_load : if given, the range ends where ``reference`` reaches this load [N], unless it begins there or above (or
        where either curve ends)

    Raises
    ------
    InputError
        If they share no range, the reference is zero over it, or a load is beyond 1e12 N.

    Verified by tests/unit/test_workbench_metrics.py.
    """
    start = max(curve.deflection[0], reference.deflection[0])
    end = min(curve.deflection[-1], reference.deflection[-1])
    if max_load is not None and reference.load[0] < max_load <= reference.load.max():
        end = min(end, reference.deflection_at(max_load))
    if not end > start:
        rule = "share no range of deflection"
        raise InputError("curves", f"{curve.model}, {reference.model}", rule, "check their units (metres, newtons)")
    d = np.linspace(start, end, _SAMPLES)
    f, f_ref = curve.load_at(d), reference.load_at(d)
    for name, loads in ((curve.model, f), (reference.model, f_ref)):
        if np.abs(loads).max() > _LARGEST_LOAD:
            rule = f"must not exceed {_LARGEST_LOAD:g} N"
            raise InputError(f"load of {name}", f"{np.abs(loads).max():g} N", rule, "check its unit (newtons)")
    norm = float(np.linalg.norm(f_ref))
    if norm == 0.0:
        raise InputError("reference curve", reference.model, "is zero over the common range", "check its columns")
    error = np.abs(f - f_ref)
    worst = int(error.argmax())
    return CurveMetrics(
        start=float(start),
        end=float(end),
        relative_l2=float(np.linalg.norm(f - f_ref)) / norm,
        max_error=float(error[worst]),
        max_error_at=float(d[worst]),
        tangent=float(np.polyfit(d, f, 1)[0]),
        tangent_reference=float(np.polyfit(d, f_ref, 1)[0]),
        reference_load=float(f_ref.max()),
    )


def largest_spread(curves: list[StiffnessCurve], deflection: float) -> float:
    """(largest - smallest) / mean load of several curves at one deflection [m]; dimensionless."""
    loads = np.array([float(c.load_at(deflection)) for c in curves])
    return float((loads.max() - loads.min()) / loads.mean())
