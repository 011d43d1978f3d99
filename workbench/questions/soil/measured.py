"""The laws held against a published single-wheel test, with one refinement after the other.

No number is fitted to these points: each is the soil's own or of another source (``soil/soils.toml``). Verified by
tests/unit/test_workbench_soil.py.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.published import published_table
from soil.soil import Soil, soil_named
from soil.steady_wheel import WheelOnSoil, steady_wheel

__all__ = ["CONTROLS", "REFINEMENTS", "TABLE", "Measured", "Refinement", "controls", "measured", "refinements"]

FloatArray = NDArray[np.float64]
TABLE = "ding2011_smooth"
EARTH = 9.81
QUANTITIES = ("pull", "torque", "sinkage")
_PLAIN: dict[str, Any] = {"slip_sinkage": 0.0, "rim_friction": 1.0, "unloading_growth": 1e15}
REFINEMENTS: dict[str, dict[str, Any]] = {
    "plain": _PLAIN,
    "slip sinkage": _PLAIN | {"slip_sinkage": 1.0},
    "unloading behind": _PLAIN | {"unloading_growth": 503e6},
    "friction of the bare rim": _PLAIN | {"rim_friction": 0.76},
    "all three": {},
}
"""Name -> what of the soil's numbers is changed: Wong and Reece's wheel alone, each refinement alone, all."""

CONTROLS = {"K ten times": ("shear_modulus", 10.0), "half the friction angle": ("friction_angle", 0.5)}
"""Name -> number of the soil that is wrong, and by what factor: the measured points must notice. They cannot notice the
cohesion, which a smooth rim slides without."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Measured:
    """The test: slip (n,) [-], pull [N], torque [N m], sinkage [m]."""

    wheel: WheelOnSoil
    load: float
    slip: FloatArray
    values: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Refinement:
    """What the laws give with some of their refinements.

    Attributes
    ----------
    name : which
    values : (n, 3) pull [N], torque [N m], sinkage [m] at the test's slips
    errors : (3,) median of the relative errors where the slip is above zero [-]
    """

    name: str
    values: FloatArray
    errors: FloatArray


def measured() -> Measured:
    """Ding et al. (2011), a smooth rigid wheel."""
    table = published_table(TABLE)
    first = {name: float(table[name][0]) for name in table.names}
    return Measured(
        wheel=WheelOnSoil(
            radius=first["wheel_radius_m"],
            width=first["wheel_width_m"],
            lug_height=first["grouser_height_m"],
            lugs=int(first["grouser_count"]),
        ),
        load=first["load_N"],
        slip=table["slip"],
        values=np.column_stack([table["drawbar_pull_N"], table["torque_N_m"], table["sinkage_m"]]),
    )


def refinements(test: Measured) -> tuple[Refinement, ...]:
    """The laws on the test's own soil with each of `REFINEMENTS`."""
    return tuple(_held(name, replace(soil_named("ding2011"), **change), test) for name, change in REFINEMENTS.items())


def controls(test: Measured) -> tuple[Refinement, ...]:
    """All three refinements with each of `CONTROLS`."""
    soil = replace(soil_named("ding2011"), ranges={})
    return tuple(
        _held(name, replace(soil, **{key: factor * getattr(soil, key)}), test)
        for name, (key, factor) in CONTROLS.items()
    )


def _held(name: str, soil: Soil, test: Measured) -> Refinement:
    states = [steady_wheel(test.wheel, soil, test.load, slip, EARTH) for slip in test.slip.tolist()]
    values = np.array([(one.drawbar_pull, one.torque, one.sinkage) for one in states])
    slips = test.slip > 0.0
    errors = np.median(np.abs(values[slips] / test.values[slips] - 1.0), axis=0)
    return Refinement(name=name, values=values, errors=errors)
