"""Turning points and rainflow: the standard's example, whatever lies between its points, and small cycles left out."""

from __future__ import annotations

import numpy as np
import pytest

from workbench.questions.traverse.counting import counted, turning_points

EXAMPLE = np.array([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0])
"""ASTM E1049-85, Fig. 6, from memory; its count below, too."""
COUNT = {3: 0.5, 4: 1.5, 6: 0.5, 8: 1.0, 9: 0.5}


def test_the_standards_example() -> None:
    assert {k: n for k, n in enumerate(counted(EXAMPLE.tolist(), 1.0)) if n} == COUNT


def test_points_between_and_ripples_below_the_gate_change_nothing() -> None:
    t = np.linspace(0.0, 8.0, 4001)
    dense = np.interp(t, np.arange(9.0), EXAMPLE)
    np.testing.assert_allclose(turning_points(dense, 0.2), EXAMPLE)
    rippled = turning_points(dense + 0.05 * np.sin(40.0 * np.pi * t), 0.2)
    np.testing.assert_allclose(rippled, EXAMPLE, atol=0.06)
    seen = turning_points(dense + 0.05 * np.sin(40.0 * np.pi * t), 1e-3)
    assert len(seen) > 100  # a smaller gate lets the ripples through


@pytest.mark.parametrize("series", [[3.0], [3.0, 3.0, 3.0], [3.0, 3.05, 2.98]])
def test_what_does_not_move_has_no_cycle(series: list[float]) -> None:
    points = turning_points(np.array(series), 0.1)
    assert points == [3.0]
    assert counted(points, 1.0) == []


def test_a_range_on_the_edge_of_two_bins_counts_in_the_upper_one() -> None:
    assert counted([0.0, 0.3, 0.0], 0.1) == [0.0, 0.0, 0.0, 1.0]
