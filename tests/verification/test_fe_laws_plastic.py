"""Claim: J2 plasticity at finite strain follows its closed form, and its history is kept, restored and shared alike.

Source: uniaxial stress of a Hencky material with isotropic hardening. The Kirchhoff stress is tau = E ln(stretch) up to
the yield strength, then tau = R(a) at ln(stretch) = R(a)/E + a, lateral ln = -nu R/E - a/2; unloading and reloading
have the slope E again, and reloading yields where it left off. Radial return is exact along a radius, so that steps do
not matter: 1e-7. Energy: the supports' work is what is stored and what flow dissipates, up to the error of the
trapezoid rule. Negative controls: a yield strength off by 1e-4; a history that is not committed.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from contracts.errors import IncrementRecord, InputError
from contracts.material_laws import J2Plasticity
from reference_fe.material.stored_energy import StoredEnergy
from reference_fe.material.stress import StressRecovery
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.checkpoint import Checkpoint
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.patch import STEEL, distorted_cube
from reference_fe.verification.structured_hexahedra import block_mesh

LAW = J2Plasticity(hardening_modulus=2e9, saturation_stress=1.6e9, saturation_rate=12.0)
METAL = replace(STEEL, law=LAW)
SETTINGS = NewtonSettings(relative_tolerance=1e-10)


def hardened(a: float) -> float:
    """R(a) [Pa]."""
    return 1e9 + 2e9 * a + 0.6e9 * (1.0 - np.exp(-12.0 * a))


class Pulled:
    """The distorted cube, whose length is set at will; every state is accepted."""

    def __init__(self, material: object = METAL) -> None:
        held = [Support(faces=(f"{x}0",), components=(k,)) for k, x in enumerate("xyz")]
        held.append(Support(faces=("x1",), components=(0,), value=(1.0,)))
        self.problem = StaticProblem(Domain.from_tagged(distorted_cube()), {"body": material}, held)  # type: ignore[dict-item]
        self.stress, self.energy = StressRecovery(self.problem), StoredEnergy(self.problem)
        self.solver = NewtonSolver(self.problem, SETTINGS)
        self.iterations = list[tuple[float, ...]]()

    def to(self, length: float, steps: int = 4) -> float:
        """Go to a length [-]; force on the moved face [N]."""
        start = float(self.problem.load_factor.value)
        for control in np.linspace(start, length - 1.0, steps + 1)[1:]:
            self.problem.set_control(float(control))
            outcome = self.solver.solve()
            assert outcome.converged
            self.iterations.append(outcome.residuals)
            self.problem.accept()
        return float(outcome.residual[self.problem.bcs[3].dof_indices()[0]].sum())


def flow(length: float) -> float:
    """Equivalent plastic strain at a length, first loading [-]."""
    return float(brentq(lambda a: hardened(a) / STEEL.young_modulus + a - np.log(length), 0.0, 2.0, xtol=1e-16))


def test_loading_unloading_and_reloading() -> None:
    made, E = Pulled(), STEEL.young_modulus
    for length in (1.1, 1.5):
        a = flow(length)
        assert made.to(length) == pytest.approx(hardened(a) / length, rel=1e-7)
        lateral = np.exp(-STEEL.poisson_ratio * hardened(a) / E - 0.5 * a)
        np.testing.assert_allclose(1.0 + made.problem.nodal_displacement()[:, 1].min(), lateral, rtol=1e-8)
        assert made.stress.largest_plastic_strain()["body"] == pytest.approx(a, rel=1e-7)
        cauchy = hardened(a) / (length * lateral**2)
        np.testing.assert_allclose(made.stress.cell_stations(), cauchy, rtol=1e-7)
    back = 1.5 * np.exp(-0.5 * hardened(a) / E)  # half of the stress is taken off
    assert made.to(back, 2) == pytest.approx(0.5 * hardened(a) / back, rel=1e-6)
    assert made.stress.largest_plastic_strain()["body"] == pytest.approx(a, rel=1e-7)
    again = 1.6
    assert made.to(again) == pytest.approx(hardened(flow(again)) / again, rel=1e-7)


def test_reverse_yielding_adds_plastic_strain() -> None:
    """Pressed back to its first length the cube yields at R(a) the other way: ln = -R(b)/E + 2a - b = 0."""
    made = Pulled()
    made.to(1.1)
    a = flow(1.1)
    b = float(brentq(lambda b: hardened(b) / STEEL.young_modulus - 2.0 * a + b, a, 3.0 * a, xtol=1e-16))
    assert made.to(1.0) == pytest.approx(-hardened(b), rel=1e-6)
    assert made.stress.largest_plastic_strain()["body"] == pytest.approx(b, rel=1e-6)


def test_another_yield_strength_is_seen() -> None:
    made = Pulled(replace(METAL, yield_strength=1.0001e9))
    assert made.to(1.1) != pytest.approx(hardened(flow(1.1)) / 1.1, rel=1e-6)


def bar(**choice: float) -> tuple[StaticProblem, NewtonSolver]:
    """A clamped bar bent far: its end is moved across by a third of its length at control 1."""
    mesh = block_mesh((4, 1, 1), lambda X: X * np.array([1.0, 0.2, 0.1]))
    supports = [Support(faces=("x0",)), Support(faces=("x1",), value=(-0.05, 0.0, -0.35))]
    problem = StaticProblem(Domain.from_tagged(mesh), {"body": replace(METAL, **choice)}, supports)  # type: ignore[arg-type]
    return problem, NewtonSolver(problem, NewtonSettings())


def test_newton_ends_quadratically() -> None:
    """The last residuals of a plastic step: each at most a hundred times the square of the one before."""
    problem, solver = bar()
    *_, last = solve_increments(solver, [0.1, 0.2], [])
    assert problem.histories.state()[0][:, :, 6].max() > 0.01
    before, end = last.outcome.residuals[-2:]
    assert end < 100.0 * before**2 + 1e-13


def test_stations_obey_the_yield_condition() -> None:
    """Where the bar has yielded, the Kirchhoff stress at its surface is R of the strain there; nowhere is it above."""
    problem, solver = bar()
    recovery = StressRecovery(problem)
    list(solve_increments(solver, [0.25, 0.5, 0.75, 1.0], []))
    J = _volume_ratio(problem, recovery)
    alpha = recovery._at_stations.plastic_strain()[recovery._cells]
    excess = recovery.cell_stations() * J / np.array([[hardened(a) for a in row] for row in alpha]) - 1.0
    assert excess.max() < 1e-6
    assert (alpha > 0.01).sum() > 20
    assert np.abs(excess[alpha > 0.01]).min() < 1e-6
    late, late_solver = bar()
    list(solve_increments(late_solver, [0.25, 0.5], []))
    with pytest.raises(InputError, match="before the first increment"):
        StressRecovery(late)


def _volume_ratio(problem: StaticProblem, recovery: StressRecovery) -> np.ndarray:
    """det F at the stations."""
    points = recovery._at_stations._points
    assert points is not None
    t, u = points.tables, problem.u.x.array
    H = np.einsum("cqjn,cni->cqij", t.G, u[t.dofs])
    return np.asarray(np.linalg.det(np.eye(3) + H))


def test_work_is_stored_or_dissipated() -> None:
    problem, solver = bar()
    energy, end = StoredEnergy(problem), np.zeros(problem.dofs)
    targets = [k / 40.0 for k in range(1, 41)]
    power, total = [0.0], []
    for state in solve_increments(solver, targets, []):
        for bc in problem.bcs:
            bc.set(end)
        power.append(float(state.outcome.residual @ end) / state.control)
        total.append(energy.value() + energy.plastic_dissipation())
    fine = np.trapezoid(power, [0.0, *targets])
    rule = abs(np.trapezoid(power[::2], [0.0, *targets][::2]) - fine) / 3.0
    assert rule < 2e-3 * fine
    assert abs(total[-1] - fine) < 2.0 * rule
    assert energy.plastic_dissipation() > 0.5 * fine
    assert abs(energy.value() - fine) > 100.0 * rule  # stored alone is not the work


def test_an_increment_that_fails_leaves_no_trace(monkeypatch: pytest.MonkeyPatch) -> None:
    """A run whose first attempt at the second target is thrown away ends where one goes that was told its targets."""
    straight, solver = bar()
    list(solve_increments(solver, [0.05, 0.1, 0.15], []))
    cut, cut_solver = bar()
    solve, calls = cut_solver.solve, list[int]()

    def fails_once(rise: float = 0.0) -> object:
        outcome = solve(rise)
        calls.append(1)
        return replace(outcome, converged=False) if len(calls) == 2 else outcome

    monkeypatch.setattr(cut_solver, "solve", fails_once)
    history = list[IncrementRecord]()
    list(solve_increments(cut_solver, [0.05, 0.15], history))
    assert [record.converged for record in history] == [True, False, True, True]
    for ours, theirs in zip(cut.histories.state(), straight.histories.state(), strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=0.0, atol=1e-9)


def test_a_resumed_run_has_the_same_bits(tmp_path: Path) -> None:
    def run(stop: int | None, path: Path | None) -> bytes:
        problem, solver = bar()
        recovery = StressRecovery(problem)
        kept = None if path is None else Checkpoint(path=path, key="bar")
        for i, _ in enumerate(solve_increments(solver, [0.1, 0.2, 0.3, 0.4], [], checkpoint=kept)):
            if stop == i:
                break
        return problem.u.x.array.tobytes() + recovery.cell_stations().tobytes()

    path = tmp_path / "kept.npz"
    run(2, path)
    with np.load(path) as archive:
        assert archive["process0/points0"].shape[-1] == archive["process0/points1"].shape[-1] == 7
    assert run(None, path) == run(None, None)


def test_without_committed_history_nothing_is_permanent(monkeypatch: pytest.MonkeyPatch) -> None:
    """Negative control: a body whose flow is never committed goes back along the curve it came by."""
    made = Pulled()
    monkeypatch.setattr(made.problem, "accept", made.problem.surfaces.accept)
    made.to(1.1)
    assert made.to(1.05) == pytest.approx(hardened(flow(1.05)) / 1.05, rel=1e-7)
