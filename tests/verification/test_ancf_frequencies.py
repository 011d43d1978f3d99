"""Claim: natural frequencies of a cantilever and of a free ring of plates follow the closed forms to 0.5 %.

Sources: Euler-Bernoulli cantilever; free thin ring bending in its plane (Love 1944, art. 293); the model is
ancf_reduced/verification/frequencies.py, where what the closed forms leave out stays below 0.1 % and 0.4 %. Convergence
of the ring is of order 4 over 12, 24, 48 plates. It is slow because curved plates lock: their mid-surface cannot bend
without stretching (12 plates are 58 % too high, and with a thickness of 1 % of the radius nine times too high).
Negative control: 2 % more thickness.
"""

from __future__ import annotations

import functools

import numpy as np
import pytest

from ancf_reduced.verification.frequencies import (
    RING_THICKNESS,
    THICKNESS,
    cantilever_frequencies,
    ring_frequencies,
)

cantilever, ring = functools.cache(cantilever_frequencies), functools.cache(ring_frequencies)


def test_cantilever() -> None:
    assert cantilever(16).error < 5e-3
    assert cantilever(24).error < 3e-3
    assert cantilever(4).error > 3.0 * cantilever(8).error


def test_free_ring() -> None:
    assert ring(48).rigid < 1e-3
    assert ring(48).error < 5e-3
    assert np.log2(ring(12).error / ring(24).error) > 3.5


def test_a_thicker_strip_is_caught() -> None:
    """Negative control: 2 % of thickness is 2 % of frequency."""
    thicker = cantilever(16, 1.02 * THICKNESS)
    assert thicker.found[0] / thicker.expected[0] == pytest.approx(1.02, abs=2e-3)
    thicker = ring(48, 1.02 * RING_THICKNESS)
    assert np.abs(thicker.found / thicker.expected - 1.0).min() > 0.01
