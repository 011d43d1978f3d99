"""Section of a study file that asks for the ANCF model of the wheel itself.

Verified by tests/unit/test_workbench_ancf_wheel.py.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from workbench.study.quantities import Length
from workbench.study.section import Positive, Section

if TYPE_CHECKING:
    from workbench.study.model import Study

__all__ = ["AncfWheelSection", "without_ancf_wheel"]


class AncfWheelSection(Section):
    """The wheel as thin ANCF plates, held against the solid model at ``fe.orientations``.

    Asked on a plane, without friction and camber, with a rigid hub, without sidewall springs and with the law of
    St. Venant and Kirchhoff.
    """

    element_size: Annotated[Length, Positive] = 16e-3
    """Largest length of a plate along strips and around the rim [m]; a leg has eight plates at least."""
    axial_size: Annotated[Length, Positive] = 18e-3
    """Largest length of a plate along the axle [m]."""


def without_ancf_wheel(study: Study) -> str | None:
    """Which part of the study its ANCF wheel does not have; None where it has all."""
    fe = study.fe
    lacks = (
        ("sidewall springs", study.wheel.sidewall_springs is not None),
        (f"fe.hub = {fe.hub}", fe.hub != "rigid"),
        (f"fe.friction = {fe.friction:g}", fe.friction != 0.0),
        (f"fe.obstacle = {fe.obstacle.shape}", fe.obstacle.shape != "plane"),
        ("camber or yaw", fe.turned),
        (f"fe.material_law = {fe.material_law}", fe.material_law != "st_venant_kirchhoff"),
    )
    return next((name for name, stands in lacks if stands), None)
