"""Grid convergence index.

Claim: the three examples of Celik et al. 2008 (Table 1: convergence, order below 1, oscillation) come out as printed,
and made-up series with a known order and limit are recovered exactly. Tolerance: the paper's rounding. Negative
control: a series that does not converge has no order and gets the large index.
"""

from __future__ import annotations

import pytest

from contracts.errors import InputError
from workbench.questions.mesh_study.grid_convergence import apparent_order, grid_convergence

CELIK = {
    "monotonic, p 1.53": ((6.063, 5.972, 5.863), (1.5, 4.0 / 3.0), 1.53, 6.1685, 1.5, 1.7, 2.2),
    "monotonic, p 0.75": ((10.7880, 10.7250, 10.6050), (2.0, 2.143), 0.75, 10.8801, 0.6, 0.9, 1.1),
    "oscillatory, p 1.51": ((6.0042, 5.9624, 6.0909), (2.0, 2.143), 1.51, 6.0269, 0.7, 0.4, 0.5),
}
"""Loads, ratios -> p, extrapolated value, approximate and extrapolated error and index in percent."""


@pytest.mark.parametrize("name", CELIK)
def test_the_paper_s_examples(name: str) -> None:
    values, (r21, r32), p, limit, approximate, extrapolated, index = CELIK[name]
    found = grid_convergence(values, (1.0, r21, r21 * r32))
    assert found.behaviour == name.partition(",")[0]
    assert found.order == found.apparent_order == pytest.approx(p, abs=0.006)
    assert found.extrapolated == pytest.approx(limit, abs=6e-5)
    assert 100.0 * found.approximate_error == pytest.approx(approximate, abs=0.051)
    assert found.extrapolated_error is not None
    assert 100.0 * found.extrapolated_error == pytest.approx(extrapolated, abs=0.06)
    assert 100.0 * found.index_fine == pytest.approx(index, abs=0.051)


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0, 4.0])
@pytest.mark.parametrize("sizes", [(1.0, 2.0, 4.0), (1.0, 1.1, 3.3), (1.0, 3.0, 3.3)])
def test_a_series_with_one_error_term_is_recovered(order: float, sizes: tuple[float, float, float]) -> None:
    """Also where the paper's own fixed-point iteration diverges: r32 much larger than r21."""
    values = [10.0 - 0.1 * size**order for size in sizes]
    found = grid_convergence(values, sizes)
    assert found.apparent_order == pytest.approx(order, rel=1e-8)
    assert found.extrapolated == pytest.approx(10.0, rel=1e-9)
    indices = (found.index_fine, found.index_medium, found.index_coarse)
    assert indices == pytest.approx([1.25 * abs((10.0 - v) / v) for v in values], rel=1e-7)


@pytest.mark.parametrize("order", [0.5, 6.0])
def test_an_order_that_is_not_credible_is_replaced_by_two_with_factor_three(order: float) -> None:
    values = [10.0 - 0.001 * size**order for size in (1.0, 2.0, 4.0)]
    free, doubted = (grid_convergence(values, (1.0, 2.0, 4.0), range_) for range_ in (None, (1.0, 4.0)))
    assert (free.order, free.safety) == (pytest.approx(order), 1.25)
    assert (doubted.apparent_order, doubted.order, doubted.safety) == (pytest.approx(order), 2.0, 3.0)
    assert doubted.index_fine == pytest.approx(3.0 * abs(values[1] - values[0]) / values[0] / 3.0)
    assert doubted.index_medium == pytest.approx(3.0 * abs(values[2] - values[1]) / values[1] / 3.0)
    assert doubted.extrapolated is not None
    assert doubted.index_coarse == pytest.approx(3.0 * abs(values[2] - doubted.extrapolated) / values[2])


def test_a_credible_order_is_used_and_an_oscillation_is_not() -> None:
    smooth = grid_convergence([10.0 - 0.001 * size**2 for size in (1.0, 2.0, 4.0)], (1.0, 2.0, 4.0), (1.0, 4.0))
    assert (smooth.order, smooth.safety) == (pytest.approx(2.0), 1.25)
    values, (r21, r32), *_ = CELIK["oscillatory, p 1.51"]
    found = grid_convergence(values, (1.0, r21, r21 * r32), (1.0, 4.0))
    assert (found.behaviour, found.order, found.safety) == ("oscillatory", 2.0, 3.0)


@pytest.mark.parametrize("values", [(10.0, 9.0, 9.5), (10.0, 9.0, 8.5), (10.0, 9.0, 8.0), (10.0, 9.0, 9.0)])
def test_a_series_that_does_not_settle_has_no_order_and_a_large_index(values: tuple[float, float, float]) -> None:
    found = grid_convergence(values, (1.0, 2.0, 4.0))
    assert (found.behaviour, found.order, found.extrapolated) == ("divergent", None, None)
    assert found.index_fine == pytest.approx(3.0 * (max(values) - min(values)) / 10.0)


def test_an_oscillating_series_leaves_no_coarser_mesh_with_less_than_half_its_range() -> None:
    found = grid_convergence((54.100, 54.075, 54.209), (1.0, 1.12, 1.87))
    assert found.behaviour == "oscillatory"
    assert found.index_medium == pytest.approx(0.067 / 54.075)
    assert found.index_coarse >= 0.067 / 54.209


def test_unequal_ratios_decide_what_converges() -> None:
    """Differences of one ratio's logarithm are those of order 0, whatever their size."""
    assert apparent_order(1.0, 1.2, 2.0, 1.3)[0] == "monotonic"
    assert apparent_order(1.0, 1.2, 1.3, 2.0)[0] == "divergent"


def test_equal_medium_and_fine_values_leave_no_error() -> None:
    found = grid_convergence((10.0, 10.0, 9.9), (1.0, 2.0, 4.0), (1.0, 4.0))
    assert (found.behaviour, found.order, found.index_fine) == ("monotonic", 2.0, 0.0)
    assert found.index_coarse == pytest.approx(3.0 * 0.1 / 9.9)


@pytest.mark.parametrize(
    ("values", "sizes", "word"),
    [
        ((1.0, 2.0), (1.0, 2.0), "three"),
        ((1.0, 2.0, 3.0), (1.0, 1.0, 2.0), "increase"),
        ((0.0, 1.0, 2.0), (1.0, 2.0, 4.0), "not zero"),
        ((float("nan"), 1.0, 2.0), (1.0, 2.0, 4.0), "finite"),
    ],
)
def test_bad_input_is_refused(values: tuple[float, ...], sizes: tuple[float, ...], word: str) -> None:
    with pytest.raises(InputError, match=word):
        grid_convergence(values, sizes)
