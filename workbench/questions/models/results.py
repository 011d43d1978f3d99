"""Every model of the study at one orientation or on average, row by row.

Verified by tests/unit/test_workbench_checks.py, tests/unit/test_workbench_agreement.py and
tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from contracts.curves import StiffnessCurve
from workbench.questions.fe.results import ContinuumCurves
from workbench.questions.model_curves import ModelCurves
from workbench.questions.models.agreement import Agreement, agreements
from workbench.questions.models.metrics import CurveMetrics
from workbench.questions.models.thesis_order import SEEN, Secant, leaves, over_the_sweep, secants

__all__ = ["ComparedModels", "ComparedRow"]


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparedRow:
    """A line of the table: readable name of the pair, distances, what is made of them."""

    name: str
    metrics: CurveMetrics
    agreement: Agreement


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparedModels:
    """Everything that is held against the continuum.

    Attributes
    ----------
    continuum : its curves and their uncertainty
    ancf, brush : curves of the study's tires, None where it has none
    metrics : distances between curves by pair
    limit : relative L2 difference up to which two models agree [-]
    """

    continuum: ContinuumCurves
    ancf: ModelCurves | None
    brush: StiffnessCurve | None
    metrics: Mapping[str, CurveMetrics]
    limit: float

    @property
    def agreements(self) -> Mapping[str, Agreement]:
        """Each pair judged against the limit, with what is not known of mesh and reference."""
        found = self.continuum
        return agreements(self.metrics, found.fe, found.mesh_study, self.limit, found.users)

    @property
    def secants(self) -> list[Secant]:
        """The average by arc beside both tires, see `workbench.questions.models.thesis_order`."""
        return secants(self.continuum.fe.average, self.brush, None if self.ancf is None else self.ancf.average)

    @property
    def seen(self) -> float:
        """Relative difference that two curves of one figure may have unseen [-]."""
        return SEEN

    @property
    def brush_leaves(self) -> tuple[float, float] | None:
        """Deflection [m] and load [N] at which the brush line leaves the average; None: nowhere, or there is none."""
        return None if self.brush is None else leaves(self.continuum.fe.average, self.brush)

    @property
    def in_the_sweep(self) -> dict[str, tuple[float, float] | None]:
        """Tire -> smallest and largest relative difference over the thesis' sweep [-]; None where a curve ends."""
        tires = {"brush": self.brush, "ancf": None if self.ancf is None else self.ancf.average}
        return {n: over_the_sweep(self.continuum.fe.average, t) for n, t in tires.items() if t is not None}

    @property
    def rows(self) -> list[ComparedRow]:
        """The table."""
        judged = self.agreements
        return [ComparedRow(name=self._name(k), metrics=m, agreement=judged[k]) for k, m in self.metrics.items()]

    def _name(self, pair: str) -> str:
        fe, users = self.continuum.fe, self.continuum.users
        names = {"ancf_average": "ANCF average, FE average", "brush": "brush line, FE average"}
        names |= {f"user_{i}": f"FE, {user.label} ({user.kind})" for i, user in enumerate(users)}
        orientation = pair.removeprefix("ancf_phi")
        curve = fe.average if pair in names else fe.by_orientation[float(orientation)]
        name = names.get(pair) or f"ANCF {orientation}°, FE {orientation}°"
        return name + (" (partial)" if curve.partial else "")
