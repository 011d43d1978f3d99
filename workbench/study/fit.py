"""The section of a study file on fitting the ANCF tire. Verified by tests/unit/test_workbench_ancf_fit.py."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StrictInt, model_validator

from workbench.study.quantities import Angle, Force, Length, Number, Pressure, Stiffness
from workbench.study.section import Positive, Section, in_key

__all__ = ["AncfFitSection", "FitBoundsSection", "FitStartSection", "FitTravelSection", "FittedTireSection"]

type ParameterName = Literal[
    "young_modulus",
    "thickness",
    "rim_thickness",
    "spoke_thickness",
    "hub_radius",
    "outer_radius",
    "contact_stiffness",
    "phase",
]
type WayName = Literal["fore_aft", "lateral", "turning"]
_Lengths = tuple[Annotated[Length, Positive], Annotated[Length, Positive]]


class FitBoundsSection(Section):
    """Lowest and highest value of each parameter that may be free."""

    young_modulus: tuple[Annotated[Pressure, Positive], Annotated[Pressure, Positive]] = (20e3, 50e6)
    """Lowest, highest [Pa]."""
    thickness: _Lengths = (0.002, 0.040)
    """Of rim and spokes together: lowest, highest [m]."""
    rim_thickness: _Lengths = (0.002, 0.040)
    """Lowest, highest [m]."""
    spoke_thickness: _Lengths = (0.002, 0.040)
    """Lowest, highest [m]."""
    hub_radius: _Lengths = (0.020, 0.090)
    """Lowest, highest [m]."""
    outer_radius: _Lengths = (0.1425, 0.1455)
    """Lowest, highest [m]."""
    contact_stiffness: tuple[Annotated[Stiffness, Positive], Annotated[Stiffness, Positive]] = (50.0, 100e3)
    """Lowest, highest [N/m]."""
    phase: tuple[Angle, Angle] = (-1.0471975511965976, 1.0471975511965976)
    """Lowest, highest [rad]."""

    @model_validator(mode="after")
    def _in_order(self) -> FitBoundsSection:
        for name, (low, high) in self:
            if not low < high:
                raise in_key(name, f"{low:g}, {high:g}", "must increase", "give the lower bound first")
        return self


class FitStartSection(Section):
    """Where the search begins, for what differs from [ancf]."""

    young_modulus: Annotated[Pressure, Positive] | None = None
    """[Pa]; that of [ancf] without it."""
    rim_thickness: Annotated[Length, Positive] | None = None
    """[m]; that of [ancf] without it."""
    spoke_thickness: Annotated[Length, Positive] | None = None
    """[m]; that of [ancf] without it."""
    hub_radius: Annotated[Length, Positive] | None = None
    """[m]; that of [ancf] without it."""
    outer_radius: Annotated[Length, Positive] | None = None
    """[m]; that of [ancf] without it."""
    contact_stiffness: Annotated[Stiffness, Positive] | None = None
    """[N/m]; by default as stiff per area as that of [ancf]."""
    phase: Angle | None = None
    """[rad]; that of [ancf] without it."""


class FittedTireSection(Section):
    """One tire to be fitted: its mesh, its free parameters, where the search begins."""

    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$")]
    """Of the tire, in tasks and tables."""
    spokes: Annotated[StrictInt, Field(ge=1, le=96)]
    """Of this tire."""
    circumferential_plates: Annotated[StrictInt, Field(ge=3, le=96)]
    """Around the rim; a multiple of the spokes."""
    free: Annotated[tuple[ParameterName, ...], Field(min_length=1)]
    """Parameters that are fitted."""
    start: FitStartSection = FitStartSection()
    """Where the search begins."""
    phase_starts: Annotated[StrictInt, Field(ge=1, le=36)] = 1
    """Searches begun from so many phases, in equal steps of the turn after which the tire repeats itself."""

    @model_validator(mode="after")
    def _fits_together(self) -> FittedTireSection:
        names = set(self.free)
        twice = len(names) < len(self.free)
        if twice or ("thickness" in names and names & {"rim_thickness", "spoke_thickness"}):
            hint = "thickness is that of rim and spokes together"
            raise in_key("free", ", ".join(self.free), "must name nothing twice", hint)
        if self.phase_starts > 1 and "phase" not in names:
            raise in_key("phase_starts", self.phase_starts, "needs the phase among free", "free it, or leave this out")
        if self.circumferential_plates % self.spokes:
            rule, hint = "must be a multiple of the spokes", "give 6 or 12 plates for 6 spokes"
            raise in_key("circumferential_plates", self.circumferential_plates, rule, hint)
        return self


class FitTravelSection(Section):
    """Stiffnesses against the hub's travel over the ground as data of the fit, at every orientation of [fe]."""

    ways: Annotated[tuple[WayName, ...], Field(min_length=1)] = ("lateral", "turning")
    """Travels of the hub: fore_aft, lateral, and turning about the vertical."""
    load: Annotated[Force, Positive] = 200.0
    """Under which the wheel stands, within load_range [N]."""
    weight: Annotated[Number, Positive, Field(le=1e3)] = 1.0
    """Of a stiffness' relative difference against one of a load at one orientation [-]."""

    @model_validator(mode="after")
    def _once(self) -> FitTravelSection:
        if len(set(self.ways)) < len(self.ways):
            raise in_key("ways", ", ".join(self.ways), "must name nothing twice", "leave out the repeats")
        return self


class AncfFitSection(Section):
    """Fit of the ANCF tire to the FE curves: loads [N] of their average between which it counts, number of deflections,
    weight of the average against the orientations' deviations from it [-], tires.

    ``keep`` names the tire that ``workbench calibrate ancf`` writes into a study; the first one if left out.
    """

    load_range: tuple[Annotated[Force, Positive], Annotated[Force, Positive]] = (20.0, 250.0)
    """Loads of the FE average between which differences count [N]."""
    points: Annotated[StrictInt, Field(ge=3, le=100)] = 9
    """Deflections of each orientation."""
    average_weight: Annotated[Number, Field(ge=1.0, le=1e3)] = 10.0
    """Of the average against the orientations' deviations from it [-]."""
    keep: str | None = None
    """Name of the tire that is kept; the first without it."""
    bounds: FitBoundsSection = FitBoundsSection()
    """Lowest and highest value of each free parameter."""
    travel: FitTravelSection | None = None
    """Stiffnesses against travel among the data; none without it."""
    tires: Annotated[tuple[FittedTireSection, ...], Field(min_length=1)]
    """What is fitted."""

    @property
    def kept(self) -> FittedTireSection:
        """The tire that a study takes over."""
        return next((tire for tire in self.tires if tire.name == self.keep), self.tires[0])

    @model_validator(mode="after")
    def _names(self) -> AncfFitSection:
        if not self.load_range[0] < self.load_range[1]:
            shown = ", ".join(f"{load:g} N" for load in self.load_range)
            raise in_key("load_range", shown, "must increase", "give e.g. 20 N and 250 N")
        names = [tire.name for tire in self.tires]
        if len(set(names)) < len(names):
            raise in_key("tires", ", ".join(names), "must have different names", "rename one")
        if self.keep is not None and self.keep not in names:
            raise in_key("keep", self.keep, f"is none of {', '.join(names)}", "name one of [[ancf_fit.tires]]")
        return self
