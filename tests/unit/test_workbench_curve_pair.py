"""Tangents, energies and judgements on curves whose tangent and energy are known exactly."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.models.metrics import compare_curves
from workbench.questions.two_curves.pair import compared, judged
from workbench.questions.two_curves.shape import tangent_stiffness, work_between
from workbench.study.curve_file import MeasuredCurve
from workbench.study.deformation import Kind

A, B = 6000.0, 9e4
"""F = A d + B d^2 [N], d in metres: tangent A + 2 B d, energy A d^2 / 2 + B d^3 / 3."""


def _curve(points: np.ndarray, factor: float = 1.0, model: str = "mine") -> StiffnessCurve:
    load = factor * (A * points + B * points**2)
    return StiffnessCurve(model=model, orientation_deg=None, deflection=points, load=load)


def _uneven(n: int, end: float = 0.03) -> np.ndarray:
    return end * np.linspace(0.0, 1.0, n) ** 1.7


def _measured(curve: StiffnessCurve, kind: Kind = "radial deflection", share: float | None = None) -> MeasuredCurve:
    return MeasuredCurve(curve=curve, kind=kind, uncertainty=None if share is None else share * np.abs(curve.load))


@pytest.mark.parametrize("n", [3, 4, 5, 9, 60])
def test_tangent_of_a_parabola_is_exact_on_an_uneven_grid_up_to_its_ends(n: int) -> None:
    d = np.linspace(0.0, 0.03, 50)
    np.testing.assert_allclose(tangent_stiffness(_curve(_uneven(n)), d, 0.003), A + 2.0 * B * d, rtol=1e-9)


def test_tangent_of_two_points_is_their_slope() -> None:
    found = tangent_stiffness(_curve(np.array([0.0, 0.03])), np.linspace(0.0, 0.03, 5), 0.003)
    np.testing.assert_allclose(found, A + B * 0.03, rtol=1e-12)


def test_tangent_of_a_sine_is_of_second_order_in_the_reach() -> None:
    x = np.linspace(0.0, 1.0, 2001)
    curve = StiffnessCurve(model="sine", orientation_deg=None, deflection=x, load=np.sin(5.0 * x))
    at = np.array([0.3, 0.6])
    errors = [np.abs(tangent_stiffness(curve, at, h) - 5.0 * np.cos(5.0 * at)).max() for h in (0.2, 0.1, 0.05)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2.0, abs=0.1)


def test_tangent_of_a_noisy_line_is_quieter_than_that_of_its_segments() -> None:
    x = np.linspace(0.0, 0.03, 101)
    load = 8250.0 * x + np.random.default_rng(1).normal(0.0, 0.5, 101)
    curve = StiffnessCurve(model="noise", orientation_deg=None, deflection=x, load=load)
    ours = np.abs(tangent_stiffness(curve, x, 0.003)[10:-10] - 8250.0).max()
    assert ours < 0.2 * np.abs(np.diff(load) / np.diff(x) - 8250.0).max()


def test_work_of_a_line_between_two_loads_is_exact() -> None:
    d = np.array([0.0, 0.004, 0.009, 0.03])
    line = StiffnessCurve(model="line", orientation_deg=None, deflection=d, load=8000.0 * d)
    assert work_between(line, 0.0, 160.0) == pytest.approx(0.5 * 160.0 * 0.02, rel=1e-14)
    assert work_between(line, 80.0, 160.0) == pytest.approx(0.5 * 160.0 * 0.02 - 0.5 * 80.0 * 0.01, rel=1e-14)
    with pytest.raises(InputError, match="outside the curve"):
        work_between(line, 0.0, 500.0)


def test_work_of_a_parabola_is_reached_with_second_order() -> None:
    load = A * 0.02 + B * 0.02**2
    exact = 0.5 * A * 0.02**2 + B * 0.02**3 / 3.0
    errors = [work_between(_curve(np.linspace(0.0, 0.03, n + 1)), 0.0, load) - exact for n in (6, 12, 24)]
    for coarse, fine in pairwise(errors):
        assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.05)


def test_a_pair_of_unequal_grids() -> None:
    pair = compared(_measured(_curve(_uneven(40), 1.1)), _measured(_curve(_uneven(61, 0.025))))
    assert pair.metrics.end == 0.025
    assert pair.metrics.relative_l2 == pytest.approx(0.1, rel=2e-3)
    assert pair.tangents.largest == pytest.approx(0.1 * (A + 2.0 * B * 0.025), rel=1e-3)
    assert pair.tangents.at == pytest.approx(0.025)
    assert pair.tangents.share == pytest.approx(0.1, rel=1e-3)
    assert pair.tangents.relative_l2 == pytest.approx(0.1, rel=1e-3)
    assert pair.energies is not None
    assert pair.energies.high == pytest.approx(A * 0.025 + B * 0.025**2)
    assert pair.energies.reference == pytest.approx(0.5 * A * 0.025**2 + B * 0.025**3 / 3.0, rel=1e-3)
    assert pair.energies.work < pair.energies.reference  # the stiffer curve stores less to the same load
    assert pair.judgement.outcome == "not judged"


def test_energy_goes_to_the_load_asked_for_and_starts_where_both_curves_have_begun() -> None:
    whole, late = _curve(_uneven(40)), _curve(np.linspace(0.005, 0.03, 30))
    pair = compared(_measured(late), _measured(whole), max_load=150.0)
    assert pair.energies is not None
    assert (pair.energies.low, pair.energies.high) == (late.load[0], 150.0)
    assert pair.energies.work == pytest.approx(pair.energies.reference, rel=1e-3)


def test_curves_that_never_carry_a_common_load_have_no_energy() -> None:
    d = np.linspace(0.0, 0.01, 5)
    low = StiffnessCurve(model="low", orientation_deg=None, deflection=d, load=1000.0 * d)
    high = StiffnessCurve(model="high", orientation_deg=None, deflection=d, load=50.0 + 1000.0 * d)
    assert compared(_measured(low), _measured(high)).energies is None


def test_kinds_of_deformation_are_not_mixed_but_compared_each_with_its_own() -> None:
    one, two = _curve(_uneven(9)), _curve(_uneven(12))
    with pytest.raises(InputError, match="neither follows from the other"):
        compared(_measured(one), _measured(two, "change of diameter"))
    assert compared(_measured(one, "change of diameter"), _measured(two, "change of diameter")).metrics.end == 0.03


@pytest.mark.parametrize(
    ("difference", "uncertainty", "tolerance", "outcome"),
    [
        (0.04, None, 0.05, "passed"),
        (0.06, None, 0.05, "failed"),
        (0.04, 0.005, 0.05, "passed"),
        (0.04, 0.02, 0.05, "undecided"),
        (0.06, 0.02, 0.05, "undecided"),
        (0.08, 0.02, 0.05, "failed"),
        (0.0, 0.06, 0.05, "undecided"),
        (0.08, 0.02, None, "not judged"),
    ],
)
def test_outcome(difference: float, uncertainty: float | None, tolerance: float | None, outcome: str) -> None:
    found = judged(difference, uncertainty, tolerance)
    assert found.outcome == outcome
    assert ("more than the tolerance" in found.why) == (uncertainty == 0.06)


def test_uncertainties_of_both_curves_are_combined_and_bound_the_change_of_the_norm() -> None:
    curve, reference = _curve(_uneven(40), 1.08), _curve(_uneven(40))
    pair = compared(_measured(curve, share=0.03 / 1.08), _measured(reference, share=0.04), tolerance=0.05)
    assert pair.judgement.uncertainty == pytest.approx(0.05, rel=1e-9)
    assert pair.judgement.outcome == "undecided"
    alone = compared(_measured(curve), _measured(reference, share=0.02), tolerance=0.05).judgement
    assert (alone.uncertainty, alone.outcome) == (pytest.approx(0.02), "failed")
    # what the bound says: a reference anywhere in its band moves the norm by no more
    d = np.linspace(0.0, 0.03, 401)
    for wiggle in (1.02, 0.98, 1.0 + 0.02 * np.sin(400.0 * d)):
        moved = reference.load_at(d) * wiggle
        norm = np.linalg.norm(curve.load_at(d) - moved) / np.linalg.norm(reference.load_at(d))
        assert abs(norm - alone.difference) <= 0.02 + 1e-12


@pytest.mark.parametrize(
    ("ends", "max_load", "outcome", "words"),
    [
        ((0.0002, 0.03), None, "undecided", "mine covers only 0 to 0.2 mm of 0 to 30 mm of mine, less than 50 %"),
        ((0.03, 0.0002), None, "passed", ""),  # the whole of a short reference
        ((0.0149, 0.03), None, "undecided", "only 0 to 14.9 mm"),
        ((0.015, 0.03), None, "passed", ""),
        ((0.012, 0.03), 100.0, "passed", ""),  # 12 of 13.8 mm
        ((0.006, 0.03), 100.0, "undecided", "only 0 to 6 mm of 0 to 13.81 mm"),
        ((0.03, 0.012), 100.0, "passed", ""),  # the reference ends before the load: the whole of it
    ],
)
def test_no_verdict_on_a_sliver_of_the_range(
    ends: tuple[float, float], max_load: float | None, outcome: str, words: str
) -> None:
    curve, reference = (_measured(_curve(np.linspace(0.0, end, 3001))) for end in ends)
    found = compared(curve, reference, max_load, tolerance=0.05).judgement
    assert found.outcome == outcome
    assert words in found.why
    assert bool(found.missing) == (outcome == "undecided")
    silent = compared(curve, reference, max_load).judgement
    assert (silent.outcome, silent.missing) == ("not judged", found.missing)


def test_no_verdict_on_the_ends_of_two_curves_nor_on_a_difference_there() -> None:
    early, late = _curve(np.linspace(0.0, 0.02, 50), 2.0), _curve(np.linspace(0.018, 0.03, 50))
    found = compared(_measured(early), _measured(late), tolerance=0.05).judgement
    assert (found.outcome, "covers only 18 to 20 mm of 18 to 30 mm" in found.why) == ("undecided", True)


def test_negative_control_a_damaged_curve_fails() -> None:
    whole = _curve(_uneven(40))
    damaged = StiffnessCurve(
        model="damaged", orientation_deg=None, deflection=whole.deflection, load=whole.load * (whole.deflection < 0.02)
    )
    assert compared(_measured(whole), _measured(whole), tolerance=0.01).judgement.outcome == "passed"
    pair = compared(_measured(damaged), _measured(whole, share=0.02), tolerance=0.01)
    assert pair.judgement.outcome == "failed"
    assert pair.tangents.largest > 10.0 * A
    assert compare_curves(damaged, whole).relative_l2 == pair.metrics.relative_l2
