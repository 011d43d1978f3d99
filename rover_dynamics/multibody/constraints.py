"""The constraint equations of a model: assembled Jacobian, right-hand sides, and which equations are redundant.

Verified by tests/unit/test_multibody_constraints.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import qr
from scipy.sparse import csr_array

from rover_dynamics.multibody.body import GROUND
from rover_dynamics.multibody.constraint_kernels import ConstraintTable, Row, constraint_rows
from rover_dynamics.multibody.joint import LOCKED, Joint
from rover_dynamics.multibody.model import Drive, MultibodyModel
from rover_dynamics.multibody.state import State, rotations

__all__ = [
    "ConstraintValues",
    "Constraints",
    "Equation",
    "build_constraints",
    "pivoted",
    "redundant_equations",
    "scaled_rows",
    "wrapped",
]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_NOTHING = 1e-12
"""Of the longest row: a shorter one is an equation that holds of itself, as out of the plane of a plane mechanism."""
_RANK = 1e-9
"""Of the largest pivot: below it an equation depends on the others."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Equation:
    """One constraint equation.

    Attributes
    ----------
    joint : name of the joint it belongs to
    kind : see `Row`
    axes : axis of the first frame, and of the second where it has one
    drive : the drive whose law it follows, None for the joint's own equations
    """

    joint: str
    kind: Row
    axes: tuple[int, int]
    drive: Drive | None = None

    @property
    def unit(self) -> str:
        """Of its defect; a right angle's is the cosine, to first order how far off it is."""
        return {Row.TRANSLATION: "m", Row.ANGLE: "rad", Row.RIGHT_ANGLE: "rad"}[self.kind]

    def __str__(self) -> str:
        """What it locks, for messages."""
        along = "xyz"[self.axes[0]]
        if self.drive is not None:
            return f"drive of '{self.joint}'"
        if self.kind is Row.TRANSLATION:
            return f"'{self.joint}': no motion along {along}"
        return f"'{self.joint}': {along} of the first at right angles to {'xyz'[self.axes[1]]} of the second"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ConstraintValues:
    """All equations at one state and time.

    Attributes
    ----------
    defects : (m,) float, C [m, rad, -]
    jacobian : (m, 6 n) sparse, C_u by the bodies' velocities
    rates : (m,) float, -C_t: what C_u u must be
    accelerations : (m,) float, Q_c of 2.25: what C_u u' must be
    blocks : (m, 2, 6) float, the Jacobian by the velocities of the first and of the second body, the ground included
    """

    defects: FloatArray
    jacobian: csr_array
    rates: FloatArray
    accelerations: FloatArray
    blocks: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Constraints:
    """The equations of a model, or a part of them.

    Attributes
    ----------
    equations : what each row is
    table : the same for the compiled loop
    n_bodies : number of bodies
    """

    equations: tuple[Equation, ...]
    table: ConstraintTable
    n_bodies: int

    def at(self, t: float, state: State) -> ConstraintValues:
        """Defects, Jacobian and right-hand sides at t [s] and a state."""
        r = np.vstack([state.positions, np.zeros(3)])
        R = np.concatenate([rotations(state.orientations), np.eye(3)[None]])
        u = np.vstack([state.velocities, np.zeros(6)])
        C, C_u, Q_c = constraint_rows(self.table, r, R, u)
        rates = self.add_laws(t, C, Q_c)
        jacobian = self._jacobian(C_u)
        return ConstraintValues(defects=C, jacobian=jacobian, rates=rates, accelerations=Q_c, blocks=C_u)

    def add_laws(self, t: float, C: FloatArray, Q_c: FloatArray) -> FloatArray:
        """Take the drives' laws from C, add their accelerations to Q_c, both in place; returns the rates -C_t, (m,)."""
        rates = np.zeros(len(C))
        for k, equation in enumerate(self.equations):
            if equation.drive is not None:
                value, rates[k], acceleration = equation.drive.law.at(t)
                C[k] = C[k] - value if equation.kind is Row.TRANSLATION else wrapped(C[k] - value)
                Q_c[k] += acceleration
        return rates

    def part(self, rows: IntArray) -> Constraints:
        """Some of the equations, by their rows (k,) int."""
        t = self.table
        table = ConstraintTable(t.kinds[rows], t.axes[rows], t.bodies[rows], t.points[rows], t.frames[rows])
        return Constraints(equations=tuple(self.equations[k] for k in rows), table=table, n_bodies=self.n_bodies)

    def _jacobian(self, C_u: FloatArray) -> csr_array:
        """Blocks of the bodies that move, in rows and columns."""
        m = len(C_u)
        rows = np.repeat(np.arange(m), 12).reshape(m, 2, 6)
        columns = 6 * self.table.bodies[..., None] + np.arange(6)
        moves = np.broadcast_to(self.table.bodies[..., None] >= 0, C_u.shape)
        shape = (m, 6 * self.n_bodies)
        return csr_array((C_u[moves], (rows[moves], columns[moves])), shape=shape)


