"""Tasks that fit the ANCF tire to the FE curves, or hold it against them as it is.

``result.json`` has the fields of `ancf_fit.records.Held` or `Fitted`, null where there is no number.
Verified by tests/unit/test_workbench_ancf_fit.py and tests/end_to_end/test_calibrate_ancf.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.fit.curve_fit import CurveFit, LoadData
from ancf_reduced.fit.parameters import FreeParameter, Parameter, with_mass
from ancf_reduced.fit.phase_search import fit_from_phases
from ancf_reduced.fit.travel_fit import TravelData
from ancf_reduced.plates.mass import flexible_mass
from ancf_reduced.tire.mesh import Tire, build_tire
from ancf_reduced.tire.static import solve_tire, tire_curve
from contracts.curves import Around, StiffnessCurve, write_curve
from contracts.errors import ConvergenceError, InputError
from workbench.execution.result_files import FAILURE, write_result
from workbench.questions.ancf_fit.fit import (
    average_error,
    compared_deflections,
    fe_curves,
    fitted_deflections,
)
from workbench.questions.ancf_fit.records import Fitted, FittedParameter, Held
from workbench.questions.ancf_fit.travels import fe_travels, travel_rows
from workbench.questions.model_curves import mean_curve
from workbench.study.ancf_tire import preset_from, tire_from
from workbench.study.orientation import orientation_name
from workbench.study.thesis import WHEEL_MASS

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["evaluate", "fit"]

FloatArray = NDArray[np.float64]
_STEP = 1e-3
"""Spacing of the points of the curves that are shown [m]."""
_TOLERANCE = 1e-5
_MIRRORED_EVERY = 20
"""Of the deflections at which curves are compared, solved again for the mirror images."""


def evaluate(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Curves of a preset at the FE's orientations and how far they lie from the FE's."""
    tire = tire_from(inputs)
    try:
        solid = fe_curves(needs, inputs["orientations_deg"])
        travels = fe_travels(inputs, needs, _orientations(solid))
        write_result(out, asdict(_held_against(tire, inputs, (solid, travels), out)))
    except (InputError, ConvergenceError) as error:
        write_result(out, {FAILURE: str(error)})
    return _unknowns(tire)


