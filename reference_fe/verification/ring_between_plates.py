"""A thin elastic ring pressed between frictionless rigid plates to 60 % of its diameter: large rotation and contact.

Source: contracts/published/ring_between_plates_elastica.csv, the inextensible elastica by quadrature; beyond the load
at which the contact splits, h/R = I1 / sqrt(p) with I1 = 1.198140234736, p = P R^2 / EI. The ring is 0.6 mm thick at
R = 142.5 mm (t/R = 0.4 %), so that extension, shear and thickness stay far below a per cent.
Verified by tests/verification/test_fe_ring.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import IncrementRecord
from contracts.materials import Material
from contracts.published import PublishedTable, published_table
from reference_fe.cells.orientation import curved_axis_first
from reference_fe.contact.obstacle import ContactMethod, ObstacleContact
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import Discretisation, StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.converged_state import ConvergedState
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.structured_hexahedra import block_mesh

__all__ = [
    "BENDING_STIFFNESS",
    "COMPRESSIONS",
    "RADIUS",
    "STRIP",
    "THICKNESS",
    "PressedRing",
    "elastica",
    "elastica_load",
    "press",
    "pressed_ring",
    "quarter_ring",
]

RADIUS, THICKNESS, WIDTH = 0.1425, 0.6e-3, 0.02
STRIP = Material(
    name="strip", young_modulus=1e11, poisson_ratio=0.0, density=1.0, yield_strength=1e9, source="round numbers"
)
BENDING_STIFFNESS = STRIP.young_modulus * WIDTH * THICKNESS**3 / 12.0
COMPRESSIONS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6)
_I1 = 1.198140234736


@dataclass(frozen=True, slots=True, kw_only=True)
class PressedRing:
    """What the run measured.

    Attributes
    ----------
    compression : (n,) float, of the diameter [-]
    load, elastica : (n,) float, load parameter P R^2 / EI with the nominal thickness, ours and the reference [-]
    iterations : linear solves in all
    imbalance : largest |reaction + contact force| over the contact force [-]
    residual : largest relative residual of a converged increment [-]
    """

    compression: NDArray[np.float64]
    load: NDArray[np.float64]
    elastica: NDArray[np.float64]
    iterations: int
    imbalance: float
    residual: float

    @property
    def error(self) -> float:
        """Largest |load / elastica - 1| [-]."""
        return float(np.abs(self.load / self.elastica - 1.0).max())


def pressed_ring(
    elements: int = 40,
    compressions: Sequence[float] = COMPRESSIONS,
    *,
    thickness: float = THICKNESS,
    discretisation: Discretisation | None = None,
) -> PressedRing:
    """Press the ring through ``compressions``; ``elements`` along a quarter, one across and through the thickness.

    ``compressions`` are of the diameter [-], ``thickness`` is the ring's [m].
    """
    attempts = list[IncrementRecord]()
    problem = quarter_ring(elements, discretisation, thickness=thickness)
    states = [state for state in press(problem, compressions, attempts) if state.wanted]
    force = np.array([state.contact_force for state in states])
    imbalance = [np.linalg.norm(state.reaction + state.contact_force) for state in states]
    return PressedRing(
        compression=np.array(compressions),
        load=2.0 * force[:, 2] * RADIUS**2 / BENDING_STIFFNESS,  # the quarter carries half of P
        elastica=elastica_load(compressions),
        iterations=sum(len(attempt.residuals) - 1 for attempt in attempts),
        imbalance=float(np.max(imbalance / np.linalg.norm(force, axis=1))),
        residual=max(state.outcome.residuals[-1] for state in states),
    )


def quarter_ring(
    elements: int,
    discretisation: Discretisation | None = None,
    *,
    normal: tuple[float, float, float] = (0.0, 0.0, 1.0),
    thickness: float = THICKNESS,
    stiffness: float = 1e9,
    method: ContactMethod = ContactMethod.PENALTY,
) -> StaticProblem:
    """Quarter of the ring, symmetric at its lowest and foremost points, on a plane below it.

    Parameters
    ----------
    elements : along the quarter
    normal : unit normal of the plane, to the ring [-]
    thickness : of the ring [m]
    stiffness : penalty stiffness of the contact [N/m^3]
    """

    def mapping(X: NDArray[np.float64]) -> NDArray[np.float64]:
        angle, r = 0.5 * np.pi * X[:, 0], RADIUS + thickness * (X[:, 2] - 0.5)
        return np.column_stack([r * np.sin(angle), WIDTH * X[:, 1], -r * np.cos(angle)])

    mesh = curved_axis_first(block_mesh((elements, 1, 1), mapping))
    supports = [Support(faces=(face,), components=(axis,)) for face, axis in (("x0", 0), ("x1", 2), ("y0", 1))]
    plane = ObstacleContact(
        faces=("z1",), normal=normal, distance_at_touch=RADIUS + thickness / 2, stiffness=stiffness, method=method
    )
    return StaticProblem(
        Domain.from_tagged(mesh), {"body": STRIP}, supports, contact=plane, discretisation=discretisation
    )


def press(
    problem: StaticProblem, compressions: Sequence[float], attempts: list[IncrementRecord] | None = None
) -> list[ConvergedState]:
    """Raise the plane; the control parameter [m] is compression times R. Every attempt is appended to ``attempts``.

    ``compressions`` are of the diameter [-].
    """
    solver = NewtonSolver(problem, NewtonSettings(maximum_iterations=40))
    return list(solve_increments(solver, [c * RADIUS for c in compressions], [] if attempts is None else attempts))


def elastica() -> PublishedTable:
    """The published table, up to and beyond the load at which the contact splits."""
    return published_table("ring_between_plates_elastica")


def elastica_load(compressions: Sequence[float]) -> NDArray[np.float64]:
    """(n,) float: load parameter of the elastica at compressions of the diameter."""
    table = elastica()
    split = table["compression_over_D"][table["flat_half_over_R"] > 0.0].min()
    before = np.interp(compressions, table["compression_over_D"], table["p"])
    return np.array([(_I1 / (1.0 - c)) ** 2 if c > split else b for c, b in zip(compressions, before, strict=True)])
