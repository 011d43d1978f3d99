"""Claim: thin ANCF plates follow the published large-displacement shells and an independent code's half cylinder.

Sources: Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569, sections 3.1, 3.2, 3.4 and 3.5
(contracts/published/sze3*; the circle of 3.2 is exact); the half cylinder of contracts/published (CalculiX and FElupe,
three-dimensional); own weight: the elastica of contracts/published/README.md. Tolerances are beside the tests, with the
meshes. Negative controls: full integration of the membrane strain, 1 % of thickness, a moment that does not turn.
"""

from __future__ import annotations

import functools

import numpy as np
import pytest
from scipy.sparse import csc_array

from ancf_reduced.thin_plates.plates import Layer, ThinPlates
from contracts.published import published_table
from tests.thin_plate_paths import Array, dead, grid, load_path, metal, mirror, moved_path
from tests.unit.test_ancf_thin_plates import arc, flat


def sheet(young_modulus: float, poisson_ratio: float, thickness: float, density: float = 1.0) -> list[list[Layer]]:
    return [[Layer(material=metal(young_modulus, poisson_ratio, density), thickness=thickness)]]


def clamped_strip(plates: int, length: float, width: float, layers: list[list[Layer]]) -> tuple[ThinPlates, np.ndarray]:
    body = ThinPlates(*flat((plates, 1), (length, width)), layers)
    kept = np.ones(body.reference.shape, dtype=bool)
    kept[:2] = False
    return body, kept


def tips(states: list[Array], length: float) -> Array:
    """How far the end came back and up, (n, 2)."""
    return np.array([[length - q[-2:, 0, 0].mean(), q[-2:, 0, 2].mean()] for q in states])


def own_weight(plates: int, thickness: float = 1e-3) -> float:
    """Error of the tip's drop [-]."""
    body, kept = clamped_strip(plates, 0.5, 0.5, sheet(177e9, 0.0, thickness, 7800.0))
    pull = np.zeros(body.reference.shape)
    pull[:, 0, 2] = -9.81
    weight = (body.mass() @ pull.ravel()).reshape(pull.shape)
    return -float(tips(load_path(body, kept, dead(weight), (0.5, 1.0))[0], 0.5)[-1, 1]) / 40.3175e-3 - 1.0


def test_a_plate_under_its_weight_hangs_as_the_elastica() -> None:
    """Eight plates within 0.01 % (asked of 16: 0.5 %; measured 1e-6); the control is 1 % thicker."""
    assert abs(own_weight(8)) < 1e-4
    assert abs(own_weight(8, 1.01e-3)) > 0.015


def test_end_shear() -> None:
    """8 plates within 0.05 % of the length: 0.026 measured, 0.037 with 32, whose middle may stretch."""
    length, table = 10.0, published_table("sze31_cantilever_end_shear")
    body, kept = clamped_strip(8, length, 1.0, sheet(1.2e6, 0.0, 0.1))
    force = np.zeros(body.reference.shape)
    force[-2:, 0, 2] = 2.0
    found = tips(load_path(body, kept, dead(force), table["P_over_Pmax"][1:])[0], length)
    assert np.abs(found - np.stack([table["minus_U_tip"], table["W_tip"]], axis=1)[1:]).max() < 5e-4 * length


def moment_error(plates: int, *, turns: bool = True) -> float:
    """Largest distance from the exact circle while a strip rolls up, over its length [-]."""
    length, whole = 12.0, 50.0 * np.pi / 3.0
    body, kept = clamped_strip(plates, length, 1.0, sheet(1.2e6, 0.0, 0.1))
    rows = 12 * (len(body.reference) - np.repeat([2, 1], 2)) + np.tile([3, 5], 2)  # x and z of r_1 at the end

    def moment(q: Array, share: float) -> tuple[Array, csc_array | float]:
        """Of half of it on each of the end's two nodes: the gradient of the angle of r_1."""
        force, (x, z) = np.zeros(q.shape), q[-2:, 1, [0, 2]].T
        if not turns:
            force[-2:, 1, 2] = 0.5 * share * whole
            return force, 0.0
        square = x**2 + z**2
        force[-2:, 1, 0], force[-2:, 1, 2] = 0.5 * share * whole * np.array([-z, x]) / square
        a, b = 0.5 * share * whole * np.array([2.0 * x * z, z**2 - x**2]) / square**2
        values = np.stack([a, b, b, -a], axis=1).ravel()
        pairs = rows.reshape(2, 2)
        where = np.repeat(pairs, 2, axis=1).ravel(), np.tile(pairs, 2).ravel()
        return force, csc_array((values, where), shape=(q.size, q.size))

    shares = np.linspace(0.0, 1.0, 21)[1:]
    angle = 2.0 * np.pi * shares
    exact = length * np.stack([1.0 - np.sin(angle) / angle, (1.0 - np.cos(angle)) / angle], axis=1)
    return float(np.abs(tips(load_path(body, kept, moment, shares)[0], length) - exact).max()) / length


def test_end_moment_rolls_a_strip_up() -> None:
    """12 plates within 0.2 % of the length (the fully parametrised plate: 38 %), 6 within 0.5 %."""
    assert moment_error(12) < 2e-3
    assert moment_error(6) < 5e-3


def test_a_moment_that_keeps_its_direction_is_caught() -> None:
    assert moment_error(12, turns=False) > 0.1


