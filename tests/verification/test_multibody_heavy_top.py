"""Claim: a heavy top moves as Lagrange's closed form says, in coordinates chosen anew as it turns.

Source: `verification/heavy_top.py` (elliptic functions, derived there), and joint coordinates. The fast top is that of
the literature on Lie group integrators (numbers from memory). Tolerances: 2e-6 m where 1e-9 is allowed in a step (the
top that precesses turns by 20 rad); a choice of coordinates leaves state and rates as they are, to 1e-9 of the largest.
Negative controls: with the coordinates of the start kept for good the motion ends; another spin is seen.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.errors import ConvergenceError
from rover_dynamics.multibody.formulation import AbsoluteCoordinates
from rover_dynamics.multibody.motion import Motion, StepControl, integrate
from rover_dynamics.multibody.partitioned_coordinates import PartitionedCoordinates
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.multibody.verification.heavy_top import HeavyTop
from rover_dynamics.multibody.verification.mechanisms import mechanical_energy

FAST = HeavyTop(mass=15.0, arm=1.0, along=0.46875, across=0.234375, spin=150.0, precession=-4.61538)
PRECESSING = HeavyTop(mass=15.0, arm=2.0, along=0.46875, across=0.234375, spin=1.0, precession=-20.0)
TOPS = {"fast": (FAST, np.linspace(0.0, 0.2, 5)), "precessing": (PRECESSING, np.linspace(0.0, 1.0, 5))}
CONTROL = StepControl(relative=1e-9, absolute=1e-9)
Make = type[AbsoluteCoordinates] | type[TreeCoordinates]


def error(top: HeavyTop, motion: Motion) -> float:
    heights = np.array([state.positions[0, 2] for state in motion.states])
    return float(np.max(np.abs(heights - top.heights(motion.times))))


class Watched(PartitionedCoordinates):
    """Notes each change of the dependent velocities, and how much it changes rates and corrected state."""

    def accepted(self, t: float, y: np.ndarray, course: object) -> None:
        before, found = self.dependent, (self.rates(t, y), self.corrected(t, y))
        super().accepted(t, y, None)
        if np.array_equal(before, self.dependent):
            return
        after = self.rates(t, y), self.corrected(t, y)
        jumps = [np.max(np.abs(a - b)) / np.max(np.abs(b)) for a, b in zip(after, found, strict=True)]
        self.jumps = [*getattr(self, "jumps", []), max(jumps)]


@pytest.mark.parametrize("name", TOPS)
@pytest.mark.parametrize("make", [AbsoluteCoordinates, PartitionedCoordinates, TreeCoordinates])
def test_height_is_that_of_elliptic_functions(make: Make, name: str) -> None:
    top, times = TOPS[name]
    motion = integrate(make(top.model()), times, CONTROL)
    assert error(top, motion) < 2e-6
    energies = [mechanical_energy(top.model(), state) for state in motion.states]
    np.testing.assert_allclose(energies, energies[0], rtol=1e-7)


def test_the_choice_of_coordinates_changes_often_and_the_motion_not_at_all() -> None:
    top, times = TOPS["precessing"]
    formulation = Watched(top.model())
    motion = integrate(formulation, times, CONTROL)
    assert len(formulation.jumps) > 5
    assert max(formulation.jumps) < 1e-9
    assert error(top, motion) < 2e-6


def test_negative_control_coordinates_of_the_start_kept_for_good(monkeypatch: pytest.MonkeyPatch) -> None:
    top, times = TOPS["precessing"]
    formulation = PartitionedCoordinates(top.model())
    monkeypatch.setattr(formulation, "_divide", lambda *_: None)
    with pytest.raises(ConvergenceError, match="independent coordinates do not determine the others"):
        integrate(formulation, times, CONTROL)


def test_negative_control_another_spin_is_seen() -> None:
    top, times = TOPS["fast"]
    motion = integrate(TreeCoordinates(top.model()), times, CONTROL)
    assert error(replace(top, spin=1.001 * top.spin), motion) > 1e-4
