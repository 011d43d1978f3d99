"""What a motion of one ANCF wheel came to, as its task writes it.

Verified by tests/unit/test_workbench_ancf_dynamics.py.
"""

from __future__ import annotations

from dataclasses import dataclass

from ancf_reduced.motion.energy_account import EnergyRow

__all__ = ["MotionNumbers"]


@dataclass(frozen=True, slots=True, kw_only=True)
class MotionNumbers:
    """Numbers of the explicit integration, and of the implicit one where it was asked for.

    Attributes
    ----------
    closure : spread of the energy account over the largest energy that changes hands [-]; None if it stopped
    energies : the account at the end
    lowest_m : lowest height of the hub above the ground [m]
    largest_load_N : of the ground on the wheel, upward [N]
    step_s : time step [s]
    stopped : why it ended before its time; None if it did not
    end_s : when it ended [s]
    viscosity : of the plates [Pa s]
    implicit_difference_m : largest difference of the hub's height between both integrators [m]
    implicit_steps : adaptive steps of the implicit one
    """

    closure: float | None
    energies: EnergyRow
    lowest_m: float
    largest_load_N: float
    step_s: float
    stopped: str | None
    end_s: float
    viscosity: float
    implicit_difference_m: float | None = None
    implicit_steps: int | None = None