def hemisphere_error(count: int, points: tuple[int, int] = (2, 2)) -> float:
    """Largest difference from the table along the path, over the largest displacement [-]."""
    radius, top = 10.0, np.deg2rad(72.0)
    a, b = radius * top / count, radius * 0.5 * np.pi / count
    i, j = grid(count, count)
    up, around = a * i / radius, b * j / radius
    (c, cz), (s, sz), zero = np.cos([up, around]), np.sin([up, around]), 0.0 * up
    nodes = np.stack(
        [
            radius * np.stack([c * cz, c * sz, s], axis=1),
            np.stack([-s * cz, -s * sz, c], axis=1),
            np.stack([-c * sz, c * cz, zero], axis=1),
            np.stack([s * sz, -s * cz, zero], axis=1) / radius,
        ],
        axis=1,
    )
    first = ((count + 1) * np.arange(count)[:, None] + np.arange(count)).ravel()
    plates = np.stack([first, first + 1, first + count + 1, first + count + 2], axis=1)
    layers = sheet(6.825e7, 0.3, 0.04)
    body = ThinPlates(nodes, plates, np.tile([a, b], (count**2, 1)), layers, membrane_points=points)
    kept = np.ones(nodes.shape, dtype=bool)
    mirror(kept, j == 0, 1, 2)
    mirror(kept, j == count, 0, 2)
    kept[0, 0, 2] = False
    force = np.zeros(nodes.shape)
    force[0, 0, 0], force[count, 0, 1] = 200.0, -200.0
    table = published_table("sze34_hemisphere_18deg_hole")
    states, _ = load_path(body, kept, dead(force), table["P_over_Pmax"])
    found = np.array([[q[0, 0, 0] - radius, radius - q[count, 0, 1]] for q in states])
    exact = np.stack([table["V_A"], table["minus_U_B"]], axis=1)
    return float(np.abs(found - exact).max() / exact.max())


@pytest.mark.slow
def test_hemisphere_of_cells_that_narrow() -> None:
    """Cells are trapezia that narrow to a third. 12 x 12 within 0.5 %, two points each way; four lock by 2 %."""
    assert hemisphere_error(12) < 5e-3
    assert hemisphere_error(12, (4, 4)) > 0.01


@pytest.mark.slow
def test_pull_out_of_an_open_cylinder() -> None:
    """12 x 8 plates of an eighth: B and C within 1 % of the radius; under the point load, 3.1 % of W_A below it.

    24 x 16 plates: 0.3 % and 1.8 %, 32 x 24 1.5 %. Sze's shell shears under the point load, this plate does not.
    """
    radius, table = 4.953, published_table("sze35_pullout_open_cylinder")
    body = ThinPlates(*arc(12, 8, radius, 0.5 * np.pi, 0.5 * 10.35), sheet(10.5e6, 0.3125, 0.094))
    i, j = grid(12, 8)
    kept = np.ones(body.reference.shape, dtype=bool)
    for at, normal, crossing in ((i == 0, 0, 1), (i == 12, 2, 1), (j == 0, 1, 2)):
        mirror(kept, at, normal, crossing)
    kept[0, 0, 2], moved = False, np.zeros(body.reference.shape)
    moved[0, 0, 2] = 1.0
    pulled = np.concatenate([np.arange(0.2, 2.3, 0.1), np.arange(2.3, 2.72, 0.02)])  # the load dips at 0.52
    states, _ = moved_path(body, kept, moved, pulled)
    load = np.array([body.force(q)[0, 0, 2] for q in states]) / 1e4
    ways = np.array([[radius - q[12 * 9, 0, 0], radius - q[-1, 0, 0]] for q in states])
    share = table["P_over_Pmax"][1:]
    found = np.array([np.interp(share, load, way) for way in (pulled, *ways.T)]).T
    exact = np.stack([table[name] for name in ("W_A", "minus_U_B", "minus_U_C")], axis=1)[1:]
    far = np.abs(found - exact).max(axis=0)
    assert (far[1:] < 0.01 * radius).all(), far
    assert far[0] < 0.035 * exact[-1, 0], far


@functools.cache
def half_cylinder(along: int, across: int, **points: tuple[int, int]) -> Array:
    """Forces at a crown moved down by 5, 10, 15 (left out), 17.5 and 20 mm [N]."""
    layers = sheet(2.1e11, 0.3, 0.002)
    body = ThinPlates(*arc(along, across, 0.14, 0.5 * np.pi, 0.05), layers, **points)
    i, j = grid(along, across)
    kept, moved = np.ones(body.reference.shape, dtype=bool), np.zeros(body.reference.shape)
    mirror(kept, i == 0, 0, 1)
    mirror(kept, j == 0, 1, 2)
    kept[i == along] = False
    for vector in (0, 2):  # the crown line stays straight
        kept[i == 0, vector, 2] = False
    moved[i == 0, 0, 2] = -1.0
    states, _ = moved_path(body, kept, moved, (0.005, 0.01, 0.015, 0.0175, 0.02))
    forces = np.array([4.0 * body.force(q)[i == 0, 0, 2].sum() for q in states])
    return np.delete(forces, 2)


def test_a_half_cylinder_carries_what_solid_elements_carry() -> None:
    """CalculiX and FElupe, 207249 unknowns: 12 x 3 plates (624 coordinates) within 0.3 %, 8 x 2 within 0.5 %."""
    table = published_table("halfcyl_crown_reaction")
    fine = table["crown_Fy_N"][[name == "s200" for name in table.text("mesh")]]
    assert np.abs(half_cylinder(12, 3) / fine - 1.0).max() < 3e-3
    assert np.abs(half_cylinder(8, 2) / fine - 1.0).max() < 5e-3
    assert np.abs(half_cylinder(8, 2, membrane_points=(4, 4)) / fine - 1.0).max() > 0.01