def wrapped(angle: float) -> float:
    """The same angle in [-pi, pi) [rad]."""
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


def build_constraints(model: MultibodyModel) -> Constraints:
    """All constraint equations of joints and drives, joint by joint."""
    rows: list[tuple[Equation, Joint]] = []
    for joint in model.joints:
        locked = LOCKED[joint.kind]
        own = [Equation(joint=joint.name, kind=Row.TRANSLATION, axes=(k, 0)) for k in locked.translations]
        own += [Equation(joint=joint.name, kind=Row.RIGHT_ANGLE, axes=pair) for pair in locked.right_angles]
        rows += [(equation, joint) for equation in own]
    for drive in model.drives:
        kind = Row.ANGLE if drive.coordinate == "angle" else Row.TRANSLATION
        equation = Equation(joint=drive.joint, kind=kind, axes=(2, 0), drive=drive)
        rows.append((equation, model.joint(drive.joint)))
    return Constraints(
        equations=tuple(equation for equation, _ in rows), table=_table(model, rows), n_bodies=len(model.bodies)
    )


def _table(model: MultibodyModel, rows: list[tuple[Equation, Joint]]) -> ConstraintTable:
    m = len(rows)
    joints = [joint for _, joint in rows]
    numbers = {GROUND: -1, **model.numbers}
    return ConstraintTable(
        kinds=np.array([equation.kind for equation, _ in rows], dtype=np.int64),
        axes=np.array([equation.axes for equation, _ in rows], dtype=np.int64).reshape(m, 2),
        bodies=np.array([(numbers[j.first], numbers[j.second]) for j in joints], dtype=np.int64).reshape(m, 2),
        points=np.array([(j.first_frame.position, j.second_frame.position) for j in joints]).reshape(m, 2, 3),
        frames=np.array([(j.first_frame.rotation, j.second_frame.rotation) for j in joints]).reshape(m, 2, 3, 3),
    )


def redundant_equations(jacobian: csr_array) -> IntArray:
    """Rows (k,) of a constraint Jacobian (m, n) that depend on the others, by QR with column pivoting of its transpose.

    Rows are scaled to length one first: translations are of another unit than rotations.
    """
    if not jacobian.shape[0]:
        return np.zeros(0, dtype=np.int64)
    pivots, order = pivoted(jacobian)
    rank = int(np.sum(pivots > _RANK * pivots[0]))
    return np.sort(order[rank:])


def pivoted(jacobian: csr_array) -> tuple[FloatArray, IntArray]:
    """Pivots (min(m, n),) [-] and order (m,) of the scaled rows of a Jacobian (m, n), best conditioned first."""
    _, triangle, order = qr(scaled_rows(jacobian).T, mode="economic", pivoting=True)
    return np.abs(np.diag(triangle)), order.astype(np.int64)


def scaled_rows(jacobian: csr_array) -> FloatArray:
    """Rows (m, n) of length one; those that are nothing beside the longest stay short."""
    dense = np.asarray(jacobian.toarray(), dtype=np.float64)
    lengths = np.linalg.norm(dense, axis=1, keepdims=True)
    return np.asarray(dense / np.maximum(lengths, _NOTHING * np.max(lengths, initial=0.0)))
