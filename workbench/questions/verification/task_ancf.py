"""Tasks of the plates' verification: benchmarks with known answers, each with a damaged copy as control.

They depend on ANCF plates alone, not on the study, so that every study shares their stored results. Meshes are those of
tests/verification. Verified by tests/end_to_end/test_verification.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, astuple
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ancf_reduced.plates.model import PoissonLocking
from ancf_reduced.verification import arch, cantilever, frames, frequencies, self_weight
from ancf_reduced.verification.cantilever import EndLoad, cantilever_path, cantilever_table
from ancf_reduced.verification.narrow_cantilever import BentCantilever, bent_cantilever
from ancf_reduced.verification.pendulum import pendulum_fall
from ancf_reduced.verification.plate_matrices import misread_shape, plate_errors
from workbench.questions.verification.benchmark_runs import Numbers, Runs, run_with_control

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["run_benchmark"]

_POISSON_RATIO = 0.33
_STEP, _LONG_STEP = 0.125, 0.5
"""Of the longest stable one."""


def run_benchmark(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Run ``inputs["benchmark"]`` and its negative control: ``result.json`` with what was measured."""
    return run_with_control(_BENCHMARKS, inputs["benchmark"], out, progress)


def _pendulum() -> Numbers:
    fine, coarse = pendulum_fall(fraction=_STEP), pendulum_fall(fraction=_LONG_STEP)
    return {
        "time_s": fine.time.tolist(),
        "corner_m": fine.corner.tolist(),
        "published_m": fine.published.tolist(),
        "distance_m": {"1/2": coarse.distance.tolist(), "1/8": fine.distance.tolist()},
        "error_m": fine.error,
        "energy_spread": fine.energy_spread,
        "energy_order": float(np.log(coarse.energy_spread / fine.energy_spread) / np.log(_LONG_STEP / _STEP)),
    }


def _self_weight() -> Numbers:
    plates = {n: self_weight.hanging_plate(n) for n in (8, 16, 32)}
    finest = plates[32]
    return {
        "drop_m": [finest.drop, self_weight.DROP],
        "tip_x_m": [finest.tip_x, self_weight.TIP_X],
        "iterations": finest.iterations,
    } | _convergence(lambda n: plates[n].error, list(plates))


def _bending() -> Numbers:
    def pair(found: BentCantilever) -> list[float]:
        return [found.deflection, found.expected]

    relieved = {n: bent_cantilever(_POISSON_RATIO, PoissonLocking.RELIEVED, n) for n in (8, 16, 32)}
    return {
        "relieved_m": pair(relieved[32]),
        "held_flat_m": pair(bent_cantilever(_POISSON_RATIO, PoissonLocking.RELIEVED, held_flat=True)),
        "straight_m": pair(bent_cantilever(0.0, PoissonLocking.AS_IS)),
    } | _convergence(lambda n: abs(relieved[n].ratio - 1.0), list(relieved))


def _end_load(load: EndLoad, plates: Sequence[int]) -> Numbers:
    paths = {n: cantilever_path(load, n) for n in plates}
    finest = paths[plates[-1]]
    way = int(np.argmax(finest.expected[-1]))  # the shear deflects most, the moment shortens most
    return {
        "load": finest.load.tolist(),
        "deflection": finest.deflection.tolist(),
        "table": cantilever_table(load).tolist(),
        "full": [float(finest.deflection[-1, way]), float(finest.expected[-1, way])],
        "path_error": finest.error,
        "iterations": finest.iterations,
    } | _convergence(lambda n: paths[n].error, plates)


def _end_shear_damaged() -> float:
    return cantilever_path("shear", 32, thickness=1.02 * cantilever.THICKNESS).error


def _end_moment_damaged() -> float:
    """It cannot roll the strip up; a quarter of the way is far enough to see it."""
    return cantilever_path("moment", 24, (0.05, 0.1, 0.15, 0.2, 0.25), follows=False).error


def _frames() -> Numbers:
    found = {name: frames.loaded_frame(angles) for name, angles in frames.FRAMES.items()}
    return {"drop_m": {name: [frame.drop, frame.expected] for name, frame in found.items()}}


def _frame_damaged() -> float:
    frame = frames.loaded_frame(frames.FRAMES["L"], thickness=1.02 * frames.THICKNESS)
    return abs(frame.drop / frame.expected - 1.0)


def _frequencies() -> Numbers:
    straight = frequencies.cantilever_frequencies()
    rings = {n: frequencies.ring_frequencies(n) for n in (12, 24, 48)}
    return {
        "cantilever_Hz": [straight.found.tolist(), straight.expected.tolist()],
        "ring_Hz": [rings[48].found[[0, 2]].tolist(), rings[48].expected[[0, 2]].tolist()],
        "ring_error": rings[48].error,
    } | _convergence(lambda n: rings[n].error, list(rings))


def _ring_damaged() -> float:
    ring = frequencies.ring_frequencies(thickness=1.02 * frequencies.RING_THICKNESS)
    return float(np.abs(ring.found / ring.expected - 1.0).min())


def _arch() -> Numbers:
    arches = {n: arch.pressed_arch(n) for n in (8, 16, 32)}
    first, second, third = (found.stiffness for found in arches.values())
    return {
        "stiffness_N_per_m": [third, arches[32].beam],
        "meshes": {f"{n} plates": found.error for n, found in arches.items()},
        "order": float(np.log2((first - second) / (second - third))),
    }


def _convergence(error: Callable[[int], float], plates: Sequence[int]) -> Numbers:
    """Errors by number of plates, each twice the one before, and the smallest order between two of them."""
    errors = np.array([error(n) for n in plates])
    return {
        "meshes": {f"{n} plates": float(e) for n, e in zip(plates, errors, strict=True)},
        "order": float(np.log2(errors[:-1] / errors[1:]).min()),
    }


_BENCHMARKS: Runs = {
    "ancf_plate": (lambda: asdict(plate_errors()), lambda: min(astuple(plate_errors(shape=misread_shape())))),
    "ancf_pendulum": (_pendulum, lambda: pendulum_fall((4, 4, 2), _STEP).error),
    "ancf_self_weight": (_self_weight, lambda: self_weight.hanging_plate(young_modulus=0.99 * self_weight.YOUNG).error),
    "ancf_bending": (_bending, lambda: abs(bent_cantilever(_POISSON_RATIO, PoissonLocking.AS_IS).ratio - 1.0)),
    "ancf_end_shear": (lambda: _end_load("shear", (8, 16, 32)), _end_shear_damaged),
    "ancf_end_moment": (lambda: _end_load("moment", (12, 24, 48)), _end_moment_damaged),
    "ancf_frames": (_frames, _frame_damaged),
    "ancf_frequencies": (_frequencies, _ring_damaged),
    "ancf_arch": (_arch, lambda: arch.pressed_arch(thickness=0.96 * arch.THICKNESS).error),
}
