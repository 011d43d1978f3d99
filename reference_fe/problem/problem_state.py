"""What an increment starts from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reference_fe.contact.surface_term import TermState

__all__ = ["ProblemState"]


@dataclass(frozen=True, slots=True, kw_only=True)
class ProblemState:
    """What an increment starts from.

    Attributes
    ----------
    displacement : (n_dofs,) [m]
    surfaces : committed history of each surface term
    histories : committed history of each set of material points; empty where nothing yields
    """

    displacement: NDArray[np.float64]
    surfaces: tuple[TermState, ...]
    histories: tuple[NDArray[np.float64], ...] = ()
