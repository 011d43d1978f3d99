"""What a curve's abscissa may mean, and what is converted exactly: docs/curves.md.

Two load cases are told apart. *On the ground* the hub carries the load, and every measure of how far it came down is
its radial deflection. *Between two plates* the hub carries nothing and the wheel loses diameter on both sides. Neither
curve follows from the other, because the two loaded places of a rim deform each other; so they are never converted,
only compared each with its own kind. Verified by tests/unit/test_workbench_curve_file.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

__all__ = ["DEFORMATIONS", "Deformation", "Kind", "deformation_named"]

type Kind = Literal["radial deflection", "change of diameter"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Deformation:
    """A definition of the deformation of a wheel.

    Attributes
    ----------
    words : what it is, for messages
    kind : what it is converted to
    unloaded : name of the comment that gives the unloaded size, if the file lists what is left of it; the deformation
        is then the unloaded size less the value
    """

    words: str
    kind: Kind
    unloaded: str | None = None


_RADIAL = Deformation(words="radial deflection of the hub", kind="radial deflection")
_APPROACH = Deformation(words="approach of hub and ground from first touch", kind="radial deflection")
_RADIUS = Deformation(words="loaded radius", kind="radial deflection", unloaded="unloaded_radius")
_DIAMETER = Deformation(words="change of diameter between two plates", kind="change of diameter")
_LEFT = Deformation(words="loaded diameter between two plates", kind="change of diameter", unloaded="unloaded_diameter")

DEFORMATIONS: Mapping[str, Deformation] = {
    "deflection": _RADIAL,
    "radial_deflection": _RADIAL,
    "radial_deflection_of_the_hub": _RADIAL,
    "hub_deflection": _RADIAL,
    "hub_drop": _RADIAL,
    "approach": _APPROACH,
    "contact_approach": _APPROACH,
    "hub_approach": _APPROACH,
    "loaded_radius": _RADIUS,
    "hub_height": _RADIUS,
    "diameter_change": _DIAMETER,
    "change_of_diameter": _DIAMETER,
    "diametral_compression": _DIAMETER,
    "diametral_deflection": _DIAMETER,
    "plate_approach": _DIAMETER,
    "loaded_diameter": _LEFT,
}
"""Name of a column, or words of ``# deformation:`` with ``_`` for spaces -> what it means."""


def deformation_named(words: str) -> Deformation | None:
    """The definition a file names, in any case, with spaces, hyphens or ``_``; None if it is not known."""
    return DEFORMATIONS.get("_".join(words.lower().replace("_", " ").replace("-", " ").split()))
