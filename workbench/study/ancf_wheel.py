"""Section of a study file that asks for the ANCF model of the wheel itself.

Verified by tests/unit/test_workbench_ancf_wheel.py.
"""

from __future__ import annotations

from typing import Annotated

from workbench.study.quantities import Length
from workbench.study.section import Positive, Section

__all__ = ["AncfWheelSection"]


class AncfWheelSection(Section):
    """The wheel as thin ANCF plates, held against the solid model at ``fe.orientations``.

    Asked on a plane, without friction and camber, with a rigid hub, without sidewall springs and with the law of
    St. Venant and Kirchhoff.
    """

    element_size: Annotated[Length, Positive] = 16e-3
    """Largest length of a plate along strips and around the rim [m]; a leg has eight plates at least."""
    axial_size: Annotated[Length, Positive] = 18e-3
    """Largest length of a plate along the axle [m]."""
