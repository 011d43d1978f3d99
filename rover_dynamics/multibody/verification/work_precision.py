"""Work and precision on the IFToMM problems A01 to A03: error of a motion against what it cost, by both kinds of steps.

Errors are the largest over the problem's times: of the bob and of point B0 [m], and of the squeezer's seven rates, over
the larger of one and their size [-]. Verified by tests/verification/test_multibody_benchmarks.py.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from contracts.published import published_table
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.motion import ImplicitSteps, Motion, StepControl, integrate
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.multibody.verification.andrews import andrews_rates, andrews_squeezer
from rover_dynamics.multibody.verification.mechanisms import (
    mechanical_energy,
    n_four_bar,
    pendulum,
    tip_of_four_bar,
)

__all__ = ["PROBLEMS", "Problem", "Work", "compile_loops", "control_for", "one_angle", "one_angle_error", "work"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Problem:
    """A motion with a known answer.

    Attributes
    ----------
    title : for tables
    unit : of the error
    model, times : the mechanism, and when it is looked at [s]
    error : of a motion at these times
    energy : that the error of the energy is related to [J]; None where a motor works
    """

    title: str
    unit: str
    model: Callable[[], MultibodyModel]
    times: tuple[float, ...]
    error: Callable[[Motion], float]
    energy: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Work:
    """One motion.

    Attributes
    ----------
    error : see `Problem`
    energy : largest change of the mechanical energy over the problem's, None where a motor works [-]
    seconds : processor time without the model's set-up [s]
    steps, evaluations : see `motion.Motion`
    """

    error: float
    energy: float | None
    seconds: float
    steps: int
    evaluations: int


def control_for(method: str, allowed: float) -> StepControl | ImplicitSteps:
    """``"explicit"`` or ``"implicit"`` steps with this error allowed in each.

    For explicit ones it is the relative error [-] and the absolute one of y [SI], for implicit ones that of the joints
    [m, rad].
    """
    if method == "explicit":
        return StepControl(relative=allowed, absolute=allowed)
    return ImplicitSteps(tolerance=allowed, first=1e-5, longest=0.1)


def work(problem: Problem, control: StepControl | ImplicitSteps) -> Work:
    """Integrate a problem in joint coordinates and measure."""
    model = problem.model()
    equations = TreeCoordinates(model)
    begun = time.process_time()
    motion = integrate(equations, np.array(problem.times), control)
    seconds = time.process_time() - begun
    drift = None
    if problem.energy is not None:
        energies = [mechanical_energy(model, state) for state in motion.states]
        drift = float(np.ptp(energies)) / problem.energy
    return Work(
        error=problem.error(motion),
        energy=drift,
        seconds=seconds,
        steps=motion.steps,
        evaluations=motion.evaluations,
    )


def compile_loops(problem: Problem, control: StepControl | ImplicitSteps) -> None:
    """A millisecond of a problem, so that times measured later hold no compiling."""
    integrate(TreeCoordinates(problem.model()), np.array([0.0, 1e-3]), control)


def one_angle(windows: int, times: FloatArray, allowed: float = 1e-13) -> FloatArray:
    """Point B0 of the N-four-bar, (n, 2) [m]: a parallelogram has one angle, integrated by DOP853 alone.

    theta'' = g (h / m) sin(theta), with h = (N + 1) / 2 + N and m = (N + 1) / 3 + N for rods of 1 kg and 1 m.
    """
    ratio = 9.81 * ((windows + 1) / 2 + windows) / ((windows + 1) / 3 + windows)
    span, start = (0.0, float(times[-1])), (0.0, 1.0)
    found = solve_ivp(
        lambda _t, y: (y[1], ratio * np.sin(y[0])),
        span,
        start,
        method="DOP853",
        t_eval=times,
        rtol=allowed,
        atol=allowed,
    )
    return np.stack([np.sin(found.y[0]), np.cos(found.y[0])], axis=1)


def one_angle_error(windows: int, allowed: float) -> float:
    """Error of `one_angle` itself over ten seconds: what the problem makes of errors of steps, without any loop [m]."""
    times = np.array(_TEN_SECONDS)
    return float(np.max(np.abs(one_angle(windows, times, allowed) - one_angle(windows, times))))


def _pendulum_error(motion: Motion) -> float:
    table = published_table("iftomm_pendulum")
    found = np.array([state.positions[0, :2] for state in motion.states])
    return float(np.max(np.abs(found - np.stack([table["x"], table["y"]], axis=1))))


def _four_bar_error(windows: int) -> Callable[[Motion], float]:
    def error(motion: Motion) -> float:
        found = np.array([tip_of_four_bar(state)[:2] for state in motion.states])
        return float(np.max(np.abs(found - one_angle(windows, motion.times))))

    return error


def _andrews_error(motion: Motion) -> float:
    table, rates = published_table("andrews_squeezer"), andrews_rates(motion.states[-1])
    published = table["ydot_ref_t0.03"]
    found = np.array([rates[name] for name in table.text("name")])
    return float(np.max(np.abs(found - published) / np.maximum(np.abs(published), 1.0)))


_TEN_SECONDS = tuple(published_table("iftomm_four_bar")["t"].tolist())


def _four_bars(windows: int) -> Problem:
    return Problem(
        title=f"A02 four-bar, N = {windows}",
        unit="m",
        model=lambda: n_four_bar(windows),
        times=_TEN_SECONDS,
        error=_four_bar_error(windows),
        energy=9.81 * ((windows + 1) / 2 + windows) + 0.5 * ((windows + 1) / 3 + windows),
    )


PROBLEMS: Mapping[str, Problem] = MappingProxyType(
    {
        "pendulum": Problem(
            title="A01 pendulum",
            unit="m",
            model=pendulum,
            times=tuple(published_table("iftomm_pendulum")["t"].tolist()),
            error=_pendulum_error,
            energy=9.81,
        ),
        "four_bar_2": _four_bars(2),
        "four_bar_40": _four_bars(40),
        "andrews": Problem(
            title="A03 Andrews' squeezer", unit="-", model=andrews_squeezer, times=(0.0, 0.03), error=_andrews_error
        ),
    }
)
