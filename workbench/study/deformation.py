"""What a curve's abscissa may mean, and what is converted exactly: docs/curves.md.

Two load cases are told apart. *On the ground* the hub carries the load, and every measure of how far it came down is
its radial deflection. *Between two plates* the hub carries nothing and the wheel loses diameter on both sides. Neither
curve follows from the other, because the two loaded places of a rim deform each other; so they are never converted,
only compared each with its own kind. Verified by tests/unit/test_workbench_curve_file.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

__all__ = ["DEFORMATIONS", "UNLOADED", "Deformation", "Kind", "beyond_size", "deformation_named"]

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

UNLOADED: Mapping[Kind, str] = {"radial deflection": "unloaded_radius", "change of diameter": "unloaded_diameter"}
"""Name of the comment that gives the size a wheel loses."""
_NOISE = 0.01
"""Of the unloaded size: a first point may lie this far above it."""


def beyond_size(deformation: NDArray[np.float64], size: float, lines: Sequence[int]) -> str:
    """Where a wheel would have more than its unloaded size, or nothing left, in words; empty if nowhere.

    deformation : (n,) float [m]
    size : unloaded radius or diameter [m]
    lines : (n,) of the points in their file
    """
    left = np.round(1e3 * (size - deformation), 9) + 0.0
    gone, grown = np.flatnonzero(left <= 0.0), np.flatnonzero(deformation < -_NOISE * size)
    if size <= 0.0:
        return f"has an unloaded size of {1e3 * size:g} mm, which must be greater than zero"
    if len(gone):
        what = f"leaves {left[gone[0]]:.4g} mm of {1e3 * size:g} mm: the wheel would be gone"
        return f"{what}, the hub in the ground (line {lines[gone[0]]})"
    if len(grown):
        what = f"has {left[grown[0]]:.4g} mm under load, more than the unloaded {1e3 * size:g} mm"
        return f"{what} (line {lines[grown[0]]})"
    return ""


def deformation_named(words: str) -> Deformation | None:
    """The definition a file names, in any case, with spaces, hyphens or ``_``; None if it is not known."""
    return DEFORMATIONS.get("_".join(words.lower().replace("_", " ").replace("-", " ").split()))
