"""Joint coordinates: the equations of motion of a tree, with its loops closed by constraints and its drives eliminated.

    M v' + h = -J^T lambda,   J v' = Q_c

with the rows J of the joints that close loops, in the velocities v of the tree (a null-space form of 2.26: the tree's
joints need no equations). A driven coordinate is known as a function of time and leaves the unknowns. Verified by
tests/verification/test_multibody_formulations.py against `formulation.AbsoluteCoordinates`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.assembly import assembly
from rover_dynamics.multibody.compiled import compiled, quaternion_of
from rover_dynamics.multibody.constraints import Constraints, build_constraints
from rover_dynamics.multibody.formulation import Course
from rover_dynamics.multibody.model import BodyMotions, Drive, MultibodyModel
from rover_dynamics.multibody.reactions import Reactions
from rover_dynamics.multibody.spanning_tree import SpanningTree, spanning_tree
from rover_dynamics.multibody.state import State
from rover_dynamics.multibody.tree_kernels import Tree, TreeMotion, bias_and_mass, coordinate_rates, tree_motion
from rover_dynamics.multibody.tree_loops import Loops
from rover_dynamics.multibody.tree_reactions import needed_wrenches, tree_reactions
from rover_dynamics.multibody.tree_start import joint_coordinates

__all__ = ["TreeAccelerations", "TreeCoordinates"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TreeAccelerations:
    """Solution of the equations of motion at one time.

    Attributes
    ----------
    joints : (n_v,) float, v' [rad/s^2, m/s^2]
    multipliers : (m,) float, of the loops' equations [N, N m]
    efforts : (n_l,) float, of the drives of links, in the order of `TreeCoordinates.driven` [N m, N]
    wrenches : (n_b, 6) float, applied to the bodies about their centres of mass, without the weight [N, N m]
    """

    joints: FloatArray
    multipliers: FloatArray
    efforts: FloatArray
    wrenches: FloatArray


class TreeCoordinates:
    """Equations of motion in joint coordinates.

    y : coordinates of all links (n_q), velocities of all links (n_v); those of driven links follow their laws

    Attributes
    ----------
    model : as given
    spanning : its tree, whose arrays are `tree`
    driven : links that a drive moves, with the drive
    free : (n_f,) int, joint velocities that no drive moves
    loops : equations of the joints that close loops

    Raises
    ------
    InputError, ConvergenceError
        See `assembly.assembly`.
    """

    def __init__(self, model: MultibodyModel) -> None:
        self.model = model
        self.spanning: SpanningTree = spanning_tree(model)
        self.tree: Tree = self.spanning.tree
        start, _, _ = assembly(model)
        self.driven = _driven_links(model, self.spanning)
        self._drive_at = np.array([self.tree.v_at[link] for link, _ in self.driven], dtype=np.int64)
        self.free = np.setdiff1d(np.arange(self.tree.v_at[-1]), self._drive_at)
        self._gravity = np.array(model.gravity, dtype=np.float64)
        self._start = np.concatenate(joint_coordinates(self.tree, start))
        equations = _loop_equations(model, self.spanning, self.driven)
        self.loops = Loops(self.tree, equations, self.free, self.motion(0.0, self._start))
        self.redundant = self.loops.redundant

    @property
    def independent(self) -> IntArray:
        """Joint velocities from which all others follow, (n_i,) int."""
        return np.setdiff1d(self.free, self.loops.dependent)

    # The formulation -------------------------------------------------------------------------------------------------

    def start(self) -> FloatArray:
        """See `Formulation`."""
        return self._start.copy()

    def rates(self, t: float, y: FloatArray) -> FloatArray:
        """See `Formulation`; only the independent velocities and coordinates of y count."""
        q, v = self._split(t, y)
        if self.loops:
            q, v = self.loops.close(t, q, v)
        motion = tree_motion(self.tree, q, v)
        return np.concatenate([coordinate_rates(self.tree, q, v, motion.frames), self.accelerations(t, motion).joints])

    def corrected(self, t: float, y: FloatArray) -> FloatArray:
        """See `Formulation`."""
        q, v = self._split(t, y)
        q = _normalised(self.tree, q)
        return np.concatenate(self.loops.close(t, q, v) if self.loops else (q, v))

    def accepted(self, t: float, y: FloatArray, course: Course | None) -> None:
        """See `Formulation`."""
        if self.loops:
            self.loops.accepted(self.motion(t, y), course)

    def margin(self, t: float, y: FloatArray) -> float:
        """See `Formulation`."""
        return self.loops.margin(self.motion(t, y)) if self.loops else 1.0

    def state(self, t: float, y: FloatArray) -> State:
        """See `Formulation`."""
        motion = self.motion(t, y)
        orientations = np.array([quaternion_of(R) for R in motion.rotations[:-1]])
        return State(positions=motion.positions[:-1], orientations=orientations, velocities=motion.velocities[:-1])

    def reactions(self, t: float, y: FloatArray) -> Reactions:
        """See `Formulation`: loops by their multipliers, the tree's joints by the balance of all bodies behind them."""
        motion = self.motion(t, y)
        solution = self.accelerations(t, motion)
        needed = needed_wrenches(self.model, self.tree, motion, solution.joints, solution.wrenches)
        blocks = -self.loops.rows(t, motion).blocks * solution.multipliers[:, None, None]
        efforts = {id(drive): effort for (_, drive), effort in zip(self.driven, solution.efforts, strict=True)}
        for equation, multiplier in zip(self.loops.constraints.equations, solution.multipliers, strict=True):
            if equation.drive is not None:
                efforts[id(equation.drive)] = -multiplier
        return Reactions(
            joints=tuple(joint.name for joint in self.model.joints),
            wrenches=tree_reactions(self.model, self.spanning, motion, needed, self.loops.constraints, blocks),
            efforts=np.array([efforts[id(drive)] for drive in self.model.drives]),
        )

    # Its parts -------------------------------------------------------------------------------------------------------

    def motion(self, t: float, y: FloatArray) -> TreeMotion:
        """Links and bodies in the world at t [s] and y (n_q + n_v,)."""
        return tree_motion(self.tree, *self._split(t, y))

    def accelerations(self, t: float, motion: TreeMotion) -> TreeAccelerations:
        """Solve for joint accelerations, multipliers and efforts at t [s]."""
        wrenches = self._applied(t, motion)
        h, M = bias_and_mass(self.tree, motion, wrenches, self._gravity)
        acceleration, d, f = np.zeros(len(h)), self._drive_at, self.free
        acceleration[d] = [drive.law.at(t)[2] for _, drive in self.driven]
        right, M_ff = -h[f] - M[np.ix_(f, d)] @ acceleration[d], M[np.ix_(f, f)]
        multipliers, pull = np.zeros(0), h
        if self.loops:
            rows = self.loops.rows(t, motion)
            J, n, m = rows.jacobian, len(f), len(rows.defects)
            matrix = np.zeros((n + m, n + m))
            matrix[:n, :n], matrix[:n, n:], matrix[n:, :n] = M_ff, J[:, f].T, J[:, f]
            known = rows.accelerations - J[:, d] @ acceleration[d]
            solution = np.linalg.solve(matrix, np.concatenate([right, known]))
            acceleration[f], multipliers = solution[:n], solution[n:]
            pull = h + J.T @ multipliers
        else:
            acceleration[f] = np.linalg.solve(M_ff, right)
        efforts = (M @ acceleration + pull)[d]
        return TreeAccelerations(joints=acceleration, multipliers=multipliers, efforts=efforts, wrenches=wrenches)

    def _applied(self, t: float, motion: TreeMotion) -> FloatArray:
        wrenches = np.zeros((len(self.model.bodies), 6))
        if self.model.forces:
            bodies = BodyMotions(motion.positions[:-1], motion.rotations[:-1], motion.velocities[:-1])
            for force in self.model.forces:
                force.add(t, bodies, self.model, wrenches)
        return wrenches

    def _split(self, t: float, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Coordinates and velocities, those of the drives by their laws."""
        n_q = int(self.tree.q_at[-1])
        q, v = y[:n_q].copy(), y[n_q:].copy()
        for link, drive in self.driven:
            q[self.tree.q_at[link]], v[self.tree.v_at[link]], _ = drive.law.at(t)
        return q, v


def _driven_links(model: MultibodyModel, spanning: SpanningTree) -> list[tuple[int, Drive]]:
    """Links of the tree that a drive moves."""
    links = {(named.joint, named.coordinate): named.link for named in spanning.joint_links}
    keys = [(drive.joint, drive.coordinate) for drive in model.drives]
    return [(links[key], drive) for key, drive in zip(keys, model.drives, strict=True) if key in links]


def _loop_equations(model: MultibodyModel, spanning: SpanningTree, driven: list[tuple[int, Drive]]) -> Constraints:
    """Equations of the joints that close loops, and of the drives on them."""
    every = build_constraints(model)
    eliminated = {id(drive) for _, drive in driven}
    rows = [
        k
        for k, equation in enumerate(every.equations)
        if (equation.drive is None and equation.joint in spanning.cut)
        or (equation.drive is not None and id(equation.drive) not in eliminated)
    ]
    return every.part(np.array(rows, dtype=np.int64))


@compiled
def _normalised(tree: Tree, q: FloatArray) -> FloatArray:
    out = q.copy()
    for k in range(len(tree.parents)):
        if tree.q_at[k + 1] - tree.q_at[k] >= 4:  # a quaternion, after the position of a free link
            end = tree.q_at[k + 1]
            out[end - 4 : end] /= np.sqrt(np.sum(out[end - 4 : end] ** 2))
    return out
