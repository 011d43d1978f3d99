"""The thesis' two statements on made-up curves: where the brush leaves the average, where the ANCF tire lies."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from workbench.questions.models.thesis_order import leaves, over_the_sweep, secants

D = np.linspace(0.0, 0.04, 41)


def _curve(load: np.ndarray[tuple[int], np.dtype[np.float64]]) -> StiffnessCurve:
    return StiffnessCurve(model="x", orientation_deg=None, deflection=D, load=load)


SOFTENING = _curve(8250.0 * D * (1.0 - 4.0 * D))
LINE = _curve(8250.0 * D)


def test_a_line_leaves_what_softens_where_it_is_five_per_cent_above() -> None:
    """1 / (1 - 4 d) = 1.05 at d = 11.9 mm."""
    first, *_, last = secants(SOFTENING, LINE, None)
    assert (first.deflection, first.average) == (0.005, pytest.approx(8250.0 * 0.98))
    assert (first.brush, last.brush) == (pytest.approx(1 / 0.98 - 1), pytest.approx(1 / 0.88 - 1))
    assert first.ancf is None
    found = leaves(SOFTENING, LINE)
    assert found is not None
    assert found[0] == pytest.approx(0.0119, abs=2e-4)
    assert found[1] == pytest.approx(float(SOFTENING.load_at(found[0])))


def test_what_follows_leaves_nowhere() -> None:
    assert leaves(SOFTENING, _curve(1.04 * SOFTENING.load)) is None
    assert over_the_sweep(SOFTENING, _curve(1.04 * SOFTENING.load)) == (pytest.approx(0.04), pytest.approx(0.04))
    low, high = over_the_sweep(SOFTENING, LINE) or (0.0, 0.0)
    assert 0.05 < low < high


def test_what_ends_before_is_not_reached() -> None:
    short = StiffnessCurve(model="x", orientation_deg=None, deflection=D[:21], load=LINE.load[:21])  # 20 mm, 165 N
    assert [one.average is None for one in secants(short, LINE, None)] == [False, False, False, True]
    assert over_the_sweep(short, LINE) is None
    early = StiffnessCurve(model="x", orientation_deg=None, deflection=D[:4], load=LINE.load[:4])
    assert leaves(early, LINE) is None
