"""An orientation of which no point converged: averages leave it out, checks that need it are not evaluated."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from contracts.curves import StiffnessCurve, read_curve, write_curve
from contracts.errors import IncrementRecord
from workbench.questions.fe.checks import spread_checks
from workbench.questions.model_curves import ModelCurves, RunNumbers, mean_curve
from workbench.questions.models.question import agreement_checks
from workbench.questions.numerics.energy import energy_check
from workbench.questions.section.question import section_checks
from workbench.study.sections import ToleranceSection

TOLERANCES = ToleranceSection()
REASON = "orientation 15 deg, no point of the curve reached: a made-up reason"


def _curve(orientation: float, slope: float, model: str = "fe") -> StiffnessCurve:
    d = np.linspace(0.0, 0.02, 11)
    columns = {name: np.full(11, 1e-9) for name in ("force_imbalance", "moment_imbalance")}
    columns["stored_energy_J"] = 0.5 * slope * d**2
    return StiffnessCurve(model=model, orientation_deg=orientation, deflection=d, load=slope * d, columns=columns)


def _unloaded(orientation: float, model: str = "fe") -> StiffnessCurve:
    whole = _curve(orientation, 0.0, model)
    first = {name: values[:1] for name, values in whole.columns.items()}
    return replace(whole, deflection=whole.deflection[:1], load=whole.load[:1], columns=first, partial=True)


def _model(*curves: StiffnessCurve) -> ModelCurves:
    def run(curve: StiffnessCurve) -> RunNumbers:
        record = IncrementRecord(target=0.0, step=0.0, converged=not curve.unloaded, residuals=(1.0, 1e-9))
        return RunNumbers(increments=(record,), failure=REASON if curve.unloaded else None)

    by_orientation = {float(c.orientation_deg or 0.0): c for c in curves}
    return ModelCurves(
        model=curves[0].model,
        by_orientation=by_orientation,
        average=mean_curve(curves),
        runs={o: run(c) for o, c in by_orientation.items()},
    )


def test_a_curve_of_first_contact_alone_survives_its_file(tmp_path: Path) -> None:
    write_curve(_unloaded(15.0), tmp_path / "curve.csv")
    back = read_curve(tmp_path / "curve.csv")
    assert (back.unloaded, back.partial) == (True, True)
    assert list(back.columns) == ["force_imbalance", "moment_imbalance", "stored_energy_J"]


def test_the_average_leaves_out_what_is_missing_and_says_so() -> None:
    fe = _model(_curve(0.0, 8000.0), _unloaded(15.0), _curve(30.0, 9000.0))
    assert (list(fe.loaded), fe.missing) == ([0.0, 30.0], {15.0: REASON})
    assert fe.average.partial
    assert "2 orientations" in fe.average.source
    assert "without 15.0 deg" in fe.average.source
    assert float(fe.average.load_at(0.01)) == pytest.approx(85.0)


def test_an_average_of_sound_curves_is_whole() -> None:
    """Negative control."""
    average = mean_curve([_curve(0.0, 8000.0), _curve(30.0, 9000.0)])
    assert not average.partial
    assert "without" not in average.source


def test_checks_go_on_with_what_converged() -> None:
    fe = _model(_curve(0.0, 8000.0), _unloaded(15.0), _curve(30.0, 9000.0))
    assert energy_check(list(fe.by_orientation.values()), 0.01).status == "pass"
    assert {c.status for c in spread_checks(fe, TOLERANCES, 0.04)} == {"error"}


def test_without_any_curve_nothing_is_evaluated() -> None:
    fe = _model(_unloaded(0.0), _unloaded(15.0))
    assert fe.average.unloaded
    checks = [energy_check(list(fe.by_orientation.values()), 0.01)]
    checks += agreement_checks(["ancf", "brush"], {}, TOLERANCES)
    assert {c.status for c in checks} == {"error"}
    assert not any(isinstance(c.reference, float) and math.isnan(c.reference) for c in checks)


def test_averages_of_two_models_are_compared_where_neither_misses() -> None:
    """Section model 2 % too stiff; the negative control compares averages of different orientations: 7 % off."""
    section = _model(_curve(0.0, 8160.0, "section"), _curve(15.0, 9180.0, "section"))
    fe = _model(_curve(0.0, 8000.0), _unloaded(15.0))
    checks = {c.id: c for c in section_checks(section, fe, TOLERANCES)}
    assert checks["section.agreement"].value == pytest.approx(0.02)
    assert checks["section.vs_solid_phi015"].status == "error"
    assert float(section.average.load_at(0.01) / fe.average.load_at(0.01)) > 1.07
