"""Fits from several phases: which phases, the best of them, and one start as before."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.fit.curve_fit import LoadData, fit_curves
from ancf_reduced.fit.parameters import FreeParameter, Parameter
from ancf_reduced.fit.phase_search import fit_from_phases, phases_over_a_turn
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.static import solve_tire
from contracts.errors import InputError

TRUTH = replace(
    thesis_preset(), quadrature=(3, 3, 2), contact_points=(6, 3), spokes=3, circumferential_plates=6, phase=-0.6
)
PHI, DEFLECTION = np.radians([0.0, 20.0, 40.0, 60.0]), np.array([0.008, 0.016])
LOAD = np.array([solve_tire(build_tire(TRUTH), phi, DEFLECTION).load for phi in PHI.tolist()])
DATA = LoadData(phi=PHI, deflection=DEFLECTION, load=LOAD, scale=np.broadcast_to(LOAD.mean(axis=0), LOAD.shape))
MODULUS = FreeParameter(parameter=Parameter.YOUNG_MODULUS, lower=5e4, upper=5e6)
PHASE = FreeParameter(parameter=Parameter.PHASE, lower=-np.pi / 3, upper=np.pi / 3)


def test_phases_cover_a_turn_within_the_bounds() -> None:
    bounds = (-np.pi / 3, np.pi / 3)
    found = np.degrees(phases_over_a_turn(np.radians(10.0), 3, 6, bounds))
    np.testing.assert_allclose(found, [10.0, 30.0, 50.0, -50.0, -30.0, -10.0])
    np.testing.assert_allclose(phases_over_a_turn(0.0, 3, 2, bounds), [0.0, -np.pi / 3])
    narrow = np.degrees(phases_over_a_turn(0.0, 3, 4, (0.0, np.pi / 6)))
    np.testing.assert_allclose(narrow, [0.0, 30.0])


def test_the_right_valley_is_found() -> None:
    """From a phase 55 deg off a single search ends elsewhere (negative control); six starts find the phase."""
    start = replace(TRUTH, phase=0.36, young_modulus=400e3)
    single = fit_from_phases(start, [MODULUS, PHASE], DATA, 1)
    assert single.trials == ()
    assert abs(single.fit.preset.phase - TRUTH.phase) > 0.3
    assert single.fit.relative_error.max() > 0.03
    search = fit_from_phases(start, [MODULUS, PHASE], DATA, 6)
    assert search.fit.preset.phase == pytest.approx(TRUTH.phase, abs=1e-3)
    assert search.fit.preset.young_modulus == pytest.approx(TRUTH.young_modulus, rel=1e-3)
    assert search.fit.start == start
    assert len(search.trials) == 6
    sums = [t.sum_of_squares for t in search.trials if t.sum_of_squares is not None]
    assert min(sums) < 1e-3 * max(sums)
    assert search.fit.evaluations > single.fit.evaluations


def test_one_start_is_the_plain_fit() -> None:
    start = replace(TRUTH, young_modulus=400e3)
    plain, search = fit_curves(start, [MODULUS], DATA), fit_from_phases(start, [MODULUS], DATA, 1)
    np.testing.assert_array_equal(plain.values, search.fit.values)


def test_starts_without_a_free_phase_are_refused() -> None:
    with pytest.raises(InputError, match="need the phase to be free"):
        fit_from_phases(TRUTH, [MODULUS], DATA, 2)


@pytest.mark.parametrize(("starts", "lower", "upper"), [(2, 1.0, 1.1), (0, -1.0, 1.0), (-1, -1.0, 1.0)])
def test_starts_that_leave_no_phase_are_refused(starts: int, lower: float, upper: float) -> None:
    with pytest.raises(InputError, match="leave no phase of the tire"):
        fit_from_phases(TRUTH, [replace(PHASE, lower=lower, upper=upper)], DATA, starts)
