"""What a wheel's stiffness is judged by: ``[reference]`` of a study, each part with its kind, source and uncertainty.

Verified by tests/unit/test_workbench_reference.py.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field, StrictBool, model_validator
from pydantic_core import PydanticCustomError

from contracts.errors import InputError
from workbench.study.quantities import Angle, Force, Length, Number, Stiffness
from workbench.study.section import Positive, Section, in_key
from workbench.study.sections import Orientations

__all__ = [
    "INITIAL",
    "NO_EVIDENCE",
    "NO_REFERENCE",
    "THESIS_KIND",
    "THESIS_WORDS",
    "BandPoint",
    "BandReference",
    "CurveReference",
    "Kind",
    "ReferenceSection",
    "SlopeReference",
    "kind_of",
    "refuse_moved",
    "told",
]

type Kind = Literal["measured", "published", "inferred"]
THESIS_WORDS = "what Sivo's curve must look like, if the thesis (Samarini 2020) is right"
"""Source of the band that ``thesis_words`` judges by."""
NO_EVIDENCE = "the wheel was chosen by the same words: agreement is no independent evidence"
NO_REFERENCE = "No reference: nothing of its stiffness is judged"
THESIS_KIND: Kind = "inferred"
INITIAL = 0.005
"""Deflection up to which an initial tangent is taken where nothing else is said [m]."""

Text = Annotated[str, Field(min_length=1)]
Share = Annotated[Number, Field(ge=0.0, le=1.0)]


class SlopeReference(Section):
    """Slope of the average curve near first touch: of the least-squares line through the origin."""

    value: Annotated[Stiffness, Positive]
    """[N/m]."""
    up_to: Annotated[Length, Positive] = INITIAL
    """Deflection up to which it is taken [m]."""
    orientations: Orientations | None = None
    """Those of fe.orientations of whose mean it is taken; all of them by default."""
    uncertainty: Share
    """Half width of the interval in which it lies, relative [-]."""
    kind: Kind
    """What it is: measured on a wheel, published as a result, or inferred from something else."""
    source: Text
    """Where it comes from."""


class BandPoint(Section):
    """Deflection [m] at which the average curve should reach a load [N]: between ``low`` and ``high``."""

    load: Annotated[Force, Positive]
    """[N]."""
    low: Annotated[Length, Positive]
    """Smallest deflection at this load [m]."""
    high: Annotated[Length, Positive]
    """Largest deflection at this load [m]."""

    @model_validator(mode="after")
    def _in_order(self) -> BandPoint:
        if self.low > self.high:
            rule, hint = f"must not exceed high = {1e3 * self.high:g} mm", "give the smaller deflection as low"
            raise in_key("low", f"{1e3 * self.low:g} mm", rule, hint)
        return self


class BandReference(Section):
    """Where the average curve should lie: intervals of deflection at loads, or a file with intervals of load."""

    points: tuple[BandPoint, ...] = ()
    """Deflections of the average curve at loads."""
    file: Text | None = None
    """CSV with ``deflection_m,load_N``, ``load_low_N`` and ``load_high_N``; relative to the study file."""
    uncertainty: Share
    """Of the band's ends, relative [-]; 0 where the band's width is all that is not known."""
    kind: Kind
    """As that of the slope."""
    source: Text
    """Where it comes from."""

    @model_validator(mode="after")
    def _one_form(self) -> BandReference:
        if bool(self.points) == (self.file is not None):
            value = "" if self.file is None else self.file
            raise in_key("file", value, "is one way to give a band, points the other", "give one of them")
        return self


class CurveReference(Section):
    """A whole curve, e.g. of a test rig, or digitised from a paper: CSV with deflection and load (docs/curves.md)."""

    file: Text
    """CSV with deflection and load; relative to the study file."""
    label: Text
    """What the report calls it."""
    orientation: Annotated[Angle, Field(ge=0.0, lt=2.0 * math.pi)] | None = None
    """One of fe.orientations [rad]; without it the curve is held against the average."""
    uncertainty: Text | None = None
    """Half width of the load's interval, ``"3 %"`` of it or ``"5 N"``; goes before what the file states."""
    kind: Kind
    """As that of the slope."""
    source: Text
    """Where it comes from."""


class ReferenceSection(Section):
    """What the wheel's stiffness is judged by. A study without it has its curves computed and not judged."""

    thesis_words: StrictBool = False
    """True: this wheel is the one the thesis speaks of; its words are asked of it, with the band inferred from them."""
    slope: SlopeReference | None = None
    band: BandReference | None = None
    curves: tuple[CurveReference, ...] = ()
    """Whole curves."""

    @model_validator(mode="after")
    def _something(self) -> ReferenceSection:
        if not (self.thesis_words or self.slope or self.band or self.curves):
            rule, hint = "holds nothing to judge by", "add slope, band or curves, or remove it"
            raise PydanticCustomError("quantity", "{rule}; {hint}", {"rule": rule, "hint": hint})
        return self

    @property
    def parts(self) -> tuple[SlopeReference | BandReference | CurveReference, ...]:
        """Whatever it holds."""
        return tuple(part for part in (self.slope, self.band, *self.curves) if part is not None)


def told(reference: ReferenceSection | None) -> str:
    """What stiffness is judged by, with kinds and sources, in a few sentences."""
    if reference is None:
        return f"{NO_REFERENCE}."
    found = [f"band {THESIS_KIND}, {THESIS_WORDS}; {NO_EVIDENCE}"] if reference.thesis_words else []
    names = {SlopeReference: "slope", BandReference: "band"}
    for part in reference.parts:
        found.append(f"{names.get(type(part)) or getattr(part, 'label', '')} {part.kind}, {part.source}")
    return f"Reference: {'. '.join(one[0].upper() + one[1:] for one in found)}."


def kind_of(reference: ReferenceSection | None, check: str) -> Kind | None:
    """Kind of what the check of this identifier is held against; None where that is nothing of ``[reference]``."""
    if reference is None:
        return None
    if check == "words.band":
        return THESIS_KIND
    if check.startswith("user_"):
        return reference.curves[int(check.removeprefix("user_").partition(".")[0])].kind
    part = reference.slope if check == "fe.initial_tangent" else None
    if check.startswith("fe.deflection_at_") or check == "fe.band":
        return None if reference.band is None else reference.band.kind
    return None if part is None else part.kind


_MOVED = {
    "compare": "[[reference.curves]]",
    "tolerances.reference_wheel": "[reference] thesis_words",
    "tolerances.initial_tangent_up_to": "[reference] slope.up_to",
    "tolerances.initial_tangent_orientations": "[reference] slope.orientations",
    "reference.initial_tangent": "[reference] slope.value",
    "reference.points": "[reference] band.points",
    "reference.source": "[reference] slope.source and band.source",
}
"""Key of earlier versions -> the one that says it now."""


def refuse_moved(table: object) -> None:
    """Raise InputError for a key of a study file that an earlier version had, and name the new one."""
    for key, now in _MOVED.items():
        found = table
        for part in key.split("."):
            found = found.get(part) if isinstance(found, dict) else None
        if found is not None:
            value = "a table" if isinstance(found, dict) else "a list" if isinstance(found, list) else str(found)
            hint = "each part has its own kind, source and uncertainty: docs/tutorials/own_curve.md"
            raise InputError(key, value, f"is {now} now", hint)
