"""The report's verification of ANCF plates: lines that fail where a number is off."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from typing import Any

import pytest

from workbench.questions.verification.checks_ancf import ANCF_BENCHMARKS
from workbench.questions.verification.figures import ancf_verification_figures
from workbench.questions.verification.lines import benchmark_lines
from workbench.questions.verification.question import ModelVerification

type Results = dict[str, dict[str, Any]]

MESHES = {"meshes": {"8 plates": 0.07, "16 plates": 7.5e-3}, "order": 3.2}
PATH = MESHES | {
    "load": [0.5, 1.0],
    "deflection": [[1.0, 2.0], [2.0, 3.001]],
    "table": [[0.5, 1.0, 2.0], [1.0, 2.0, 3.0]],
    "full": [3.001, 3.0],
    "path_error": 3e-4,
    "iterations": 112,
    "damaged": 0.1,
}
MEASURED: Results = {
    "ancf_plate": {"mass": 1e-15, "gravity": 2e-15, "elastic_force": 4e-13, "damaged": 0.02},
    "ancf_pendulum": {
        "time_s": [0.2, 0.4],
        "corner_m": [[0.6, 0.3, -0.2], [0.5, 0.3, -0.5]],
        "published_m": [[0.6, 0.3, -0.2], [0.5, 0.3, -0.5]],
        "distance_m": {"1/2": [1e-6, 1e-5], "1/8": [1e-7, 6e-7]},
        "error_m": 6e-7,
        "energy_spread": 5e-7,
        "energy_order": 1.97,
        "damaged": 2e-4,
    },
    "ancf_self_weight": MESHES | {"drop_m": [0.0402823, 0.0403175], "tip_x_m": [0.498141, 0.498138], "damaged": 9e-3},
    "ancf_bending": MESHES
    | {"relieved_m": [0.01799, 0.01799], "held_flat_m": [0.016, 0.016], "straight_m": [0.01799, 0.01799]}
    | {"damaged": 0.11},
    "ancf_end_shear": PATH,
    "ancf_end_moment": PATH,
    "ancf_frames": {"drop_m": {"L": [2e-4, 2e-4], "skew T": [1e-4, 1e-4]}, "damaged": 0.057},
    "ancf_frequencies": MESHES
    | {"cantilever_Hz": [[11.34, 71.2], [11.34, 71.0]], "ring_Hz": [[69.4, 196.1], [69.2, 195.8]]}
    | {"order": 3.9, "ring_error": 2.3e-3, "damaged": 0.018},
    "ancf_arch": MESHES | {"stiffness_N_per_m": [2788.0, 2754.0], "order": 1.8, "damaged": 0.1},
}


def measured() -> Results:
    """Numbers as the tasks write them, all of them good."""
    return {name: deepcopy(numbers) | {"solve_s": 0.5} for name, numbers in MEASURED.items()}


def test_good_numbers_pass_and_carry_their_source() -> None:
    benchmarks = benchmark_lines(ANCF_BENCHMARKS, measured())
    checks = [check for benchmark in benchmarks for check in benchmark.checks]
    assert {check.status for check in checks} == {"pass"}
    assert {check.role for check in checks} == {"gate"}
    assert len({check.id for check in checks}) == len(checks)
    assert all(check.id.startswith("verify.ancf_") and check.source for check in checks)
    by_name = {benchmark.name: benchmark for benchmark in benchmarks}
    assert list(by_name) == list(ANCF_BENCHMARKS)
    assert by_name["ancf_end_shear"].iterations == 112
    assert by_name["ancf_frames"].iterations is None
    assert by_name["ancf_pendulum"].control.shown(by_name["ancf_pendulum"].sound) == "6.00·10⁻⁴ mm"
    order = by_name["ancf_arch"].lines[-1]
    assert (order.tolerance, order.shown_difference) == ("at least 1.4", "–")


def _times(name: str, key: str, factor: float) -> Callable[[Results], None]:
    """Damage: a number, or the first of a list, times a factor."""

    def damage(results: Results) -> None:
        value = results[name][key]
        results[name][key] = [factor * value[0], *value[1:]] if isinstance(value, list) else factor * value

    return damage


def _second_frame(results: Results) -> None:
    results["ancf_frames"]["drop_m"]["skew T"][0] *= 1.02


def _ring(results: Results) -> None:
    results["ancf_frequencies"]["ring_Hz"][0][1] *= 1.02


@pytest.mark.parametrize(
    ("damage", "check"),
    [
        (_times("ancf_plate", "gravity", 1e4), "verify.ancf_plate_gravity"),
        (_times("ancf_plate", "elastic_force", 1e2), "verify.ancf_plate_elastic_force"),
        (_times("ancf_pendulum", "error_m", 20.0), "verify.ancf_pendulum_path"),
        (_times("ancf_pendulum", "energy_spread", 3.0), "verify.ancf_pendulum_energy"),
        (_times("ancf_pendulum", "energy_order", 0.5), "verify.ancf_pendulum_energy_order"),
        (_times("ancf_self_weight", "drop_m", 0.999), "verify.ancf_self_weight_drop"),
        (_times("ancf_self_weight", "tip_x_m", 1.0001), "verify.ancf_self_weight_tip_x"),
        (_times("ancf_self_weight", "order", 0.5), "verify.ancf_self_weight_order"),
        (_times("ancf_bending", "relieved_m", 0.99), "verify.ancf_bending_relieved"),
        (_times("ancf_bending", "held_flat_m", 0.99), "verify.ancf_bending_held_flat"),
        (_times("ancf_bending", "straight_m", 0.99), "verify.ancf_bending_straight"),
        (_times("ancf_end_shear", "full", 1.002), "verify.ancf_end_shear_full_load"),
        (_times("ancf_end_shear", "path_error", 5.0), "verify.ancf_end_shear_path"),
        (_times("ancf_end_moment", "path_error", 20.0), "verify.ancf_end_moment_path"),
        (_times("ancf_end_moment", "order", 0.7), "verify.ancf_end_moment_order"),
        (_second_frame, "verify.ancf_frames_skew_T"),
        (_ring, "verify.ancf_frequencies_ring_3"),
        (_times("ancf_frequencies", "order", 0.8), "verify.ancf_frequencies_order"),
        (_times("ancf_arch", "stiffness_N_per_m", 1.02), "verify.ancf_arch_stiffness"),
        *(
            (_times(name, "damaged", 0.04), f"verify.{name}_control")
            for name in ANCF_BENCHMARKS
            if name != "ancf_plate"
        ),
        (_times("ancf_plate", "damaged", 1e-6), "verify.ancf_plate_control"),
    ],
)
def test_a_number_that_is_off_fails_its_line_alone(damage: Callable[[Results], None], check: str) -> None:
    """A control fails where the damage would not be seen."""
    results = measured()
    damage(results)
    checks = [c for benchmark in benchmark_lines(ANCF_BENCHMARKS, results) for c in benchmark.checks]
    assert [c.id for c in checks if c.status != "pass"] == [check]


def test_mesh_studies_and_figures_show_every_mesh() -> None:
    model = ModelVerification(benchmarks=benchmark_lines(ANCF_BENCHMARKS, measured()), numbers=measured())
    assert len(model.mesh_studies) == 6
    figures = ancf_verification_figures(measured())
    assert set(figures) == {"ancf_pendulum", "ancf_distance", "ancf_cantilevers", "ancf_convergence"}
    assert "slope 4" in figures["ancf_convergence"]
