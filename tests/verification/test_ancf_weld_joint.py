"""Weld's ends and ribs' feet: the tables of `ancf_reduced.wheel.joints` by plane elasticity of these joints.

Two strips, bonded for x < 0; the lower one is held at its far end, the upper one is bent by a moment at its free end.
What it turns there beyond plate theory (laminate and free part) is chi t / (E' I). And a strip with a rib in its
middle, bent by moments at its ends: what it turns less, times E' I, is the length that the foot makes rigid.
"""

from __future__ import annotations

import math

import basix.ufl
import dolfinx_solver  # noqa: F401  PETSc before dolfinx
import numpy as np
import pytest
import ufl
from dolfinx import fem, mesh
from dolfinx.fem.petsc import LinearProblem
from mpi4py import MPI
from numpy.typing import NDArray

from ancf_reduced.wheel.joints import added_length, foot_stiffness, rigid_length, turning_stiffness
from contracts.materials import TI_6AL_4V

Array = NDArray[np.float64]
_FREE, _FINEST, _GROWTH = 8.0, 1.0 / 48.0, 1.25
"""Length of the free part, first cell at the weld's end, over the strip's thickness; growth of cells."""


def _graded(length: float, finest: float, largest: float) -> Array:
    steps = [finest]
    while sum(steps) < length:
        steps.append(min(steps[-1] * _GROWTH, largest))
    at = np.concatenate([[0.0], np.cumsum(steps)])
    return at * length / at[-1]


def _cells(first: Array) -> Array:
    return np.stack([first[:-1, :-1], first[1:, :-1], first[:-1, 1:], first[1:, 1:]], axis=-1).reshape(-1, 4)


def _lap(below: float, bonded: float, finest: float) -> mesh.Mesh:
    """Quadrilaterals of both strips; the upper one is one thick."""
    left, right = -_graded(bonded, finest, 0.25 * max(1.0, below / 4.0))[::-1], _graded(_FREE, finest, 0.25)
    x, tip = np.concatenate([left, right[1:]]), len(left) - 1
    heights = -_graded(below, finest, 0.2 * max(1.0, below / 4.0))[::-1], _graded(1.0, finest, 0.2)
    points = [np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1) for y in heights]
    lower = np.arange(points[0][..., 0].size).reshape(points[0].shape[:2])
    upper = lower.size + np.arange(points[1][..., 0].size).reshape(points[1].shape[:2])
    upper[: tip + 1, 0] = lower[: tip + 1, -1]
    used, cells = np.unique(np.concatenate([_cells(lower), _cells(upper)]), return_inverse=True)
    places = np.concatenate([p.reshape(-1, 2) for p in points])[used]
    element = basix.ufl.element("Lagrange", "quadrilateral", 1, shape=(2,))
    return mesh.create_mesh(MPI.COMM_SELF, cells.reshape(-1, 4), element, places)


def _ribbed(width: float, height: float, finest: float) -> tuple[mesh.Mesh, float]:
    """Half of a strip one thick with a rib on its upper face, and where it ends."""
    inside = 0.5 * width - _graded(0.5 * width, min(finest, 0.1 * width), 0.25)[::-1]
    x = np.concatenate([inside, 0.5 * width + _graded(_FREE, finest, 0.25)[1:]])
    heights = 1.0 - _graded(1.0, finest, 0.2)[::-1], 1.0 + _graded(height, finest, 0.25)
    points = [np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1) for axes in zip((x, inside), heights, strict=True)]
    strip = np.arange(points[0][..., 0].size).reshape(points[0].shape[:2])
    rib = strip.size + np.arange(points[1][..., 0].size).reshape(points[1].shape[:2])
    rib[:, 0] = strip[: len(inside), -1]
    used, cells = np.unique(np.concatenate([_cells(strip), _cells(rib)]), return_inverse=True)
    places = np.concatenate([p.reshape(-1, 2) for p in points])[used]
    element = basix.ufl.element("Lagrange", "quadrilateral", 1, shape=(2,))
    return mesh.create_mesh(MPI.COMM_SELF, cells.reshape(-1, 4), element, places), 0.5 * width + _FREE


