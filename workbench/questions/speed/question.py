"""Question: what a Newton iteration, an orientation, an ANCF plate and a rover's motion cost, and the aims.

Times beside other codes, on two processes, of the ANCF loops and of the rover come from kept benchmark runs
(`workbench.questions.speed.record`), those of the study's own curves from their stored results. Verified by
tests/unit/test_workbench_speed.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from contracts.records import Check
from workbench.questions.model_curves import ModelCurves, model_curves
from workbench.questions.question import Question
from workbench.questions.section.graph import without_planar_model
from workbench.questions.speed.aims import ARITHMETIC, CHRONO, TIRE, Aim, ancf_aims, flexible_aims, rover_aims
from workbench.questions.speed.record import BenchmarkRecord, BenchmarkRow, read_record
from workbench.questions.verification.question import VERIFICATION
from workbench.study.full import around
from workbench.study.model import Study
from workbench.verdict.rules import Claim, at_most

__all__ = ["SPEED", "CurveCost", "SpeedResults", "kept_runs"]

ITERATION, ITERATIONS = "time per Newton iteration", "Newton iterations to 20 mm"
WHOLE, MEMORY = "time to 20 mm", "peak memory"
EQUAL_ACCURACY = "half-cylinder-equal-accuracy against CalculiX"
SAME_ELEMENT = tuple(f"half-cylinder-{n} against CalculiX" for n in (40, 120, 220))
RANKS = "wall time of a Newton iteration"
CURVE_ITERATIONS, CURVE_POINTS, PLANAR_SECONDS = 80.0, 20, 5.0


@dataclass(frozen=True, slots=True, kw_only=True)
class CurveCost:
    """What one curve of this report took; ``solve_s`` is wall time [s] on whatever else the machine had to do."""

    model: str
    orientation: float
    dofs: int
    points: int
    increments: int
    iterations: int
    solve_s: float

    @property
    def iterations_for_20_points(self) -> float:
        """Newton iterations, scaled to a curve of 20 points."""
        return CURVE_POINTS * self.iterations / max(self.points, 1)


@dataclass(frozen=True, slots=True, kw_only=True)
class SpeedResults:
    """Kept benchmark runs, and the cost of this report's curves."""

    wheel: BenchmarkRecord
    ranks: BenchmarkRecord
    ancf: BenchmarkRecord
    rover: BenchmarkRecord
    flexible: BenchmarkRecord
    curves: tuple[CurveCost, ...]

    @property
    def pairs(self) -> list[dict[str, BenchmarkRow]]:
        """Every case beside every peer that solved it: metric -> row."""
        cases = self.wheel.cases(WHOLE)
        return [{m: self.wheel.row(c, m) for m in (ITERATION, ITERATIONS, WHOLE, MEMORY, "unknowns")} for c in cases]

    @property
    def aims(self) -> list[Aim]:
        """Aims of the kept runs, then those of this report's curves."""
        calculix = [case for case in self.wheel.cases(ITERATIONS) if case.endswith("CalculiX")]
        faster, fewer = "Faster an iteration than CalculiX", "Fewer iterations than CalculiX, worst case"
        aims = [
            Aim(title=f"{faster} at equal accuracy", found=self._least([EQUAL_ACCURACY], ITERATION), limit=3.0),
            Aim(title=f"{faster}, same element, worst mesh", found=self._least(SAME_ELEMENT, ITERATION), limit=3.0),
            Aim(title=fewer, found=self._least(calculix, ITERATIONS), limit=1.0, rule="more than"),
            Aim(title="Faster on two processes than on one", found=_ratio(self.ranks, RANKS), limit=1.6),
        ]
        return [*aims, *ancf_aims(self.ancf), *rover_aims(self.rover), *flexible_aims(self.flexible), *self.own_aims]

    @property
    def chrono(self) -> Mapping[str, float]:
        """Project Chrono's plate, for scale."""
        return CHRONO

    @property
    def over_arithmetic(self) -> Mapping[str, float]:
        """Force and tangent: time over that of their floating point operations alone [-]."""
        return {name: self.ancf.row(TIRE, metric).ours for name, metric in ARITHMETIC.items()}

    @property
    def dearest(self) -> float:
        """Most Newton iterations, scaled to 20 points, of any curve of the solid model; NaN without a curve."""
        return max((c.iterations_for_20_points for c in self.curves if c.model == "fe"), default=math.nan)

    @property
    def own_aims(self) -> list[Aim]:
        """Aims this report's own curves can answer."""
        solid = [c for c in self.curves if c.model == "fe"]
        planar = [c.solve_s for c in self.curves if c.model == "section"]
        aims = []
        if solid:
            title = "Newton iterations for 20 points of a curve, dearest orientation of this report"
            aims.append(Aim(title=title, found=self.dearest, limit=CURVE_ITERATIONS, unit="", rule="at most"))
        if planar:
            title = "An orientation of the planar model, slowest of this report"
            aims.append(Aim(title=title, found=max(planar), limit=PLANAR_SECONDS, unit="s", rule="at most"))
        return aims

    def _least(self, cases: Sequence[str], metric: str) -> float:
        ratios = [self.wheel.row(case, metric).ratio for case in cases]
        return min(ratio for ratio in ratios if ratio is not None)


def _ratio(record: BenchmarkRecord, metric: str) -> float:
    """Ratio of the only row with this metric."""
    (case,) = record.cases(metric)
    return record.row(case, metric).ratio or 0.0


def _costs(model: str, curves: ModelCurves) -> list[CurveCost]:
    return [
        CurveCost(
            model=model,
            orientation=orientation,
            dofs=run.dofs,
            points=int((curve.deflection > 0.0).sum()),
            increments=len(run.converged),
            iterations=run.iterations,
            solve_s=run.solve_s,
        )
        for orientation, curve in curves.loaded.items()
        for run in [curves.runs[orientation]]
    ]


def kept_runs() -> dict[str, BenchmarkRecord]:
    """The kept runs by their names in `SpeedResults`."""
    names = {
        "wheel": "fe_wheel",
        "ranks": "fe_ranks",
        "ancf": "ancf_tire",
        "rover": "rover_brush",
        "flexible": "rover_ancf",
    }
    return {field: read_record(name) for field, name in names.items()}


def _read(study: Study, folders: Mapping[str, Path]) -> SpeedResults:
    costs = _costs("fe", model_curves("fe", folders, around(study)))
    if without_planar_model(study) is None:
        costs += _costs("section", model_curves("section", folders, around(study)))
    return SpeedResults(**kept_runs(), curves=tuple(costs))


def _checks(study: Study, results: SpeedResults) -> Sequence[Check]:
    claim = Claim(
        id="speed.iterations",
        title="FE: Newton iterations, for a curve of 20 points, at the dearest orientation",
        quantity="iterations",
        unit="-",
        role="finding",
        source="our own aim; the count does not depend on the machine",
    )
    return [at_most(claim, lambda: results.dearest, CURVE_ITERATIONS)]


SPEED = Question(name="speed", title="Speed", group="Solvers", read=_read, checks=_checks, applies=VERIFICATION.applies)
