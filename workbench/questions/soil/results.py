"""What the tasks of a wheel on soil found. Verified by tests/unit/test_workbench_soil.py."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from contracts.curves import StiffnessCurve, read_curve
from contracts.errors import InputError
from workbench.execution.result_files import read_result
from workbench.questions.model_curves import CURVE
from workbench.questions.soil.bench import Bench
from workbench.questions.soil.graph import AT_REST, BENCH, MEASURED, at_rest_orientation
from workbench.questions.soil.held_climbs import HeldClimbs, held_climbs
from workbench.study.model import Study

__all__ = ["REQUIRED_SLOPE", "AtRest", "Held", "HeldRefinement", "OnSoil", "read_on_soil"]

REQUIRED_SLOPE = math.radians(25.0)
"""That the mission asks to be climbed [rad]."""
_LEAST_SHARE = 0.1
"""Of the load, below which models at rest are not compared."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HeldRefinement:
    """The laws with some of their refinements: values (n, 3), median errors of pull, torque and sinkage [-]."""

    name: str
    values: list[list[float]]
    errors: list[float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Held:
    """The laws beside a published test; columns are pull [N], torque [N m] and sinkage [m]."""

    slip: list[float]
    measured: list[list[float]]
    refinements: tuple[HeldRefinement, ...]
    controls: tuple[HeldRefinement, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class AtRest:
    """The wheel standing on the first soil: its curves by model, and the bench's rim there.

    Attributes
    ----------
    orientation_deg : what faces the ground [deg]
    load : of the bench's wheel [N]
    curves : load over the hub's way down since first touch; by model
    drop, sinkage : of the bench's wheel: way down of the hub since first touch, and depth of its rim [m]
    """

    orientation_deg: float
    load: float
    curves: Mapping[str, StiffnessCurve]
    drop: float
    sinkage: float

    def apart(self) -> float:
        """Largest difference of load between plates and solid at the solid's points, over the solid's [-]."""
        fe, plates = self.curves["fe"], self.curves["ancf_wheel"]
        last = min(fe.deflection[-1], plates.deflection[-1]) + 1e-12
        heavy = (fe.load >= _LEAST_SHARE * self.load) & (fe.deflection <= last)
        if not heavy.any():
            raise InputError("wheel at rest on soil", f"{fe.load[-1]:g} N", "carries too little to compare", "press it")
        return max(abs(float(plates.load_at(d)) / float(fe.load_at(d)) - 1.0) for d in fe.deflection[heavy].tolist())

    def bench_apart(self, model: str = "fe") -> tuple[float, float]:
        """Way down and depth of the bench's wheel over those of a model under the same load, less 1 [-]."""
        curve = self.curves[model]
        drop = curve.deflection_at(self.load)
        depth = float(np.interp(drop, curve.deflection, curve.columns["contact_point_penetration_m"]))
        return self.drop / drop - 1.0, self.sinkage / depth - 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class OnSoil:
    """Benches by soil, the laws beside a test, the wheel at rest, and the rover's slopes, if there is a record."""

    benches: tuple[Bench, ...]
    held: Held
    at_rest: AtRest
    climbs: HeldClimbs | None = None

    def slope(self, bench: Bench, *, rigid: bool = False) -> float:
        """Steepest slope [rad] a wheel of this pull climbs with its load: tan = largest pull over load."""
        states: Sequence[Any] = [row.rigid if rigid else row.wheel for row in bench.rows]
        return math.atan(max(one.drawbar_pull for one in states) / bench.load)


def read_on_soil(study: Study, folders: Mapping[str, Path]) -> OnSoil:
    """The results from the folders of their tasks."""
    bench, held = read_result(folders[BENCH]), read_result(folders[MEASURED])
    orientation = at_rest_orientation(study)
    stands = bench["at_rest"]
    at_rest = AtRest(
        orientation_deg=orientation,
        load=stands["load"],
        curves={
            model: read_curve(folders[name] / CURVE, model=model, orientation_deg=orientation)
            for model, name in AT_REST.items()
            if name in folders
        },
        drop=bench["radius_m"] - stands["hub_height"],
        sinkage=stands["sinkage"],
    )
    return OnSoil(
        benches=tuple(Bench.from_json(one) for one in bench["benches"]),
        held=Held(
            slip=held["slip"],
            measured=held["measured"],
            refinements=tuple(HeldRefinement(**one) for one in held["refinements"]),
            controls=tuple(HeldRefinement(**one) for one in held["controls"]),
        ),
        at_rest=at_rest,
        climbs=held_climbs(study),
    )
