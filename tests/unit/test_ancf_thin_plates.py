"""Thin ANCF plates: derivatives, rigid motion, patches. Exact up to round-off; derivatives by differences to 1e-6."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.spatial.transform import Rotation

from ancf_reduced.thin_plates.plates import Layer, ThinPlates
from ancf_reduced.thin_plates.shape_functions import shape_tables
from contracts.errors import InputError
from contracts.materials import TI_6AL_4V

Array = NDArray[np.float64]
METAL, THICKNESS = replace(TI_6AL_4V, young_modulus=2e11, poisson_ratio=0.3, density=7800.0), 0.01
LAYERS = [[Layer(material=METAL, thickness=THICKNESS)]]


def flat(counts: tuple[int, int], lengths: tuple[float, float]) -> tuple[Array, NDArray[np.int64], Array]:
    """Nodes, plates and sizes of a rectangle in the plane z = 0."""
    m, n = counts
    a, b = (length / count for length, count in zip(lengths, counts, strict=True))
    nodes = np.zeros(((m + 1) * (n + 1), 4, 3))
    i, j = (k.ravel() for k in np.meshgrid(np.arange(m + 1), np.arange(n + 1), indexing="ij"))
    nodes[:, 0, 0], nodes[:, 0, 1], nodes[:, 1, 0], nodes[:, 2, 1] = a * i, b * j, 1.0, 1.0
    first = ((n + 1) * np.arange(m)[:, None] + np.arange(n)).ravel()
    plates = np.stack([first, first + 1, first + n + 1, first + n + 2], axis=1)
    return nodes, plates, np.tile([a, b], (m * n, 1))


def arc(count: int, across: int, radius: float, angle: float, width: float) -> tuple[Array, NDArray[np.int64], Array]:
    """A cylindrical strip; its first axis runs around."""
    nodes, plates, sizes = flat((count, across), (radius * angle, width))
    turn = nodes[:, 0, 0] / radius
    curved = np.zeros_like(nodes)
    curved[:, 0] = np.stack([radius * np.sin(turn), nodes[:, 0, 1], radius * np.cos(turn)], axis=-1)
    curved[:, 1] = np.stack([np.cos(turn), 0.0 * turn, -np.sin(turn)], axis=-1)
    curved[:, 2] = [0.0, 1.0, 0.0]
    return curved, plates, sizes


@pytest.fixture
def strip() -> ThinPlates:
    return ThinPlates(*arc(3, 1, 0.5, 1.2, 0.2), LAYERS)


def test_shape_functions_reproduce_bicubic_polynomials() -> None:
    """x^3 y^3 and all its derivatives on a plate 0.3 by 0.7, from its value, slopes and twist at the nodes."""
    a, b = 0.3, 0.7
    x, y = (np.array(k) for k in ([0.0, 0.0, a, a], [0.0, b, 0.0, b]))
    nodes = np.stack([x**3 * y**3, 3 * x**2 * y**3, 3 * x**3 * y**2, 9 * x**2 * y**2], axis=1).ravel()
    u, v = np.random.default_rng(1).random((2, 9))
    X, Y = a * u, b * v
    exact = [X**3 * Y**3, 3 * X**2 * Y**3, 3 * X**3 * Y**2, 6 * X * Y**3, 9 * X**2 * Y**2, 6 * X**3 * Y]
    np.testing.assert_allclose(shape_tables((a, b), u, v) @ nodes, np.stack(exact, axis=1), atol=1e-14)


def test_force_and_tangent_are_derivatives_of_the_energy(strip: ThinPlates) -> None:
    random = np.random.default_rng(2)
    q = strip.reference + 0.02 * random.standard_normal(strip.reference.shape)
    direction = random.standard_normal(q.shape)
    step = 1e-6
    ahead, behind = (strip.energy(q + sign * step * direction) for sign in (1.0, -1.0))
    assert np.vdot(strip.force(q), direction) == pytest.approx((ahead - behind) / (2.0 * step), rel=1e-6)
    slope = (strip.force(q + step * direction) - strip.force(q - step * direction)).ravel() / (2.0 * step)
    tangent = strip.tangent(q)
    np.testing.assert_allclose(tangent @ direction.ravel(), slope, atol=1e-6 * np.abs(slope).max())
    assert abs(tangent - tangent.T).max() < 1e-9 * abs(tangent).max()


def test_a_rigid_motion_costs_nothing(strip: ThinPlates) -> None:
    turned = Rotation.from_rotvec([0.4, -1.1, 0.7]).apply(strip.reference.reshape(-1, 3)).reshape(strip.reference.shape)
    turned[:, 0] += [0.3, -2.0, 1.0]
    scale = METAL.young_modulus * THICKNESS * 0.6 * 0.2
    assert strip.energy(turned) < 1e-24 * scale
    assert np.abs(strip.force(turned)).max() < 1e-11 * scale


@pytest.mark.parametrize("count", [1, 3])
def test_only_rigid_motions_cost_nothing(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Six zero eigenvalues of the tangent at rest; flat, and without the share that holds them, there are more."""

    def free(*, curved: bool = False) -> int:
        shape = arc(count, 1, 0.5, 0.4 * count, 0.2) if curved else flat((count, 1), (0.2 * count, 0.2))
        strip = ThinPlates(*shape, LAYERS)
        squares = eigh(strip.tangent(strip.reference).toarray(), strip.mass().toarray(), eigvals_only=True)
        bending = METAL.young_modulus * THICKNESS**2 / (12.0 * METAL.density * (0.2 * count) ** 4)
        return int((squares < 1e-3 * bending).sum())

    assert free() == free(curved=True) == 6
    monkeypatch.setattr("ancf_reduced.thin_plates.plates.HELD", 0.0)
    assert free() > 6


