"""A lattice's walls as a linear frame: straight beams that bend and stretch, stiff in their joints; plane strain.

Nothing of the mesh enters but the plan of the middle lines: Euler-Bernoulli beams of stiffness E t^3 / 12 and E t for a
unit of width, E = E / (1 - nu^2), each end turned with its joint.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from geometry.lattice import Lattice, Plan
from geometry.springs import polar

Array = NDArray[np.float64]
Node = tuple[int, int]
"""Ring of nodes from the hub outwards (0 on the hub, then two for each layer, then the rim) and half pitches."""


def walls(lattice: Lattice) -> Iterator[tuple[Node, Node]]:
    """Ends of every wall."""
    turn = 2 * lattice.cells
    for row in range(lattice.layers + 1):
        for i in range(row % 2, turn, 2):
            yield (2 * row, i), (2 * row + 1, i)
    for layer in range(lattice.layers):
        for i in range(layer % 2, turn, 2):
            for side in (-1, 1):
                yield (2 * layer + 1, i), (2 * layer + 2, (i + side) % turn)


def shift_stiffness(lattice: Lattice, plan: Plan, modulus: float, turned: bool = False) -> float:
    """Force on the hub for a shift of the rim along x by one metre [N/m^2]; or the moment for a turn by one radian."""
    radii = [r for row in plan.rows for r in row]
    beams = list(walls(lattice))
    number = {node: k for k, node in enumerate(sorted({node for beam in beams for node in beam}))}
    places = {node: polar(radii[node[0]], lattice.phase + 0.5 * lattice.pitch * node[1]) for node in number}
    K = np.zeros((3 * len(number),) * 2)
    for a, b in beams:
        at = [3 * number[node] + k for node in (a, b) for k in range(3)]
        K[np.ix_(at, at)] += beam(places[b] - places[a], modulus, lattice.thickness)
    fixed, u = np.zeros(len(K), dtype=bool), np.zeros(len(K))
    force = np.zeros(len(K))
    for (ring, _), k in number.items():
        if ring in (0, len(radii) - 1):
            fixed[3 * k : 3 * k + 3] = True
        if ring == len(radii) - 1:
            x, z = places[next(node for node, other in number.items() if other == k)]
            u[3 * k : 3 * k + 3] = (-z, x, 1.0) if turned else (1.0, 0.0, 0.0)
            force[3 * k : 3 * k + 3] = u[3 * k : 3 * k + 3]
    u[~fixed] = np.linalg.solve(K[np.ix_(~fixed, ~fixed)], -K[np.ix_(~fixed, fixed)] @ u[fixed])
    return float(force @ K @ u)


def beam(along: Array, modulus: float, t: float) -> Array:
    """Stiffness of one beam, (6, 6): displacement x, z and turn (x to z) of both ends."""
    length = float(np.linalg.norm(along))
    c, s = along / length
    axial, bending = modulus * t / length, modulus * t**3 / 12.0 / length**3
    local = np.zeros((6, 6))
    local[np.ix_([0, 3], [0, 3])] = axial * np.array([[1.0, -1.0], [-1.0, 1.0]])
    L = length
    local[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])] = bending * np.array(
        [[12, 6 * L, -12, 6 * L], [6 * L, 4 * L * L, -6 * L, 2 * L * L], [-12, -6 * L, 12, -6 * L],
         [6 * L, 2 * L * L, -6 * L, 4 * L * L]]
    )  # fmt: skip
    R = np.zeros((6, 6))
    for k in (0, 3):
        R[k : k + 2, k : k + 2], R[k + 2, k + 2] = [[c, s], [-s, c]], 1.0
    return np.asarray(R.T @ local @ R)
