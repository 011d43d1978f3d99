"""A search of a sweep: points chosen in batches by CMA-ES, judged by the aims of [sweep].

The cost of a point is its largest miss (`study.sweep.Aim.miss`) plus a tenth of what the misses exceed 1 by, so that it
falls while any of them does. The strategy (Hansen, arXiv:1604.00772; package cmaes) sees parameters as numbers in
[0, 1] and begins around the study as it is. It is drawn from the section's seed alone, so that the same study goes the
same way again, over the results that the store holds. When it has converged it starts anew, elsewhere.
Verified by tests/unit/test_workbench_search.py and tests/end_to_end/test_search.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from workbench.questions.sweep.results import Outcome, measured
from workbench.study.sweep import Aim, SweepSection

__all__ = ["Judged", "Strategy", "best_points", "judge", "pareto"]

MISSING = 10.0
"""Miss of an aim whose number a point does not have."""
SMALLEST_SCALE, LARGEST_SCALE, SCALES = 0.5, 2.0, 57
"""Of the strips' thickness, where a search is free to scale."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Judged:
    """A point against the aims.

    Attributes
    ----------
    scale : of the strips' thickness, at which it is read [-]
    misses : of each aim and each group of `SweepSection.one_of` [-]; 1 or less is good
    chosen : group -> the alternative that is met best
    outcome : its curves at that scale
    """

    scale: float
    misses: Mapping[str, float]
    chosen: Mapping[str, str]
    outcome: Outcome

    @property
    def largest(self) -> float:
        """Largest miss [-]."""
        return max(self.misses.values())

    @property
    def cost(self) -> float:
        """What the search makes small [-]."""
        return self.largest + 0.1 * sum(max(0.0, miss - 1.0) for miss in self.misses.values())


def judge(outcome: Outcome, section: SweepSection, up_to: float, followed: Mapping[str, StiffnessCurve]) -> Judged:
    """Misses of one outcome, where the section says so at the thickness that makes the cost smallest."""
    scales = np.geomspace(SMALLEST_SCALE, LARGEST_SCALE, SCALES) if section.scaled else np.ones(1)
    if outcome.curve is None or outcome.curve.unloaded:
        misses, chosen = _misses(section, {})
        return Judged(scale=1.0, misses=misses, chosen=chosen, outcome=outcome)

    def at(scale: float) -> Judged:
        scaled = _scaled(outcome, scale)
        misses, chosen = _misses(section, measured(scaled, section, up_to, None, followed))
        return Judged(scale=scale, misses=misses, chosen=chosen, outcome=scaled)

    best = min((at(float(scale)) for scale in scales), key=lambda one: one.cost)
    step = scales[1] / scales[0] if section.scaled else 1.0
    while step > 1.0 + 1e-4:  # between two of the scales
        step = math.sqrt(step)
        best = min((best, at(best.scale / step), at(best.scale * step)), key=lambda one: one.cost)
    return best


def _misses(
    section: SweepSection, numbers: Mapping[str, float | str | None]
) -> tuple[dict[str, float], dict[str, str]]:
    """Misses of the aims and of the best alternative of each group, and which that is."""
    misses, chosen = {name: _miss(aim, numbers.get(name)) for name, aim in section.aims.items()}, {}
    for group, ways in section.one_of.items():
        each = {way: max(_miss(aim, numbers.get(name)) for name, aim in aims.items()) for way, aims in ways.items()}
        chosen[group] = min(each, key=lambda way: each[way])
        misses[group] = each[chosen[group]]
    return misses, chosen


def _miss(aim: Aim, value: float | str | None) -> float:
    return min(aim.miss(value), MISSING) if isinstance(value, float | int) else MISSING


def _scaled(outcome: Outcome, scale: float) -> Outcome:
    """Curves of strips ``scale`` times as thick: load with the cube, stress in proportion, where bending rules."""
    if scale == 1.0 or outcome.curve is None:
        return outcome

    def of(curve: StiffnessCurve) -> StiffnessCurve:
        factors = {name: scale**3 for name in curve.columns if name.startswith("load_")}
        factors |= {name: scale for name in curve.columns if name.startswith(("max_von_mises_", "max_linearised_"))}
        columns = {name: factors.get(name, 1.0) * values for name, values in curve.columns.items()}
        return replace(curve, load=scale**3 * curve.load, columns=columns)

    wheel = outcome.wheel and replace(outcome.wheel, masses={})  # known when it runs again at that thickness
    curves = tuple(of(c) for c in outcome.by_orientation)
    return replace(outcome, curve=of(outcome.curve), by_orientation=curves, wheel=wheel, travels={})


@dataclass(slots=True, kw_only=True)
class Strategy:
    """Asks for batches of points in [0, 1)^d and is told their costs; the first ones lie around ``start`` (d,).

    ``step`` is their standard deviation, as a part of the ranges. The strategy needs two dimensions: a single one gets
    a companion that nobody reads.
    """

    start: NDArray[np.float64]
    batch: int
    seed: int
    step: float = 0.3
    _runs: int = 0
    _cma: Any = None
    _asked: list[NDArray[np.float64]] = field(default_factory=list)

    def ask(self, more: Sequence[NDArray[np.float64]] = ()) -> NDArray[np.float64]:
        """The next batch, (batch, dimensions); ``more`` points of others' choice (dimensions,) take the last places."""
        dimensions = max(len(self.start), 2)
        if self._cma is None or self._cma.should_stop():
            from cmaes import CMA  # type: ignore[import-untyped]  # with scipy.stats, a second: only who searches waits

            rng = np.random.default_rng((self.seed, self._runs))
            start = np.full(dimensions, 0.5)
            start[: len(self.start)] = self.start
            mean = start if self._runs == 0 else rng.uniform(0.2, 0.8, dimensions)
            bounds = np.tile([0.0, np.nextafter(1.0, 0.0)], (dimensions, 1))
            seed = int(rng.integers(2**31 - 1))
            self._cma = CMA(mean=mean, sigma=self.step, bounds=bounds, population_size=self.batch, seed=seed)
            self._runs += 1
        self._asked = [self._cma.ask() for _ in range(self.batch - len(more))]
        self._asked += [np.append(one, np.full(dimensions - len(one), 0.5)) for one in more]
        return np.array(self._asked)[:, : len(self.start)]

    def tell(self, costs: Sequence[float]) -> None:
        """Costs of the last batch, in its order."""
        assert self._cma is not None
        self._cma.tell(list(zip(self._asked, costs, strict=True)))


def best_points(judged: Mapping[int, Judged], count: int) -> list[int]:
    """Numbers of the points of least cost, best first."""
    return sorted(judged, key=lambda number: (judged[number].cost, number))[:count]


def pareto(judged: Mapping[int, Judged]) -> set[int]:
    """Numbers of the points that no other one beats in every aim; misses below 1 count as 1."""
    table = {n: np.maximum(list(one.misses.values()), 1.0) for n, one in judged.items()}
    return {
        n
        for n, mine in table.items()
        if not any(np.all(other <= mine) and np.any(other < mine) for other in table.values())
    }
