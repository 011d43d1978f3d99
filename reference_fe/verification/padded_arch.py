"""A shallow arch on hinges with a soft pad on its crown, pressed by a plane: the height of the plane snaps back.

The arch's load falls behind its peak, faster than the pad relaxes: from there on the plane would have to go back for
equilibrium. Half of it is solved, in plane strain. There is no published path; what it must do is in the tests.
Verified by tests/verification/test_fe_limit_point.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contracts.hub_travel import HubTravel
from contracts.materials import Material
from reference_fe.contact.obstacle import ContactMethod, ObstacleContact
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Middle, Support
from reference_fe.verification.structured_hexahedra import block_mesh, merged, stacked

__all__ = ["padded_arch"]

HALF_SPAN, RISE, THICKNESS, WIDTH, PAD_HEIGHT = 50e-3, 4e-3, 0.5e-3, 5e-3, 40e-3
CELLS, PAD_CELLS = 12, 2


def padded_arch(
    pad_modulus: float = 2e6, *, method: ContactMethod = ContactMethod.PENALTY, travel: HubTravel | None = None
) -> StaticProblem:
    """Arch of steel, pad of ``pad_modulus`` [Pa]; the plane's rise is the control parameter, it presses along -z.

    ``method`` and ``travel`` are those of its contact.
    """
    radius = (HALF_SPAN**2 + RISE**2) / (2.0 * RISE)
    angle = np.arcsin(HALF_SPAN / radius)

    def arch(X: NDArray[np.float64]) -> NDArray[np.float64]:
        a, r = angle * X[:, 0], radius + THICKNESS * (X[:, 2] - 0.5)
        return np.column_stack([r * np.sin(a), WIDTH * X[:, 1], r * np.cos(a) - radius])

    def pad(X: NDArray[np.float64]) -> NDArray[np.float64]:
        foot = arch(np.column_stack([X[:, 0] / CELLS, X[:, 1], np.ones(len(X))]))
        foot[:, 2] += X[:, 2] * (PAD_HEIGHT - foot[:, 2])
        return foot

    mesh = merged(stacked(block_mesh((CELLS, 1, 1), arch), block_mesh((1, 1, PAD_CELLS), pad), "pad"))
    hinge = Middle(between=("z0", "z1"), within=("x1",))
    return StaticProblem(
        Domain.from_tagged(mesh),
        {"body": _material(2.1e11, 0.3), "pad": _material(pad_modulus, 0.0)},
        [
            Support(faces=("x0", "pad_x0"), components=(0,)),
            Support(faces=("y0", "y1", "pad_y0", "pad_y1"), components=(1,)),
            Support(middles=(hinge,), components=(0, 2), name="hinge"),
        ],
        contact=ObstacleContact(
            faces=("pad_z1",),
            normal=(0.0, 0.0, -1.0),
            distance_at_touch=PAD_HEIGHT,
            stiffness=1e12,
            method=method,
            travel=travel,
        ),
    )


def _material(young_modulus: float, poisson_ratio: float) -> Material:
    return Material(
        name="assumed",
        young_modulus=young_modulus,
        poisson_ratio=poisson_ratio,
        density=1.0,
        yield_strength=1e12,
        source="assumed",
    )
