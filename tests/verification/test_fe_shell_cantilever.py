"""Claim: one layer of 27-node hexahedra with the default quadrature follows the two cantilever benchmarks, end shear
force and end moment (rolled into a full circle), within 3 % along the path and 2 % at full load, converged in the mesh.

Source: Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569, sections 3.1 and 3.2, tables in tests/data/sze2004
(for the moment, the exact columns: U/L = sin(a)/a - 1, W/L = (1 - cos a)/a, a = 2 pi M/M_max). Tolerances as the
project's target; the tables' three decimals and the St. Venant-Kirchhoff strains of 2.6 % under the full moment stay
below 0.2 %. Errors below a twentieth of the largest deflection are relative to that twentieth.
"""

from __future__ import annotations

import functools

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.materials import Material
from reference_fe.domain import Domain
from reference_fe.static_problem import Discretisation, StaticProblem
from reference_fe.supports import EndMoment, Support, Traction
from tests.shell_benchmarks import LoadPath, load_path, published, relative_error
from tests.structured_hexahedra import block_mesh

STRIP = Material(
    name="strip", young_modulus=1.2e6, poisson_ratio=0.0, density=1.0, yield_strength=1e9, source="Sze et al. (2004)"
)
WIDTH, THICKNESS = 1.0, 0.1
AREA = WIDTH * THICKNESS
SHEAR = Traction(faces=("x1",), vector=(0.0, 0.0, 4.0 / AREA))
MOMENT = EndMoment(faces=("x1",), magnitude=50.0 * np.pi / 3.0 / AREA, axis=(0.0, -1.0, 0.0), director=(0.0, 0.0, 1.0))
FULL = (3, 3, 3)


def cantilever(
    length: float,
    cells: int,
    load: Traction | EndMoment,
    discretisation: Discretisation | None = None,
    thickness: float = THICKNESS,
) -> StaticProblem:
    """Strip along x, clamped at x = 0, one cell wide and thick."""

    def mapping(X: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.column_stack([length * X[:, 0], WIDTH * X[:, 1], thickness * (X[:, 2] - 0.5)])

    return StaticProblem(
        Domain.from_tagged(block_mesh((cells, 1, 1), mapping)),
        {"body": STRIP},
        [Support(faces=("x0",))],
        tractions=[load] if isinstance(load, Traction) else [],
        loads=[load] if isinstance(load, EndMoment) else [],
        discretisation=discretisation,
    )


def tip(length: float) -> list[tuple[list[float], list[float]]]:
    """Shortening and deflection of the middle of the free end."""
    point = [length, 0.5 * WIDTH, 0.0]
    return [(point, [-1.0, 0.0, 0.0]), (point, [0.0, 0.0, 1.0])]


def end_shear_table() -> NDArray[np.float64]:
    return published("sze31_cantilever_end_shear")


def end_moment_table() -> NDArray[np.float64]:
    return published("sze32_cantilever_end_moment")[:, [0, 2, 4]]


@functools.cache
def end_shear(cells: int) -> LoadPath:
    return load_path(cantilever(10.0, cells, SHEAR), end_shear_table()[1:, 0].tolist(), tip(10.0))


@functools.cache
def end_moment(cells: int) -> LoadPath:
    return load_path(cantilever(12.0, cells, MOMENT), end_moment_table()[1:, 0].tolist(), tip(12.0))


def test_end_shear_follows_the_published_path() -> None:
    errors = np.abs(relative_error(end_shear(16), end_shear_table()))
    assert errors.max() < 0.03
    assert errors[-1].max() < 0.02
    assert end_shear(16).iterations <= 80  # 20 points


def test_end_shear_is_converged_in_the_mesh() -> None:
    """Twice as many cells: the deflections move by less than 0.1 %."""
    np.testing.assert_allclose(end_shear(8).deflection, end_shear(16).deflection, rtol=1e-3)


def test_end_moment_follows_the_exact_circle() -> None:
    errors = np.abs(relative_error(end_moment(16), end_moment_table()))
    assert errors.max() < 0.03
    assert errors[-1].max() < 0.02
    assert end_moment(16).iterations <= 120  # 20 points


def test_end_moment_is_converged_in_the_mesh() -> None:
    """Twice as many cells: the tip of the rolled-up strip moves by less than 0.3 % of its length."""
    np.testing.assert_allclose(end_moment(8).deflection, end_moment(16).deflection, rtol=0.0, atol=3e-3 * 12.0)


@pytest.mark.parametrize(("load", "length"), [(SHEAR, 10.0), (MOMENT, 12.0)], ids=["shear", "moment"])
def test_one_increment_reaches_the_full_load(load: Traction | EndMoment, length: float) -> None:
    """From rest to the full load in one increment: the same end as through twenty points, to 1e-6 of the length."""
    one = load_path(cantilever(length, 8, load), [1.0], tip(length))
    many = end_shear(8) if load is SHEAR else end_moment(8)
    assert one.increments == 1
    np.testing.assert_allclose(one.deflection[-1], many.deflection[-1], rtol=0.0, atol=1e-6 * length)


def test_full_integration_locks() -> None:
    """Negative control: three points along the strip fail the same check for the rolled-up strip of 16 cells."""
    choice = Discretisation(gauss_points=FULL)
    path = load_path(cantilever(12.0, 16, MOMENT, choice), end_moment_table()[1:, 0].tolist(), tip(12.0))
    assert np.abs(relative_error(path, end_moment_table())).max() > 0.1


def test_a_wrong_thickness_is_caught() -> None:
    """Negative control: 2 % of thickness is 6 % of bending stiffness, against 2 % more force."""
    path = load_path(cantilever(10.0, 8, SHEAR, thickness=1.02 * THICKNESS), [0.25, 1.0], tip(10.0))
    assert np.abs(relative_error(path, end_shear_table())).max() > 0.03
