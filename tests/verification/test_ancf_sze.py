"""Claim: ANCF plates follow the cantilever benchmarks, end shear and end moment (rolled up), and converge to them.

Source: Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569, sections 3.1 and 3.2: contracts/published/sze31 for
the shear (three decimals), the exact circle for the moment. A strip of plates, one across the width, nu = 0.
Tolerances: 0.1 % of the length along the path with 32 plates for the shear, 0.5 % with 48 for the moment; orders
between the two coarsest meshes at least 2.5 (measured 3.2 and 3.9: the error is that of locking in the deformed, curved
plates). Negative controls: 2 % of thickness; a moment that keeps its direction. The moment is a couple on the end's
directors d that turns with them: F = M e x d / |d|^2 with the axis e.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray

from ancf_reduced.equilibrium import NewtonControls, NewtonResult, newton_solve
from ancf_reduced.plate_mesh import build_plate_mesh, flat_patch
from ancf_reduced.plate_model import PlateModel, build_plate_model
from contracts.published import published_table

FloatArray = NDArray[np.float64]
YOUNG, WIDTH, THICKNESS = 1.2e6, 1.0, 0.1
SHEAR, MOMENT, STEPS = 4.0, 50.0 * np.pi / 3.0, 20
CONTROLS = NewtonControls(tolerance=1e-7, max_iterations=60)
X, Y, Z = np.eye(3)
TURN = np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
"""v -> e x v for the axis e = -y, which rolls the strip upwards."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Strip:
    """A clamped strip of plates and its load at the other end: a shear force, or a couple that follows or does not."""

    model: PlateModel
    length: float
    moment: bool
    follows: bool = True

    @property
    def end(self) -> NDArray[np.int64]:
        return np.flatnonzero(self.model.mesh.points[:, 0] > self.length - 1e-9)

    @property
    def free(self) -> NDArray[np.int64]:
        return np.flatnonzero(np.repeat(self.model.mesh.points[:, 0] > 1e-9, 12))

    def full(self, x: FloatArray) -> FloatArray:
        p = self.model.mesh.reference_coordinates()
        p.reshape(-1)[self.free] = x
        return p

    def load(self, p: FloatArray, factor: float) -> tuple[FloatArray, FloatArray]:
        """Generalised force and its derivative, half of the load on each end node."""
        force, slope = np.zeros(p.size), np.zeros((p.size, p.size))
        for node in self.end:
            if not self.moment:
                force[12 * node + 2] = 0.5 * factor * SHEAR
                continue
            at, d = np.arange(12 * node + 9, 12 * node + 12), p[node, 3] if self.follows else Z
            half, square = 0.5 * factor * MOMENT, d @ d
            force[at] = half * TURN @ d / square
            if self.follows:
                slope[np.ix_(at, at)] = half * (TURN / square - 2.0 * np.outer(TURN @ d, d) / square**2)
        return force, slope

    def solve(self, x: FloatArray, factor: float) -> NewtonResult:
        def residual(y: FloatArray) -> tuple[FloatArray, float]:
            p = self.full(y)
            return (self.model.elastic_force(p).ravel() - self.load(p, factor)[0])[self.free], SHEAR

        def tangent(y: FloatArray) -> FloatArray:
            p = self.full(y)
            matrix = self.model.elastic_tangent(p) - self.load(p, factor)[1]
            return np.asarray(matrix[np.ix_(self.free, self.free)])

        return newton_solve(residual, tangent, x, CONTROLS)

    def path(self) -> FloatArray:
        """Displacement (U, W) of the tip over the length at equal steps of the load, (20, 2)."""
        x, found = self.model.mesh.reference_coordinates().ravel()[self.free], []
        for step in range(1, 2 * STEPS + 1):  # every other one is a step on the way
            result = self.solve(x, 0.5 * step / STEPS)
            assert result.converged
            x = result.x
            if step % 2 == 0:
                found.append(self.full(x)[self.end[0], 0, [0, 2]] - [self.length, 0.0])
        return np.array(found) / self.length


def strip(length: float, plates: int, *, moment: bool, thickness: float = THICKNESS, follows: bool = True) -> Strip:
    h = length / plates
    mesh = build_plate_mesh([flat_patch(i * h * X, h * X, WIDTH * Y, thickness, "strip") for i in range(plates)])
    model = build_plate_model(mesh, young_modulus=YOUNG, poisson_ratio=0.0, density=1.0, quadrature=(4, 3, 2))
    return Strip(model=model, length=length, moment=moment, follows=follows)


@functools.cache
def shear_error(plates: int, thickness: float = THICKNESS) -> float:
    """Largest distance from the table over the length, shortening and deflection."""
    table = published_table("sze31_cantilever_end_shear")
    expected = np.column_stack([-table["minus_U_tip"], table["W_tip"]])[1:] / 10.0
    return float(np.abs(strip(10.0, plates, moment=False, thickness=thickness).path() - expected).max())


@functools.cache
def moment_error(plates: int) -> float:
    """Largest distance from the exact circle over the length."""
    return float(np.abs(strip(12.0, plates, moment=True).path() - circle()).max())


def circle() -> FloatArray:
    """U/L = sin(a)/a - 1, W/L = (1 - cos a)/a with a = 2 pi M / M_max."""
    a = 2.0 * np.pi * np.arange(1, STEPS + 1) / STEPS
    return np.column_stack([np.sin(a) / a - 1.0, (1.0 - np.cos(a)) / a])


@pytest.mark.slow
def test_end_shear_follows_the_table_and_converges() -> None:
    errors = [shear_error(n) for n in (8, 16, 32)]
    assert errors[2] < 1e-3
    assert np.log2(errors[0] / errors[1]) > 2.5


@pytest.mark.slow
def test_end_moment_follows_the_circle_and_converges() -> None:
    errors = [moment_error(n) for n in (24, 48)]
    assert errors[1] < 5e-3
    assert np.log2(errors[0] / errors[1]) > 2.5


@pytest.mark.slow
def test_a_thicker_strip_is_caught() -> None:
    """Negative control: 2 % of thickness is 6 % of bending stiffness, against 2 % more force."""
    assert shear_error(32, 1.02 * THICKNESS) > 5e-3


@pytest.mark.slow
def test_a_moment_that_keeps_its_direction_is_caught() -> None:
    """Negative control: it cannot roll the strip up; a quarter of the way it is already far from the circle."""
    still = strip(12.0, 24, moment=True, follows=False)
    x = still.model.mesh.reference_coordinates().ravel()[still.free]
    for factor in np.linspace(0.025, 0.25, 10):
        result = still.solve(x, factor)
        assert result.converged
        x = result.x
    tip = (still.full(x)[still.end[0], 0, [0, 2]] - [12.0, 0.0]) / 12.0
    assert np.abs(tip - circle()[4]).max() > 0.05
