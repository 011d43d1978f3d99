"""What the thesis' sentences become as numbers. Verified by tests/unit/test_workbench_thesis_words.py."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.model_curves import ModelCurves, distances_from
from workbench.questions.strength.yielding import largest_utilisation
from workbench.questions.words.plausible import Plausible
from workbench.questions.words.readings import Reading

__all__ = ["AVERAGE", "FOLLOWS", "LOADS", "SMALL", "SPREAD_AT", "Words", "follows", "spread"]

LOADS = 160.0, 250.0
"""Range of the thesis' sweep [N] (Samarini 2020, section 3.2, Fig. 20)."""
AVERAGE = {0.020: 0.03, 0.030: 0.03, 0.035: 0.04}
"""Deflection [m] -> relative difference of the averages that is still good agreement."""
FOLLOWS = 0.05
"""Relative difference of an orientation from the tire's that is still good agreement."""
TOLD_AT = 20.0, 40.0, 80.0, 120.0, 160.0, 200.0, 250.0
"""Loads at which the models are told side by side [N]."""
SMALL, SPREAD_AT = 0.005, 0.020
"""Deflection up to which the slope is taken, and at which the spread of the orientations is [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Words:
    """Curves that the sentences speak of.

    Attributes
    ----------
    fe : the continuum's curves
    average : of them, weighted by the arcs that the orientations stand for
    ancf : the thesis' tire as the study has it
    readings : the tires that the thesis' text allows
    brush : the line of Table II
    section, twin : planar model of the wheel, and of its twin with all springs in phase
    yield_strength : of each part [Pa]
    plausible : wheels that satisfy the statements
    mesh : numerical uncertainty of the average, relative [-]; None if not known
    verdicts : by statement, "holds", "does not hold" or "not decided"
    hoops : the same of the wheel with hoops, by the section model
    """

    fe: ModelCurves
    average: StiffnessCurve
    ancf: ModelCurves
    readings: Mapping[Reading, ModelCurves]
    brush: StiffnessCurve
    section: ModelCurves
    twin: ModelCurves
    yield_strength: Mapping[str, float]
    plausible: Plausible
    mesh: float | None = None
    verdicts: Mapping[str, str] = field(default_factory=dict)
    hoops: Words | None = None

    @property
    def brush_slope(self) -> float:
        """[N/m]."""
        return float(self.brush.load[-1] / self.brush.deflection[-1])

    def brush_misses(self, load: float) -> float:
        """Relative difference of the average from the brush line where that carries a load [N] [-]."""
        return float(self.average.load_at(load / self.brush_slope) / load - 1.0)

    @property
    def reading(self) -> Reading:
        """The tire that this wheel is nearest to, by its largest miss of the averages and the two orientations."""
        return min(self.readings, key=self._misses)

    def _misses(self, reading: Reading) -> float:
        """Of what the curves reach."""
        tire = self.readings[reading]
        found = []
        for deflection, within in AVERAGE.items():
            with suppress(InputError):
                found.append(abs(self.average_over(tire, deflection) - 1.0) / within)
        for curve in tire.by_orientation.values():
            with suppress(InputError):
                found.append(follows(self.fe, curve)[1] / FOLLOWS)
        return max(found, default=math.inf)

    @property
    def tire(self) -> ModelCurves:
        """Its curves."""
        return self.readings[self.reading]

    def average_over(self, tire: ModelCurves, deflection: float) -> float:
        """Load of the average over the mean of a tire's orientations, at a deflection [m] [-]."""
        return float(self.average.load_at(deflection) / tire.average.load_at(deflection))

    @property
    def in_order(self) -> list[tuple[float, str, tuple[str, ...]]]:
        """At rising loads [N]: deflection of the average, and how far brush line, tire as it is, nearest tire lie off.

        Differences of load at that deflection, relative to the average.
        """
        others = [self.brush, self.ancf.average, self.tire.average]
        return [
            (
                load,
                _or_words(lambda load=load: f"{1e3 * self.average.deflection_at(load):.1f}"),  # type: ignore[misc]
                tuple(_or_words(partial(self._off, load, other)) for other in others),
            )
            for load in TOLD_AT
        ]

    def _off(self, load: float, other: StiffnessCurve) -> str:
        return f"{100.0 * (float(other.load_at(self.average.deflection_at(load))) / load - 1.0):+.1f} %"

    @property
    def shown(self) -> dict[str, str]:
        """Numbers of the table by name, in words where a curve does not reach."""
        return {
            "slope": _or_words(lambda: f"{1e-3 * self.average.initial_tangent(SMALL):.2f} N/mm"),
            "small": _or_words(lambda: f"{100.0 * self.brush_misses(LOADS[0]):+.1f} %"),
            "large": _or_words(lambda: f"{100.0 * self.brush_misses(LOADS[1]):+.1f} %"),
            "averages": self._averages(self.tire),
            "followed": ", ".join(self._followed(o) for o in self.tire.loaded),
            "averages_as_is": self._averages(self.ancf),
            "spread": _or_words(
                lambda: (
                    f"{100.0 * spread(self.section, SPREAD_AT):.0f} % as it is, "
                    f"{100.0 * spread(self.twin, SPREAD_AT):.0f} % in phase"
                )
            ),
            "stress": _or_words(lambda: f"{100.0 * self.stress(LOADS[1]):.0f} % of the yield strength"),
        }

    def _averages(self, tire: ModelCurves) -> str:
        return ", ".join(_or_words(lambda d=d: f"{100.0 * self.average_over(tire, d) - 100.0:+.1f} %") for d in AVERAGE)  # type: ignore[misc]

    def _followed(self, orientation: float) -> str:
        def told() -> str:
            best, miss = follows(self.fe, self.tire.by_orientation[orientation])
            return f"{orientation:g}° by {best:g}° within {100.0 * miss:.1f} %"

        return _or_words(told)

    def stress(self, load: float) -> float:
        """Largest stress over yield strength of any part and orientation, up to a load [N] [-]."""
        return max(largest_utilisation(curve, self.yield_strength, load) for curve in self.fe.by_orientation.values())

    def negative_pivots(self, load: float) -> float:
        """Largest number of negative pivots of any orientation up to a load [N]."""
        counts = []
        for curve in self.fe.by_orientation.values():
            if "negative_pivots" not in curve.columns:
                raise InputError("negative pivots", "none", "are counted with friction on the ground", "set it to 0")
            curve.deflection_at(load)
            counts.append(curve.columns["negative_pivots"][: int(np.argmax(curve.load >= load)) + 1].max())
        return float(max(counts))


def _or_words(number: Callable[[], str]) -> str:
    try:
        return number()
    except InputError:
        return "not reached"


def follows(curves: ModelCurves, reference: StiffnessCurve) -> tuple[float, float]:
    """Which orientation [deg] follows a curve best over the thesis' sweep, and its largest relative difference [-].

    Raises
    ------
    InputError
        If none of them reaches so far.
    """
    found = distances_from(list(curves.by_orientation.values()), reference, LOADS)
    misses = {o: miss for o, miss in zip(curves.by_orientation, found, strict=True) if miss is not None}
    if not misses:
        raise InputError("curves", "none", "reaches the end of the ANCF tire's sweep", "raise fe.max_deflection")
    best = min(misses, key=lambda orientation: misses[orientation])
    return best, misses[best]


def spread(curves: ModelCurves, deflection: float) -> float:
    """Largest less smallest load of the orientations over their mean, at a deflection [m] [-]."""
    loads = [float(curve.load_at(deflection)) for curve in curves.by_orientation.values()]
    return (max(loads) - min(loads)) / float(np.mean(loads))
