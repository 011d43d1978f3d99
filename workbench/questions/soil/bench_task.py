"""Tasks: the wheel on the bench with every soil of a study; the laws beside the published test.

Verified by tests/unit/test_workbench_soil.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from soil.soil import Soil
from soil.steady_wheel import standing_wheel
from workbench.execution.result_files import read_result, write_result
from workbench.questions.soil.bench import carcass_of, run_bench, wheel_on_soil
from workbench.questions.soil.measured import Refinement, controls, measured, refinements
from workbench.study.wheel_design import design_from

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["drive", "hold"]


def drive(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``result.json``: a bench a soil, and the wheel at rest on the first; returns slips driven."""
    found = read_result(needs[inputs["carcass"]])
    carcass = carcass_of(found)
    wheel, soils = wheel_on_soil(design_from(inputs["wheel"]), carcass), [Soil(**one) for one in inputs["soils"]]
    benches = []
    for number, soil in enumerate(soils):
        bench = run_bench(wheel, soil, inputs["load"], inputs["slips"], inputs["gravity"], towed=True)
        benches.append(bench.to_json())
        progress((number + 1) / len(soils))
    stands = standing_wheel(wheel, soils[0], inputs["load"])
    at_rest = {name: getattr(stands, name) for name in ("load", "sinkage", "hub_height", "deflection")}
    write_result(out, {"benches": benches, "radius_m": wheel.radius, "at_rest": at_rest})
    return len(soils) * len(inputs["slips"])


def hold(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``result.json``: measured values, and those of the laws with each refinement and control; returns points."""
    test = measured()
    write_result(
        out,
        {
            "slip": test.slip.tolist(),
            "measured": test.values.tolist(),
            "refinements": [_values(one) for one in refinements(test)],
            "controls": [_values(one) for one in controls(test)],
        },
    )
    progress(1.0)
    return len(test.slip)


def _values(one: Refinement) -> dict[str, Any]:
    return {"name": one.name, "values": one.values.tolist(), "errors": one.errors.tolist()}
