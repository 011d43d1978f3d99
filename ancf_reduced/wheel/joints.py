"""What plate theory leaves out where parts meet: how far a strip turns at its weld's end, what a rib's foot holds.

The material below the weld's end gives way, so that a strip of thickness t behaves as if it were chi t longer. Of two
equal strips that split apart chi is known, 0.673 (double cantilever beam; from memory: Fichter 1983, Foote and Buchwald
1985), each pulled by the other. Here one strip is pulled off another: chi by plane elasticity of that very joint, with
nothing of a wheel in it; Poisson's ratio moves it by 2 %. On a rigid body, as a rigid hub is, only the strip's own weld
gives way. A rib on a strip makes part of its foot's width rigid, by
plane elasticity again; its height, if it is as tall as the strip is thick, moves that by 4 % at most. Found anew by
tests/verification/test_ancf_weld_joint.py.
"""

from __future__ import annotations

import numpy as np

from contracts.materials import Material

__all__ = ["added_length", "foot_stiffness", "rigid_length", "turning_stiffness"]

_ON_RIGID = 0.422
_RATIOS = 0.0, 0.05, 0.125, 0.25, 1.0 / 3.0, 0.5, 2.0 / 3.0, 1.0, 4.0 / 3.0, 2.0, 2.8, 4.0
_LENGTHS = 0.620, 0.616, 0.609, 0.588, 0.570, 0.529, 0.487, 0.410, 0.346, 0.254, 0.184, 0.121

_WIDTHS = 0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 4.0
_RIGID = 0.0, 0.0139, 0.0571, 0.239, 0.537, 0.919, 2.77


def added_length(ratio: float | None) -> float:
    """Length chi that a strip gains, over its thickness.

    ratio : its thickness over that of the layer below, 0 for an elastic half space; None for a rigid body [-]
    """
    return _ON_RIGID if ratio is None else float(np.interp(ratio, _RATIOS, _LENGTHS))


def turning_stiffness(material: Material, thickness: float, ratio: float | None) -> float:
    """Moment by angle and width at a weld's end, E t^2 / (12 (1 - nu^2) chi) [N/rad]; thickness [m].

    ratio : as `added_length`
    """
    plane_strain = material.young_modulus / (1.0 - material.poisson_ratio**2)
    return plane_strain * thickness**2 / (12.0 * added_length(ratio))


def rigid_length(ratio: float) -> float:
    """Length of a strip that a rib's foot makes rigid, over the strip's thickness; ratio: the foot's width over it."""
    beyond = max(0.0, ratio - _WIDTHS[-1])
    return float(np.interp(ratio, _WIDTHS, _RIGID)) + beyond


def foot_stiffness(material: Material, thickness: float, width: float) -> float:
    """Rigidity against bending that a rib's foot of a width [m] adds to a strip over it, by the strip's width [N m]."""
    rigidity = material.young_modulus * thickness**3 / (12.0 * (1.0 - material.poisson_ratio**2))
    share = rigid_length(width / thickness) * thickness / width
    return rigidity * share / (1.0 - share)
