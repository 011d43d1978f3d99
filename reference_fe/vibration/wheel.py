"""Natural modes of a wheel: free, its hub held, or standing on its ground under a load.

Free, its rigid parts move as one hub; held and standing, what its load case holds keeps its place. Half a wheel has the
modes of the whole one: even ones, and odd ones that it cannot be loaded by.
Verified by tests/verification/test_fe_wheel_vibration.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import partial

import numpy as np

from contracts.errors import ConvergenceError, IncrementRecord, InputError
from contracts.material_laws import J2Plasticity
from contracts.materials import Material
from contracts.mesh import TaggedMesh
from contracts.modes import Modes
from reference_fe.contact.obstacle import ObstacleTerm
from reference_fe.contact.obstacles import Plane
from reference_fe.problem.support_dofs import build_supports
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSolver
from reference_fe.vibration.body import Support, natural_modes
from reference_fe.vibration.motions import located_nodes
from reference_fe.wheel.case import WheelLoadCase
from reference_fe.wheel.problem import WheelProblem, hub_supports, wheel_problem

__all__ = ["WheelModes", "WheelState", "wheel_modes"]

_AWAY = 1e-3
"""How far the ground is from a wheel that does not stand on it [m]."""
_FIRST, _LONGEST = 1e-3, 6e-3
"""First step of the ground, and the longest [m]."""
_CLOSE = 1e-4
"""Difference of the load from the one asked for at which the wheel stands under it [-]."""
_STEPS = 60


class WheelState(StrEnum):
    """In what state a wheel vibrates."""

    FREE = "free"
    HELD = "held"
    STANDING = "standing"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class WheelModes:
    """Modes of the full wheel, and where they were found.

    Attributes
    ----------
    modes : at the nodes of the mesh, half a wheel's for half a mesh
    load, deflection : of the full wheel that stands [N, m]; else 0
    negative_pivots : of the tangent at the last converged increment, which knows even motions alone on half a mesh
    dofs : unknowns
    """

    modes: Modes
    load: float
    deflection: float
    negative_pivots: int
    dofs: int


def wheel_modes(
    mesh: TaggedMesh,
    materials: Mapping[str, Material],
    load_case: WheelLoadCase,
    state: WheelState,
    count: int,
    *,
    load: float = 0.0,
    grip: bool = False,
    progress: Callable[[float], None] | None = None,
) -> WheelModes:
    """The lowest modes of a wheel.

    Parameters
    ----------
    mesh, materials : as in `wheel.solve_wheel`, but every part has a material; a free wheel's mesh has all its parts
    load_case : orientation, contact and law; deflections and loads in it do not count
    state : free, held or standing
    count : of modes, besides those of a rigid body
    load : on the ground, for a wheel that stands [N]
    grip : whether points that touch the ground, a plane, stick to it in the vibration, where there had been no friction
        while it was loaded; else they slide freely
    progress : called with the share of the load that is reached

    Raises
    ------
    InputError
        For a load that is not positive, friction on the ground, a part without a material, one that yields in a wheel
        that stands, and as `natural_modes` does.
    ConvergenceError
        If the wheel does not come to stand under the load, or modes are not found.
    """
    if missing := [part for part in mesh.parts if part not in materials]:
        raise InputError("material", ", ".join(missing), "is missing: every part has a mass", "give one a part")
    if load_case.friction:
        rule = "has no symmetric stiffness; points that touch slide freely in a vibration"
        raise InputError("friction coefficient", f"{load_case.friction:g}", rule, "leave friction away")
    if grip and (state is not WheelState.STANDING or not isinstance(load_case.obstacle, Plane)):
        told = f"{state.value} on {type(load_case.obstacle).__name__}"
        raise InputError("grip", told, "needs a wheel that stands on a plane", "leave it out")
    wheel = wheel_problem(mesh, materials, load_case)
    if state is WheelState.STANDING and wheel.problem.histories.remembered:
        rule = "yields: its wheel is not pressed to and fro until it stands under a load, which it would not forget"
        flowing = [part for part, law in wheel.problem.laws.items() if isinstance(law, J2Plasticity)]
        raise InputError("material law", ", ".join(flowing), rule, "ask with an elastic law")
    standing = _Standing(wheel)
    if state is WheelState.STANDING:
        standing.reach(load, load_case, progress)
    else:
        wheel.problem.set_control(-_AWAY)
    densities = {part: materials[part].density for part in mesh.parts}
    terms = wheel.problem.surfaces.terms
    ground = next(term for term in terms if isinstance(term, ObstacleTerm)) if grip else None
    support = _support(wheel, materials, load_case, state)
    return WheelModes(
        modes=natural_modes(wheel.problem, densities, support, count, grips=ground),
        load=standing.load,
        deflection=standing.deflection,
        negative_pivots=standing.negative_pivots,
        dofs=wheel.problem.dofs,
    )


def _support(
    wheel: WheelProblem, materials: Mapping[str, Material], load_case: WheelLoadCase, state: WheelState
) -> Support:
    mesh, problem = wheel.mesh, wheel.problem
    rigid = tuple(part for part in load_case.rigid_parts if part in mesh.parts)
    nodes = partial(located_nodes, problem.domain, problem.V)
    mirror = nodes((), ("symmetry",)) if "symmetry" in mesh.faces else nodes((), ())
    if state is WheelState.FREE:
        return Support(hub=nodes(rigid, ()), mirror=mirror)
    conditions, _ = build_supports(problem.domain, problem.V, hub_supports(mesh, rigid, materials, load_case))
    held = np.unique(np.concatenate([one.dof_indices()[0] for one in conditions])).astype(np.int64)
    return Support(held=held, mirror=mirror)


class _Standing:
    """A wheel that is pressed until it bears a load."""

    def __init__(self, wheel: WheelProblem) -> None:
        self._wheel = wheel
        self._points = [(0.0, 0.0)]
        self.negative_pivots = 0

    @property
    def deflection(self) -> float:
        """Reached [m]."""
        return self._points[-1][0]

    @property
    def load(self) -> float:
        """Of the full wheel there [N]."""
        return self._points[-1][1]

    def reach(self, load: float, case: WheelLoadCase, progress: Callable[[float], None] | None) -> None:
        """Press the wheel until its load is the one asked for [N]."""
        if not (np.isfinite(load) and load > 0.0):
            raise InputError("load", f"{load:g} N", "must be > 0 for a wheel that stands", "200 N is usual")
        history = list[IncrementRecord]()
        solver = NewtonSolver(self._wheel.problem, case.newton)
        for state in solve_increments(solver, lambda _: self._next(load), history):
            borne = float(self._wheel.sides * state.contact_force @ self._wheel.normal)
            self._points.append((state.control, borne))
            self.negative_pivots = state.outcome.negative_pivots or 0
            if progress is not None:
                progress(min(borne / load, 1.0))
            if len(self._points) > _STEPS:
                told = f"{self.load:.4g} N at {1e3 * self.deflection:.4g} mm"
                raise ConvergenceError(f"the wheel does not come to stand under {load:g} N: {told}", history)

    def _next(self, load: float) -> float | None:
        """Deflection to go to [m], by the secant through the points nearest to the load; None where it is borne."""
        at, borne = self._points[-1]
        if abs(borne - load) <= _CLOSE * load:
            return None
        if len(self._points) == 1:
            return _FIRST
        below = [point for point in self._points if point[1] < load]
        above = [point for point in self._points if point[1] > load]
        low = max(below)
        if not above:
            before = self._points[-2]
            slope = (borne - before[1]) / (at - before[0])
            return at + (min(_LONGEST, (load - borne) / slope) if slope > 0.0 else _LONGEST)
        high = min(above)
        share = (load - low[1]) / (high[1] - low[1])
        return float(low[0] + min(max(share, 0.02), 0.98) * (high[0] - low[0]))
