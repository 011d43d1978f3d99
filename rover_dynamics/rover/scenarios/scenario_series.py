"""A scenario's motion as the time series that is written and compared.

Verified by tests/unit/test_rover_scenarios.py.
"""

from __future__ import annotations

from contracts.series import TimeSeries
from rover_dynamics.rover.scenarios.scenario import LATERAL, ScenarioRun

__all__ = ["scenario_series"]


def scenario_series(run: ScenarioRun) -> TimeSeries:
    """First body and wheels against time."""
    columns = {f"body_{axis}_m": run.place[:, k] for k, axis in enumerate("xyz")}
    columns |= {f"body_v{axis}_m_s": run.motion.velocities[:, 0, k] for k, axis in enumerate("xyz")}
    columns["body_lean_rad"] = run.lean
    for k, leg in enumerate(run.design.legs):
        columns[f"{leg.name}_load_N"] = run.loads[:, k]
        columns[f"{leg.name}_deflection_m"] = run.deflections[:, k]
        columns[f"{leg.name}_tractive_N"] = run.tractive[:, k]
        columns[f"{leg.name}_lateral_N"] = run.motion.tires[:, k, LATERAL]
        if run.scenario.soil is not None:
            columns[f"{leg.name}_sinkage_m"] = run.sinkages[:, k]
            columns[f"{leg.name}_slip"] = run.slips[:, k, 0]
    return TimeSeries(
        scenario=run.scenario.name,
        tire=run.scenario.tire_model,
        time=run.motion.times,
        columns=columns,
        source=f"{run.design.name}: {run.scenario.title} ({run.scenario.source}); {run.scenario.tire_model} tire; "
        "x forward, y left, z normal to the ground, world; tractive and lateral forces of the ground on the wheel",
        partial=run.stopped is not None,
    )
