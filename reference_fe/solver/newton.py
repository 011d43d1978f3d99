"""Newton iteration with mixed integration points and a symmetric MUMPS factorisation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.material_laws import StVenantKirchhoff
from reference_fe import dolfinx_api as api
from reference_fe.contact.newton_step import settle_contact
from reference_fe.contact.surface_term import WildIterateError
from reference_fe.material.hyperelastic import SMALLEST_STRETCH
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.solver import process_sums
from reference_fe.solver.direct import DirectSolver, SingularMatrixError, direct_solver

__all__ = ["NewtonOutcome", "NewtonSettings", "NewtonSolver"]

AUGMENTATION_TOLERANCE = 1e-3
"""Relative residual below which contact multipliers are improved: by then the contact set has settled."""


ROUND_OFF = 1e-6
"""Relative residual above which standing still is taken for contact that looks for its set, not for round-off."""
LONGEST_CYCLE, SAME = 8, 0.01
"""Residuals after which they may repeat themselves, and relative difference that counts as none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NewtonSettings:
    """When an iteration ends.

    Attributes
    ----------
    relative_tolerance : largest residual norm over free unknowns, relative to the norm of the support and contact
        forces at the same state [-]
    maximum_iterations : factorisations before the increment is given up
    """

    relative_tolerance: float = 1e-8
    maximum_iterations: int = 25

    def __post_init__(self) -> None:
        if not 0.0 < self.relative_tolerance < 1.0:
            raise InputError("relative tolerance", self.relative_tolerance, "must lie in (0, 1)", "1e-8 is usual")
        if self.maximum_iterations < 1:
            raise InputError("maximum iterations", self.maximum_iterations, "must be at least 1", "25 is usual")


@dataclass(frozen=True, slots=True, kw_only=True)
class NewtonOutcome:
    """How one iteration ended.

    Attributes
    ----------
    converged : whether the tolerance was met, by a state the material law can mean
    spurious : whether the tolerance was met by a state beyond the law's limit of compression, see
        `hyperelastic.SMALLEST_STRETCH`; a large first increment can find one
    stalled : whether the residual stopped falling near the tolerance: round-off, which no smaller increment cures
    residuals : relative residual at each evaluation [-]: at the start, where 1 means that nothing balances yet, after
        each iteration, and after each change of multipliers
    augmentations : changes of the contact multipliers
    negative_pivots : negative eigenvalues of the last tangent that was factorised, the contact's stiffness included:
        none at a stable equilibrium; None without a factorisation or with an unsymmetric tangent (friction)
    failure : why there was no further step, if the matrix had no inverse; else empty
    residual : (n_own_dofs,) residual at the last state, supported unknowns included [N]
    """

    converged: bool
    residuals: tuple[float, ...]
    residual: NDArray[np.float64]
    spurious: bool = False
    stalled: bool = False
    augmentations: int = 0
    negative_pivots: int | None = None
    failure: str = ""

    @property
    def iterations(self) -> int:
        """Number of linearisations of the body, with a factorisation each."""
        return len(self.residuals) - 1 - self.augmentations


