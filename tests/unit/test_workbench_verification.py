"""The report's verification: the same tasks for every study, and lines that fail where a number is off."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest

from workbench.questions.verification.checks import BENCHMARKS
from workbench.questions.verification.figures import verification_figures
from workbench.questions.verification.lines import benchmark_lines
from workbench.questions.verification.question import VERIFICATION, ModelVerification, Verification
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study
from workbench.study.sections import VerificationSection

type Results = dict[str, dict[str, Any]]

PATH = {
    "load": [0.5, 1.0],
    "deflection": [[1.0, 2.01], [2.0, 3.02]],
    "table": [[0.5, 1.0, 2.0], [1.0, 2.0, 3.0]],
    "full": [3.02, 3.0],
    "path_error": 0.0067,
    "meshes": {"4 cells": 0.1, "8 cells": 0.02},
    "damaged": 0.1,
}
ORDERS = {
    degree: {"cells": [4, 6, 9], "l2": [1e-2, 5e-3, 2e-3], "h1": [0.1, 0.07, 0.04], "orders": [degree + 1.02, degree]}
    for degree in (1, 2)
}
MEASURED: Results = {
    "patch": {"linear_field_m": 2e-17, "stress_error": 4e-13, "rotation_force": 2e-15, "modes": 6, "damaged": 33.0},
    "manufactured": {
        "laws": {law: {str(k): v for k, v in ORDERS.items()} for law in ("st_venant_kirchhoff", "neo_hookean")},
        "damaged": 0.23,
    },
    "end_shear": PATH,
    "end_moment": PATH,
    "hemisphere": PATH,
    "hinged_roof": PATH | {"peak": [0.194, 0.1953], "trough": [-0.127, -0.1288], "distance": 6e-3},
    "pulled_cylinder": {
        "load": [0.5, 1.0],
        "deflection": [[2.5, 3.7, 3.7], [2.7, 4.5, 3.3]],
        "table": [[0.5, 2.5, 3.7, 3.7], [1.0, 2.8, 4.6, 3.3]],
        "full": [2.734, 2.768],
        "distance": 0.012,
        "free_side": 7e-3,
        "damaged": 0.019,
    },
    "half_cylinder": {
        "load": [0.5, 1.0],
        "force_N": [-3458.4908, -5412.4747],
        "calculix_N": [-3458.491, -5412.474],
        "felupe_N": -5412.4747,
        "damaged": 3e-3,
    },
    "ring": {"compression": [0.1, 0.6], "load": [1.214, 8.98], "elastica": [1.213, 8.97], "damaged": 0.031},
    "hertz": {"half_width_m": [6.22e-3, 6.21e-3], "peak_pressure_Pa": [0.897e9, 0.896e9], "damaged": 0.095},
    "sliding_block": {"slide_N": [300.0, 300.0], "stick_N_per_m": [9.9999e6, 1e7], "damaged": 0.01},
}


def measured() -> Results:
    """Numbers as the tasks write them, all of them good."""
    return {name: deepcopy(numbers) | {"iterations": 9, "solve_s": 0.5} for name, numbers in MEASURED.items()}


@pytest.fixture(scope="module")
def study() -> Study:
    return read_study(built_in_study())


def test_the_runs_do_not_depend_on_the_study(study: Study) -> None:
    other = read_study(Path(built_in_study()).with_name("amalia.toml"))
    assert [task.key({}) for task in VERIFICATION.tasks(study)] == [task.key({}) for task in VERIFICATION.tasks(other)]
    assert VERIFICATION.applies(study)
    off = VerificationSection(enabled=False)
    assert not VERIFICATION.applies(study.model_copy(update={"verification": off}))


def test_good_numbers_pass_and_carry_their_source() -> None:
    benchmarks = benchmark_lines(BENCHMARKS, measured())
    checks = [check for benchmark in benchmarks for check in benchmark.checks]
    assert {check.status for check in checks} == {"pass"}
    assert {check.role for check in checks} == {"gate"}
    assert len({check.id for check in checks}) == len(checks)
    assert all(check.id.startswith("verify.") and check.source for check in checks)
    model = ModelVerification(benchmarks=benchmarks, numbers={})
    assert Verification(fe=model, ancf=model).failed == []
    ring = next(b for b in benchmarks if b.title == "Ring between plates")
    assert ring.lines[0].difference == pytest.approx(8.98 / 8.97 - 1.0)
    assert ring.lines[0].shown(ring.lines[0].expected) == "8.97"
    order = next(line for b in benchmarks for line in b.lines if line.check.id == "verify.manufactured_l2_degree2")
    assert (order.tolerance, order.shown_difference) == ("± 0.15", "+0.020")


def _scaled(name: str, key: str, factor: float) -> Callable[[Results], None]:
    """Damage: the last entry of a list, or a number, times a factor."""

    def damage(results: Results) -> None:
        value = results[name][key]
        results[name][key] = [*value[:-1], value[-1] * factor] if isinstance(value, list) else value * factor

    return damage


def _order(results: Results) -> None:
    results["manufactured"]["laws"]["neo_hookean"]["2"]["orders"] = [2.8, 2.0]


@pytest.mark.parametrize(
    ("damage", "check"),
    [
        (_scaled("patch", "linear_field_m", 1e2), "verify.patch_linear_field"),
        (_scaled("patch", "stress_error", 1e3), "verify.patch_uniform_stress"),
        (_scaled("patch", "rotation_force", 1e2), "verify.patch_rigid_rotation"),
        (_scaled("patch", "modes", 2.0), "verify.patch_modes"),
        (_order, "verify.manufactured_l2_degree2"),
        (_scaled("end_shear", "full", 1.03), "verify.end_shear_full_load"),
        (_scaled("end_moment", "path_error", 6.0), "verify.end_moment_path"),
        (_scaled("hinged_roof", "peak", 1.01), "verify.hinged_roof_peak"),
        (_scaled("hinged_roof", "trough", 1.03), "verify.hinged_roof_trough"),
        (_scaled("hinged_roof", "distance", 2.0), "verify.hinged_roof_path"),
        (_scaled("pulled_cylinder", "distance", 2.0), "verify.pulled_cylinder_path"),
        (_scaled("pulled_cylinder", "full", 1.03), "verify.pulled_cylinder_full_load"),
        (_scaled("half_cylinder", "calculix_N", 1.00002), "verify.half_cylinder_calculix"),
        (_scaled("half_cylinder", "felupe_N", 1.000001), "verify.half_cylinder_felupe"),
        (_scaled("ring", "load", 1.02), "verify.ring_load"),
        (_scaled("hertz", "half_width_m", 1.012), "verify.hertz_half_width"),
        (_scaled("hertz", "peak_pressure_Pa", 1.012), "verify.hertz_peak_pressure"),
        (_scaled("sliding_block", "slide_N", 1.00001), "verify.sliding_block_slide"),
        (_scaled("sliding_block", "stick_N_per_m", 1.01), "verify.sliding_block_stick"),
        (_scaled("manufactured", "damaged", 4.0), "verify.manufactured_control"),
        *((_scaled(name, "damaged", 0.1), f"verify.{name}_control") for name in BENCHMARKS if name != "manufactured"),
    ],
)
def test_a_number_that_is_off_fails_its_line_alone(damage: Callable[[Results], None], check: str) -> None:
    """A control fails where the damage would not be seen."""
    results = measured()
    damage(results)
    failed = [
        c.id for benchmark in benchmark_lines(BENCHMARKS, results) for c in benchmark.checks if c.status != "pass"
    ]
    assert failed == [check]


def test_mesh_studies_are_those_of_the_shells() -> None:
    found = ModelVerification(benchmarks=benchmark_lines(BENCHMARKS, measured()), numbers=measured())
    assert list(found.mesh_studies) == [
        "Cantilever, end shear force",
        "Cantilever rolled to a circle",
        "Hemisphere with a hole",
        "Hinged roof, snap-through and snap-back",
    ]


def test_every_figure_is_drawn() -> None:
    figures = verification_figures(measured())
    assert set(figures) == {"ring", "orders", "cantilevers", "hemisphere", "hinged_roof", "pulled_cylinder"}
    assert all("slope 3" in html for name, html in figures.items() if name == "orders")
