"""Which gates a study has made easier than the project's own: said in the verdict wherever it stands.

Verified by tests/unit/test_workbench_magnitudes.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from workbench.study.model import Study
from workbench.study.sections import ToleranceSection

__all__ = ["GATES", "loosened"]

_OF_THE_REFERENCE = {
    **{"initial_tangent": 1.0, "initial_tangent_up_to": 1.0, "reach_deflection": -1.0, "reach_load": -1.0}
}
"""Tolerances whose checks are gates for the wheel of the reference only."""
GATES = _OF_THE_REFERENCE | {
    **{"ancf_preset": 1.0, "flexible_mass": 1.0, "mesh_mass": 1.0, "min_scaled_jacobian": -1.0},
    **{"fe_residual": 1.0, "fe_balance": 1.0, "fe_energy": 1.0, "mesh_uncertainty": 1.0, "surface_distance": 1.0},
}
"""Tolerances of gates -> 1 where a larger number is easier to meet, -1 where a smaller one is."""


def loosened(study: Study) -> tuple[str, ...]:
    """Each tolerance of a gate that is easier to meet than by default, in words."""
    given, own = study.tolerances, ToleranceSection()
    found = []
    for key, sign in GATES.items():
        value, usual = getattr(given, key), getattr(own, key)
        if sign * (value - usual) > 1e-9 * usual and (given.reference_wheel or key not in _OF_THE_REFERENCE):
            found.append(f"tolerances.{key} = {value:g} is looser than its gate's own {usual:g}")
    return tuple(found)
