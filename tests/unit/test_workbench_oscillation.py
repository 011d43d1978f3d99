"""Period and spectrum of series whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.errors import InputError
from workbench.questions.rover.oscillation import period, ripple, spectrum

TIME = np.linspace(0.0, 30.0, 301)


def test_the_period_of_a_sum_of_harmonics_is_found_between_the_samples() -> None:
    phase = 2.0 * np.pi * TIME / 11.517
    values = 26.0 + 2.0 * np.cos(phase) + 0.7 * np.sin(2.0 * phase)
    assert period(TIME, values, 5.0) == pytest.approx(11.517, rel=2e-3)


def test_what_does_not_repeat_is_refused() -> None:
    """Negative control: a line never comes back to where it was."""
    with pytest.raises(InputError, match="is the end of what was tried"):
        period(TIME, 2.0 * TIME, 5.0)


def test_the_spectrum_shows_a_sine_on_a_smooth_course() -> None:
    time = np.linspace(0.0, 2.0, 401)
    values = 24.0 + 3.0 * time - time**2 + 1.5 * np.sin(2.0 * np.pi * 20.0 * time)
    frequency, amplitude = spectrum(time, values)
    assert frequency[amplitude.argmax()] == pytest.approx(20.0, abs=0.3)
    assert amplitude.max() == pytest.approx(1.5, rel=0.02)
    assert np.std(ripple(time, values)) == pytest.approx(1.5 / np.sqrt(2.0), rel=0.02)