def test_constant_strain_and_constant_curvature_are_exact() -> None:
    """Green-Lagrange strains 0.01, -0.02 and a shear; then a flat plate rolled onto a cylinder without stretch."""
    nodes, plates, sizes = flat((2, 2), (0.4, 0.3))
    body = ThinPlates(nodes, plates, sizes, LAYERS)
    E = np.array([[0.01, 0.004], [0.004, -0.02]])
    F = np.linalg.cholesky(np.eye(2) + 2.0 * E).T  # F^T F = 1 + 2 E
    q = nodes.copy()
    q[:, :, :2] = np.einsum("ij,nkj->nki", F, nodes[:, :, :2])
    nu, t = METAL.poisson_ratio, THICKNESS
    plane = METAL.young_modulus / (1.0 - nu**2)
    density = 0.5 * t * plane * (nu * np.trace(E) ** 2 + (1.0 - nu) * np.sum(E * E))
    assert body.energy(q) == pytest.approx(density * 0.4 * 0.3, rel=1e-12)
    rolled = [ThinPlates(*flat((n, 1), (0.4, 0.3)), LAYERS).energy(arc(n, 1, 0.5, 0.8, 0.3)[0]) for n in (2, 4, 8)]
    errors = np.abs(np.array(rolled) / (0.5 * t**3 / 12.0 * plane / 0.5**2 * 0.4 * 0.3) - 1.0)
    assert errors[2] < 1e-3
    assert (np.log2(errors[:-1] / errors[1:]) > 1.9).all()


def test_mass_is_that_of_the_strip(strip: ThinPlates) -> None:
    along = np.zeros(strip.reference.shape)
    along[:, 0, 2] = 1.0
    exact = METAL.density * THICKNESS * 0.5 * 1.2 * 0.2
    assert along.ravel() @ (strip.mass() @ along.ravel()) == pytest.approx(exact, rel=1e-4)


def test_bad_input_is_refused() -> None:
    nodes, plates, sizes = flat((1, 1), (0.1, 0.1))
    with pytest.raises(InputError, match="must have a normal"):
        ThinPlates(0.0 * nodes, plates, sizes, LAYERS)
    with pytest.raises(InputError, match="must be \\(n, 4, 3\\)"):
        ThinPlates(nodes[:, 0], plates, sizes, LAYERS)
    with pytest.raises(InputError, match="thickness"):
        ThinPlates(nodes, plates, sizes, [[Layer(material=METAL, thickness=0.0)]])