def _turn(domain: mesh.Mesh, poisson: float, far: float | None, end: float = _FREE, *, mirrored: bool = False) -> float:
    """Angle of the upper strip's free end under a moment of one, E = 1, plane strain; held at ``far``.

    far : None holds all of the lower strip
    mirrored : held there as by its mirror image, not in all directions
    """
    space = fem.functionspace(domain, ("Lagrange", 2, (2,)))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    shear, bulk = 0.5 / (1.0 + poisson), poisson / (1.0 + poisson) / (1.0 - 2.0 * poisson)
    strain, virtual = ufl.sym(ufl.grad(u)), ufl.sym(ufl.grad(v))
    work = 2.0 * shear * ufl.inner(strain, virtual) + bulk * ufl.tr(strain) * ufl.tr(virtual)
    ends = mesh.locate_entities_boundary(domain, 1, lambda p: np.isclose(p[0], end) & (p[1] > -1e-9))
    tags = mesh.meshtags(domain, 1, ends, np.ones(len(ends), dtype=np.int32))
    face = ufl.Measure("ds", domain=domain, subdomain_data=tags)(1)
    pull = ufl.as_vector([-12.0 * (ufl.SpatialCoordinate(domain)[1] - 0.5), 0.0])

    def is_held(p: Array) -> NDArray[np.bool_]:
        return np.asarray((p[0] < 1e-9) & (p[1] < 1e-9) if far is None else np.isclose(p[0], far))

    held = [fem.dirichletbc(np.zeros(2), fem.locate_dofs_geometrical(space, is_held), space)]
    if mirrored:
        assert far is not None
        places = (lambda p: np.isclose(p[0], far), lambda p: np.isclose(p[0], far) & np.isclose(p[1], 0.0))
        held = []
        for k, place in enumerate(places):
            own = space.sub(k)
            held.append(fem.dirichletbc(0.0, fem.locate_dofs_geometrical((own, own.collapse()[0]), place)[0], own))
    problem = LinearProblem(
        work * ufl.dx,
        ufl.inner(pull, v) * face,
        bcs=held,
        petsc_options_prefix="joint_",
        petsc_options={"ksp_type": "preonly", "pc_type": "lu"},
    )
    found = problem.solve()
    assert isinstance(found, fem.Function)
    return float(np.real(fem.assemble_scalar(fem.form(ufl.inner(pull, found) * face))))


def _added(ratio: float, poisson: float = 0.3, finest: float = _FINEST) -> float:
    below, bonded = 1.0 / ratio, 14.0 * max(1.0, 1.0 / (3.0 * ratio))
    plate = 1.0 / (12.0 * (1.0 - poisson**2))
    turned = _turn(_lap(below, bonded, finest), poisson, -bonded)
    return turned * plate - bonded / (1.0 + below) ** 3 - _FREE


@pytest.mark.parametrize("ratio", [0.05, 0.25, 0.5, 1.0, 2.0])
def test_the_table_is_plane_elasticity(ratio: float) -> None:
    """Within 0.01 t, which moves a leg of 100 t by 0.03 %; between entries too."""
    assert added_length(ratio) == pytest.approx(_added(ratio), abs=0.01)
    assert added_length(1.4 * ratio) == pytest.approx(_added(1.4 * ratio), abs=0.015)


def test_on_a_rigid_body_the_weld_alone_gives_way() -> None:
    """Within 0.007 t for ratios of Poisson from 0 to 0.45; a fifth less than on a strip of twice the thickness."""
    for poisson in (0.0, 0.3, 0.45):
        turned = _turn(_lap(0.25, _FREE, _FINEST), poisson, None)
        assert added_length(None) == pytest.approx(turned / (12.0 * (1.0 - poisson**2)) - _FREE, abs=7e-3)
    assert added_length(None) < 0.8 * added_length(0.5)


def test_it_is_converged_and_hardly_poissons() -> None:
    """Half the finest cell moves it by less than 0.003 t; ratios of Poisson from 0 to 0.45 by 0.01."""
    usual = _added(0.5)
    assert _added(0.5, finest=0.5 * _FINEST) == pytest.approx(usual, abs=3e-3)
    assert [_added(0.5, nu) for nu in (0.0, 0.45)] == pytest.approx([usual, usual], abs=0.01)


def test_stiffness_is_that_of_the_added_length() -> None:
    """A strip that is longer by chi t turns by M chi t / (E' I) more."""
    t, chi = 0.6e-3, added_length(0.0)
    bending = TI_6AL_4V.young_modulus * t**3 / (12.0 * (1.0 - TI_6AL_4V.poisson_ratio**2))
    assert math.isclose(turning_stiffness(TI_6AL_4V, t, 0.0) * chi * t, bending, rel_tol=1e-12)
    assert 0.6 < chi < 0.673  # below the split of two equal strips, where both turn


def _rigid(width: float, height: float = 3.0, finest: float = _FINEST) -> float:
    domain, end = _ribbed(width, height, finest)
    return 2.0 * (end - _turn(domain, 0.3, 0.0, end, mirrored=True) / (12.0 * (1.0 - 0.3**2)))


@pytest.mark.parametrize("width", [0.25, 0.5, 1.0, 1.5, 2.0, 4.0])
def test_the_foot_is_plane_elasticity(width: float) -> None:
    """Within 0.01 t, between entries 0.03 t; a lower rib is as good, to 4 %, and half the finest cell moves little."""
    assert rigid_length(width) == pytest.approx(_rigid(width), abs=0.01)
    assert rigid_length(1.2 * width) == pytest.approx(_rigid(1.2 * width), abs=0.03)
    assert _rigid(width, height=1.0) == pytest.approx(_rigid(width), rel=0.045)


def test_a_foot_adds_what_makes_its_part_rigid() -> None:
    """Compliance of the foot's width is that of what is left of it."""
    t, width = 0.9e-3, 1e-3
    bending = TI_6AL_4V.young_modulus * t**3 / (12.0 * (1.0 - TI_6AL_4V.poisson_ratio**2))
    left = width - rigid_length(width / t) * t
    assert width / (bending + foot_stiffness(TI_6AL_4V, t, width)) == pytest.approx(left / bending, rel=1e-12)
    assert rigid_length(6.0) == pytest.approx(rigid_length(4.0) + 2.0)