class NewtonSolver:
    """Solves a `StaticProblem` at its present control parameter; keeps matrix, pattern and symbolic analysis.

    ``inner_force`` is added to the support and contact forces that residuals are held against [N]: free expansion has
    neither, nor has a wheel that the ground has left. ``free`` (n_own_dofs,) marks the unknowns without support.
    """

    def __init__(self, problem: StaticProblem, settings: NewtonSettings, inner_force: float = 0.0) -> None:
        self.problem, self.settings, self.inner_force = problem, settings, inner_force
        self._matrix: api.PETSc.Mat | None = None
        self._direct: DirectSolver | None = None
        self.free = np.ones(problem.own_dofs, dtype=bool)
        self.free[problem.own_supported] = False

    def solve(self, rise: float = 0.0) -> NewtonOutcome:
        """Iterate from the present displacement; leaves the last iterate in ``problem.u``.

        ``rise`` is the obstacle's rise since the last converged state [m]: the first solve then uses that state's
        contact set (see `contact.obstacle.ObstacleTerm.evaluate`). Every solve goes on to find the touching set, see
        `contact.newton_step`. A matrix without an inverse and an iterate without sense end it; one whose factors do
        not fit into memory raises MemoryLimitError.
        """
        history = list[float]()
        try:
            return self._iterate(rise, history)
        except (SingularMatrixError, WildIterateError) as error:
            residual, residuals = self.problem.body_residual(), (*history, float("inf"))
            return NewtonOutcome(converged=False, residuals=residuals, residual=residual, failure=str(error))

    def _iterate(self, rise: float, history: list[float]) -> NewtonOutcome:
        """The iteration of `solve`; ``history`` takes the relative residuals."""
        problem, offset = self.problem, self._offset_at_supports()
        problem.store_stress(extrapolate=False)
        force = problem.surfaces.force(problem.u.x.array, rise)
        if rise:
            force = self._step(problem.body_residual() - force, force, offset)
            offset = np.zeros(0)
            history.append(1.0)
        augmentations, goal = 0, self.settings.relative_tolerance
        while True:
            residual = problem.body_residual() - force
            history.append(self.relative(residual, moved=not history and offset.size > 0))
            augmented = history[-1] <= max(AUGMENTATION_TOLERANCE, goal) and problem.surfaces.augment()
            reached = history[-1] <= goal and not augmented
            stalled = not reached and _is_stalled(history, goal)
            tired = len(history) - augmentations > self.settings.maximum_iterations
            cycling = augmentations == 0 and _is_cycling(history)
            if reached or stalled or tired or cycling or not np.isfinite(history[-1]):
                spurious = reached and self.is_spurious()
                return NewtonOutcome(
                    converged=reached and not spurious,
                    residuals=tuple(history),
                    residual=residual,
                    spurious=spurious,
                    stalled=stalled,
                    augmentations=augmentations,
                    negative_pivots=self.negative_pivots if len(history) > 1 else None,
                )
            if augmented:
                augmentations += 1
                force = problem.surfaces.force(problem.u.x.array, 0.0)
            else:
                force = self._step(residual, force, offset)
                offset = np.zeros(0)

    def is_spurious(self) -> bool:
        """Whether some point is compressed beyond what St. Venant-Kirchhoff material can mean, or inside out."""
        laws = self.problem.laws
        kirchhoff = [part for part, law in laws.items() if isinstance(law, StVenantKirchhoff)]
        others = [part for part in laws if part not in kirchhoff]
        limits = ((kirchhoff, SMALLEST_STRETCH), (others, 0.0))
        return any(parts and self.problem.smallest_stretch(parts) <= limit for parts, limit in limits)

    def _step(
        self, residual: NDArray[np.float64], force: NDArray[np.float64], offset: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """One factorisation; stores the extrapolated stress, moves u and returns the contact forces there.

        force : contact forces that ``residual`` holds
        """
        problem = self.problem
        right_hand_side = np.where(self.free, -residual, 0.0)
        lifted = self.factorise(offset)
        if offset.size:
            right_hand_side -= lifted
            right_hand_side[problem.own_supported] = offset[problem.own_supported]
        problem.du.x.array[: problem.own_dofs] = self.solved(right_hand_side)
        problem.du.x.scatter_forward()
        if problem.surfaces.terms:
            force = settle_contact(problem, self.solved, force, self.free)
        if problem.discretisation.mixed_integration_points:
            problem.store_stress(extrapolate=True)
        problem.u.x.array[:] += problem.du.x.array
        return force

    def factorise(self, offset: NDArray[np.float64]) -> NDArray[np.float64]:
        """Factorise the tangent at the present displacement and stored stress.

        Returns it, supports disregarded, times an offset of the supports (n_own_dofs,) [m]: (n_own_dofs,) [N], empty
        without one. Empty on one process means empty on all.
        """
        problem, last, lifted = self.problem, self._matrix, np.zeros(0)
        if self._direct is not None and problem.needs_matrix:
            self._direct.release()  # before there is another matrix
        if offset.size:
            self._matrix, lifted = problem.lifted_tangent(last, offset)
        else:
            self._matrix = problem.tangent(last)
        if self._direct is None or self._matrix is not last:
            self._direct = direct_solver(self._matrix, symmetric=problem.surfaces.symmetric)
        self._direct.factorise()
        return lifted

    @property
    def negative_pivots(self) -> int | None:
        """Negative eigenvalues of the tangent last factorised; None without one, or with an unsymmetric one."""
        return None if self._direct is None else self._direct.negative_pivots

    def solved(self, right_hand_side: NDArray[np.float64]) -> NDArray[np.float64]:
        """Solution with the present factors, (n_own_dofs,); SingularMatrixError where it is no finite number."""
        assert self._matrix is not None
        assert self._direct is not None
        x, b = self._matrix.createVecRight(), self._matrix.createVecLeft()
        b.array[:] = right_hand_side
        self._direct.solve(b, x)
        solution = np.array(x.array, dtype=np.float64)
        b.destroy()
        x.destroy()
        if not np.isfinite(process_sums.global_norm(solution)):
            raise SingularMatrixError("the stiffness matrix is all but singular: a displacement is no finite number")
        return solution

    def _offset_at_supports(self) -> NDArray[np.float64]:
        """Prescribed minus present displacement at supported unknowns, else zero, (n_own_dofs,) [m]; empty if none.

        Empty on one process means empty on all.
        """
        target = self.problem.u.x.array.copy()
        for bc in self.problem.bcs:
            bc.set(target)
        offset = np.asarray(target - self.problem.u.x.array)[: self.problem.own_dofs]
        return offset if process_sums.global_norm(offset) > 0.0 else np.zeros(0)

    def relative(self, residual: NDArray[np.float64], *, moved: bool = False) -> float:
        """Residual norm over free unknowns relative to that of the support and contact forces.

        Infinite where a force is no finite number, and before the supports' move 1.
        """
        if moved:
            return 1.0 if np.isfinite(process_sums.global_norm(residual)) else float("inf")
        out_of_balance = process_sums.global_norm(residual[self.free])
        applied = process_sums.global_norm(residual[~self.free]) + float(np.linalg.norm(self.problem.contact_force()))
        applied += self.inner_force
        if not np.isfinite(applied + out_of_balance):
            return float("inf")
        if applied == 0.0:
            return 0.0 if out_of_balance == 0.0 else 1.0
        return out_of_balance / applied


def _is_stalled(history: Sequence[float], tolerance: float) -> bool:
    """Whether the last four residuals stand still above the tolerance, at most 100 of it and `ROUND_OFF` high.

    Within a factor of three of each other, and the last no less than nine tenths of the first: what falls, even slowly,
    is on its way.
    """
    last = history[-4:]
    still = len(last) == 4 and max(last) < 3.0 * min(last) and last[-1] >= 0.9 * last[0]
    return still and tolerance < last[-1] and max(last) <= min(100.0 * tolerance, ROUND_OFF)


def _is_cycling(history: Sequence[float]) -> bool:
    """Whether the last residuals went the same round thrice, or one of three or more twice: it has no end."""
    for period in range(1, LONGEST_CYCLE + 1):
        rounds = 3 if period < 3 else 2
        last = np.array(history[-rounds * period :])
        if len(last) == rounds * period and np.all(np.isfinite(last)):
            table = last.reshape(rounds, period)
            if np.all(np.abs(table - table[-1]) <= SAME * table[-1]):
                return True
    return False
