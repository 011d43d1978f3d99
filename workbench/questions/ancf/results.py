"""The ANCF tire's curves and surfaces, as the report reads them.

Verified by tests/unit/test_workbench_checks.py, tests/unit/test_workbench_ancf_surfaces.py,
tests/unit/test_workbench_graph.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from contracts.curves import StiffnessCurve
from workbench.questions.model_curves import ModelCurves

__all__ = ["AncfTireResults"]


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfTireResults:
    """The tire's curves, the continuum's average, and how far each STEP file read back lies from the plates [m]."""

    ancf: ModelCurves
    fe_average: StiffnessCurve
    read_back: Mapping[str, float]

    @property
    def surface_distance(self) -> float:
        """The largest of them [m]."""
        return max(self.read_back.values())
