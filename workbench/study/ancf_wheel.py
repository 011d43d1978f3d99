"""What an ANCF model of the wheel itself does not have, as a rule over the whole study.

Verified by tests/unit/test_workbench_ancf_wheel.py.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from workbench.study.laws import other_law
from workbench.study.own_mesh import own_mesh

if TYPE_CHECKING:
    from workbench.study.model import Study
    from workbench.study.wheel import SpringsSection

__all__ = ["without_ancf_wheel"]


def without_ancf_wheel(study: Study) -> str | None:
    """Which part of the study its ANCF wheel does not have; None where it has all."""
    fe, wheel = study.fe, study.wheel
    springs = wheel.springs if wheel is not None else ()
    key, kind = other_law(study) or ("", "")
    lacks = (
        ("mesh.file", own_mesh(study) is not None),
        ("wheel.lattice", wheel is not None and wheel.lattice is not None),
        ("springs of varying thickness", any(_varies(one) for one in springs)),
        ("wheel.tread", wheel is not None and wheel.tread is not None),
        (f"fe.hub = {fe.hub} without springs between rim and hub", fe.hub != "rigid" and not springs),
        ('fe.contact_stiffness = "auto"', fe.contact_stiffness is None),
        (f"fe.contact_method = {fe.contact_method}", fe.contact_method != "penalty"),
        (f"{key} = {kind}", bool(kind)),
    )
    return next((name for name, stands in lacks if stands), None)


def _varies(springs: SpringsSection) -> bool:
    return any(getattr(springs, key) is not None for key in ("thickness_middle", "thickness_hub"))
