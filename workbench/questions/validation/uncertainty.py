"""Validation uncertainty: the comparison error beside what is not known of mesh, inputs and published number.

With a simulated S and a published D, the comparison error is E = S - D, and the validation uncertainty

    u_val = sqrt(u_num^2 + u_input^2 + u_D^2),

all standard uncertainties (after ASME V&V 20-2009, section 1-5; from memory). u_num is half the grid convergence index
of the finest mesh, which is read as an interval of two standard deviations. Each open input contributes half the range
of S over its values over sqrt(3), as if evenly likely, u_input their root of squares: one at a time, no interplay.
Verified by tests/unit/test_workbench_validation.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from workbench.questions.mesh_study.grid_convergence import GridConvergence, grid_convergence
from workbench.questions.mesh_study.results import CREDIBLE_ORDERS
from workbench.questions.validation.cases import PublishedWheel

__all__ = ["Comparison", "InputEffect", "Verdict", "comparisons", "input_effects"]

Verdict = Literal["within", "beyond one", "beyond two"]
"""|E| at most u_val; more; more than twice that."""


@dataclass(frozen=True, slots=True, kw_only=True)
class InputEffect:
    """What an open input does to the hub displacement at the largest load.

    Attributes
    ----------
    what, source : its name, and where its values come from
    moves : name of each value -> displacement over that with the nominal value, less one [-]
    """

    what: str
    source: str
    moves: Mapping[str, float]

    @property
    def standard(self) -> float:
        """Standard uncertainty, over the displacement [-]: half the range, the nominal value in it, over sqrt(3)."""
        ends = [0.0, *self.moves.values()]
        return 0.5 * (max(ends) - min(ends)) / math.sqrt(3.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """One load [N]: S and D [m] with their standard uncertainties [m]; ``u_data`` None where nothing is stated."""

    load: float
    simulated: float
    published: float
    u_num: float
    u_input: float
    u_data: float | None
    convergence: GridConvergence

    @property
    def error(self) -> float:
        """E = S - D [m]."""
        return self.simulated - self.published

    @property
    def u_val(self) -> float:
        """Validation uncertainty [m]; an unknown u_D counts as zero, which makes it a lower bound."""
        return math.sqrt(self.u_num**2 + self.u_input**2 + (self.u_data or 0.0) ** 2)

    @property
    def ratio(self) -> float:
        """|E| over u_val [-]."""
        return abs(self.error) / self.u_val

    @property
    def verdict(self) -> Verdict:
        """What the ratio says."""
        return "within" if self.ratio <= 1.0 else "beyond one" if self.ratio <= 2.0 else "beyond two"


def input_effects(wheel: PublishedWheel, found: Mapping[str, Any]) -> tuple[InputEffect, ...]:
    """At the largest load, from a record's ``inputs_nominal_m`` (load) and ``inputs_m`` (input, value, load)."""
    nominal = found["inputs_nominal_m"][-1]
    return tuple(
        InputEffect(
            what=one.what,
            source=one.source,
            moves={name: run[-1] / nominal - 1.0 for name, run in zip(one.names, runs, strict=True)},
        )
        for one, runs in zip(wheel.inputs, found["inputs_m"], strict=True)
    )


def comparisons(wheel: PublishedWheel, found: Mapping[str, Any]) -> tuple[Comparison, ...]:
    """Each published load, from a record's ``factors`` and ``solid_m`` (factor, load), coarsest first, and inputs."""
    out = []
    for k, (load, published) in enumerate(wheel.points):
        values = [run[k] for run in reversed(found["solid_m"])]
        sizes = [1.0 / factor for factor in reversed(found["factors"])]
        convergence = grid_convergence(values, sizes, CREDIBLE_ORDERS)
        out.append(
            Comparison(
                load=load,
                simulated=values[0],
                published=published,
                u_num=0.5 * convergence.index_fine * abs(values[0]),
                u_input=values[0] * _of_inputs(found, k),
                u_data=_of_data(wheel, load),
                convergence=convergence,
            )
        )
    return tuple(out)


def _of_inputs(found: Mapping[str, Any], load: int) -> float:
    """Root of the squares of every input's standard uncertainty at the load of this number, over S [-]."""
    nominal = found["inputs_nominal_m"][load]

    def one(runs: Sequence[Sequence[float]]) -> float:
        moves = {str(k): run[load] / nominal - 1.0 for k, run in enumerate(runs)}
        return InputEffect(what="", source="", moves=moves).standard

    return math.hypot(*(one(runs) for runs in found["inputs_m"]))


def _of_data(wheel: PublishedWheel, load: float) -> float | None:
    """Half the published range over sqrt(3) [m], which is that of the largest load; None without one."""
    if wheel.data_range is None or load != wheel.points[-1][0]:
        return None
    low, high = wheel.data_range
    return 0.5 * (high - low) / math.sqrt(3.0)