def fit(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Fit a preset to the FE curves; without a result, say why."""
    try:
        write_result(out, asdict(_fitted(inputs, needs, out, progress)))
    except (InputError, ConvergenceError) as error:
        write_result(out, {FAILURE: str(error)})
    return _unknowns(tire_from(inputs))


def _fitted(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> Fitted:
    """The fit's numbers."""
    solid = fe_curves(needs, inputs["orientations_deg"])
    average = mean_curve(solid, Around(**inputs["around"]))
    deflection = fitted_deflections(average, inputs["load_range"], inputs["points"])
    load = np.array([curve.load_at(deflection) for curve in solid])
    scale = np.broadcast_to(average.load_at(deflection), load.shape)
    phi, weight = np.radians(_orientations(solid)), inputs["average_weight"]
    travels = fe_travels(inputs, needs, _orientations(solid))
    data = LoadData(phi=phi, deflection=deflection, load=load, scale=scale, mean_weight=weight, travel=travels)
    free = [FreeParameter(parameter=Parameter(name), lower=low, upper=high) for name, low, high in inputs["free"]]
    search = fit_from_phases(preset_from(inputs["preset"]), free, data, inputs["phase_starts"], _TOLERANCE)
    found = search.fit
    progress(0.8)
    tire = build_tire(with_mass(found.preset, WHEEL_MASS))
    held, statistics = _held_against(tire, inputs, (solid, travels), out), found.statistics
    names = [p.parameter.value for p in found.free]
    return Fitted(
        **{field.name: getattr(held, field.name) for field in fields(held)},
        correlation=tuple(tuple(map(_number, row)) for row in statistics.correlation.tolist()),
        condition=_number(statistics.condition),
        weakest=tuple(map(_number, statistics.weakest.tolist())),
        indistinguishable=tuple((names[i], names[j]) for i, j in statistics.indistinguishable()),
        evaluations=found.evaluations,
        settled=found.settled,
        deflections_m=tuple(deflection.tolist()),
        parameters=_parameters(found),
        phase_trials=tuple(search.trials),
    )


def _unknowns(tire: Tire) -> int:
    return int(tire.mesh.reference_coordinates()[tire.tie.free].size)


def _orientations(solid: Sequence[StiffnessCurve]) -> list[float]:
    return [o for curve in solid if (o := curve.orientation_deg) is not None]


def _held_against(
    tire: Tire, inputs: Mapping[str, Any], fe: tuple[Sequence[StiffnessCurve], TravelData | None], out: Path
) -> Held:
    """Write the tire's curves; its numbers, and its errors in percent of the load over the range of loads.

    fe : curves and travels of the solid wheel
    """
    solid, travels = fe
    average = mean_curve(solid, Around(**inputs["around"]))
    end = float(fitted_deflections(average, inputs["load_range"], 2)[-1])
    grid = [*np.arange(0.0, end - 0.1 * _STEP, _STEP).round(9).tolist(), end]
    orientations = _orientations(solid)
    curves = [tire_curve(tire, math.radians(o), grid) for o in orientations]
    for curve, o in zip(curves, orientations, strict=True):
        write_curve(curve, out / f"{orientation_name('ancf', o)}.csv")
    inside = compared_deflections(average, inputs["load_range"])
    pairs = [(c.load_at(inside), s.load_at(inside)) for c, s in zip(curves, solid, strict=True)]
    return Held(
        preset=tire.preset,
        flexible_mass_kg=flexible_mass(tire.model),
        orientations_deg=tuple(orientations),
        load_range_N=(float(average.load_at(inside[0])), float(average.load_at(inside[-1]))),
        relative_rms=tuple(float(np.linalg.norm(f - s) / np.linalg.norm(s)) for f, s in pairs),
        largest_N=tuple(float(np.abs(f - s).max()) for f, s in pairs),
        average=average_error(curves, average, inputs["load_range"]),
        mirrored_rms=_mirrored_rms(tire, inside, solid) if inputs["mirrored"] else None,
        travel_load_N=None if travels is None else travels.load,
        travels=travel_rows(tire, travels, orientations, grid[1:]),
    )


def _mirrored_rms(tire: Tire, deflection: FloatArray, solid: Sequence[StiffnessCurve]) -> tuple[float, ...] | None:
    """Relative rms at the mirror images of the orientations, where a wheel that is its own has the same curves.

    What a free phase makes of one half of the wheel's orientations says nothing about the other. None where no
    equilibrium is found.
    """
    errors = []
    for curve in solid:
        assert curve.orientation_deg is not None
        try:
            load = solve_tire(tire, -math.radians(curve.orientation_deg), deflection[::_MIRRORED_EVERY]).load
        except ConvergenceError:
            return None
        wanted = curve.load_at(deflection[::_MIRRORED_EVERY])
        errors.append(float(np.linalg.norm(load - wanted) / np.linalg.norm(wanted)))
    return tuple(errors)


def _parameters(found: CurveFit) -> tuple[FittedParameter, ...]:
    """Each free parameter with its 95 % from the fit."""
    statistics, rows = found.statistics, []
    for i, (p, value) in enumerate(zip(found.free, found.values.tolist(), strict=True)):
        inside = bool(statistics.inside[i])
        at, half = float(statistics.unknowns[i]), float(statistics.half_width[i])
        row = FittedParameter(
            name=p.parameter.value,
            unit=p.parameter.unit,
            value=value,
            bounds=(p.lower, p.upper),
            start=p.parameter.of(found.start),
            at_bound=not inside,
            interval=_ends(p.parameter, at, half) if inside else None,
        )
        rows.append(row)
    return tuple(rows)


def _ends(parameter: Parameter, middle: float, half: float) -> tuple[float, float] | None:
    """Both ends of an interval of the unknown, as values; None where it is wider than a factor of a million."""
    return (parameter.value_at(middle - half), parameter.value_at(middle + half)) if half < 14.0 else None


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