def test_bonded_layers_bend_as_a_laminate() -> None:
    """Sheets t1, t2 as one plate, stretch free: rigidity A2 - A1^2 / A0 of the moments of E over the height.

    Sheets that slide on one another would have the sum of their own, a fifth of it.
    """
    t1, t2, length, curvature = 1e-3, 0.6e-3, 40e-3, 1e-5
    metal = replace(METAL, poisson_ratio=0.0)
    height = 0.5 * (t1 + t2)
    layers = [Layer(material=metal, thickness=t1), Layer(material=metal, thickness=t2, height=height)]
    nodes, plates, sizes = flat((4, 1), (length, 10e-3))
    network = ThinPlates(nodes, plates, sizes, [layers] * len(plates))
    E = metal.young_modulus
    A0, A1, A2 = E * (t1 + t2), E * t2 * height, E * (t2 * height**2 + (t1**3 + t2**3) / 12.0)
    stretch = A1 / A0 * curvature  # of the surface: no force along the strip
    x = nodes[:, 0, 0].copy()
    q = nodes.copy()
    q[:, 0, 0], q[:, 1, 0] = x * (1.0 + stretch), 1.0 + stretch
    q[:, 0, 2], q[:, 1, 2] = 0.5 * curvature * x**2, curvature * x
    expected = 0.5 * (A2 - A1**2 / A0) * curvature**2 * length * 10e-3
    assert network.energy(q) == pytest.approx(expected, rel=1e-4)
    q[:, 0, 2], q[:, 1, 2] = -q[:, 0, 2], -q[:, 1, 2]  # away from the second sheet: with this stretch far stiffer
    assert network.energy(q) > 2.0 * expected


def test_a_rib_is_a_rod_along_the_second_axis() -> None:
    """What a rib adds to a sheet: bent along it E I about the sheet's surface, twisted G J, across it its foot alone.

    As a sheet of its own it would have 60 times the twisting stiffness. J of a 3:1 rectangle: 0.2633 (Timoshenko and
    Goodier, table for torsion of rectangular bars, from memory).
    """
    w, t, length, rate = 1e-3, 3e-3, 20e-3, 1e-4
    height = -0.5 * (1e-3 + t)
    sheet = Layer(material=METAL, thickness=1e-3)
    nodes, plates, sizes = flat((1, 2), (w, length))
    x, y = nodes[:, 0, 0], nodes[:, 0, 1]
    E, G = METAL.young_modulus, METAL.young_modulus / 2.6
    across = {"z": 0.5 * rate * x**2, "z_1": rate * x, "z_2": 0.0 * x, "z_12": 0.0 * x}
    along = {"z": 0.5 * rate * y**2, "z_1": 0.0 * y, "z_2": rate * y, "z_12": 0.0 * y}
    twist = {"z": rate * x * y, "z_1": rate * y, "z_2": rate * x, "z_12": rate + 0.0 * x}
    foot = 0.7
    stiffness = (foot * w, E * w * (t**3 / 12.0 + t * height**2), G * 0.2633 * t * w**3)

    def added(field: dict[str, Array], layer: Layer) -> float:
        q = nodes.copy()
        q[:, 0, 2], q[:, 1, 2], q[:, 2, 2], q[:, 3, 2] = (field[name] for name in ("z", "z_1", "z_2", "z_12"))
        energies = [ThinPlates(nodes, plates, sizes, [each] * 2).energy(q) for each in ([sheet, layer], [sheet])]
        return energies[0] - energies[1]

    rib = Layer(material=METAL, thickness=t, height=height, rib=w, foot=foot)
    for field, rigidity in zip((across, along, twist), stiffness, strict=True):
        assert added(field, rib) == pytest.approx(0.5 * rigidity * rate**2 * length, rel=1e-3)
    assert added(twist, replace(rib, rib=0.0)) > 50.0 * added(twist, rib)
