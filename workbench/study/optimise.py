"""The section [optimise] of a study file: what may be varied, what is sought, within which limits, at which load.

Verified by tests/unit/test_workbench_trade_offs.py and tests/end_to_end/test_optimise.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field, StrictInt, model_validator

from workbench.study.quantities import Angle, Force, Number, Stiffness
from workbench.study.section import Positive, Section, in_key
from workbench.study.sections import Drop
from workbench.study.sweep import MOST_POINTS, SweepRange, SweepSection, Value, tied_keys

__all__ = ["OptimiseSection", "StiffnessBand", "Wish"]

_NAMED, _OF_THE_WHEEL = ("strip_thickness", "strip_scale"), ("wheel.", "materials.")
"""Names and beginnings of keys that change the wheel itself."""


class Wish(Section):
    """A column of a sweep's table, of which the least or the most is wanted."""

    least: Annotated[str, Field(min_length=1)] | None = None
    """Column that is to be small."""
    most: Annotated[str, Field(min_length=1)] | None = None
    """Column that is to be large."""

    @model_validator(mode="after")
    def _one_of_both(self) -> Wish:
        if (self.least is None) == (self.most is None):
            raise in_key("least", self.least or "", "or most must be given, and not both", 'e.g. { least = "mass_kg" }')
        return self

    @property
    def column(self) -> str:
        """Its name."""
        return self.least or self.most or ""

    @property
    def sign(self) -> float:
        """1 where little is good, -1 where much is."""
        return 1.0 if self.most is None else -1.0


class StiffnessBand(Section):
    """Within which the secant stiffness of the mean curve must lie."""

    low: Annotated[Stiffness, Positive] | None = None
    """Softest wheel that will do [N/m]."""
    high: Annotated[Stiffness, Positive] | None = None
    """Stiffest wheel that will do [N/m]."""

    @model_validator(mode="after")
    def _has_room(self) -> StiffnessBand:
        if self.low is None and self.high is None:
            raise in_key("low", "", "or high must be given", 'e.g. { low = "8 N/mm", high = "9 N/mm" }')
        if self.low is not None and self.high is not None and not self.low < self.high:
            hint = "widen the band" if self.low == self.high else "exchange them"
            raise in_key("high", f"{self.high:g} N/m", f"must exceed low, {self.low:g} N/m", hint)
        return self


class OptimiseSection(Section):
    """What `workbench optimise` looks for: the best of an objective within limits, found by a fast model, confirmed by
    the solid one.

    Attributes
    ----------
    variables : key of the study, or names as in [sweep] -> range or list of values
    load : at which the wheel is judged [N]
    model : the one that searches
    objective : what is sought
    against : what the figure of trade-offs shows beside it
    stiffness, utilisation, gap : limits at the load: secant stiffness of the mean curve [N/m], largest stress over
        yield of any part at any orientation [-], room between hub and rim less the deflection of the softest
        orientation [m], of which a rim that is dented has less
    samples, batch, seed, first_step : of CMA-ES, as of a search in [sweep]
    confirm : points that the solid model runs, the best one and others of the front
    confirm_step : between the orientations of these runs, over the wheel's period; the study's own if left out
    rounds : searches with limits corrected by what the solid model found, if it breaks one
    """

    variables: Annotated[dict[str, Annotated[tuple[Value, ...], Field(min_length=1)] | SweepRange], Field(min_length=1)]
    """Key of the study -> values or a range, as in [sweep]."""
    load: Annotated[Force, Positive]
    """At which the wheel is judged [N]."""
    model: Literal["section", "ancf_wheel"] = "section"
    """The model that searches; the solid one confirms."""
    objective: Wish = Wish(least="mass_kg")
    """What is sought."""
    against: Wish | None = None
    """What the figure shows beside the objective; the stiffness at the load if left out."""
    stiffness: StiffnessBand | None = None
    """Limits of the mean secant stiffness at the load."""
    utilisation: Annotated[Number, Positive] | None = None
    """Largest stress over yield of any part at any orientation, up to the load [-]."""
    gap: Drop | None = None
    """Least room between hub and rim less the largest deflection, at the load [m]; a rim that is dented has less."""
    samples: Annotated[StrictInt, Field(ge=4, le=MOST_POINTS)] = 96
    """Points of the first search."""
    batch: Annotated[StrictInt, Field(ge=4, le=1000)] = 12
    """Points that are chosen at once."""
    seed: Annotated[StrictInt, Field(ge=0)] = 0
    """Of the search."""
    first_step: Annotated[float, Field(gt=0.0, le=1.0)] = 0.3
    """How far the first batch lies around the study as it is, standard deviation over range [-]."""
    confirm: Annotated[StrictInt, Field(ge=0, le=100)] = 1
    """Points that the solid model runs: the best one and others of the front."""
    confirm_step: Annotated[Angle, Positive] | None = None
    """Between the orientations of these runs [rad]; without it those of [fe]."""
    rounds: Annotated[StrictInt, Field(ge=0, le=5)] = 2
    """Searches more, each of half the points, with limits corrected where the solid model breaks one."""

    @model_validator(mode="before")
    @classmethod
    def _variables_as_of_a_sweep(cls, section: object) -> object:
        """Check the variables as a sweep's parameters, keys written without quotes among them."""
        if not isinstance(section, Mapping) or not isinstance(section.get("variables"), Mapping):
            return section
        own = SweepSection.model_fields.keys() & section["variables"].keys()
        if own:
            name = sorted(own)[0]
            raise in_key(f"variables.{name}", "", "is no key of the study", "give a dotted key such as fe.friction")
        if not section["variables"]:
            return section
        return {**section, "variables": SweepSection.flat(section["variables"])}

    @model_validator(mode="after")
    def _asks_something(self) -> OptimiseSection:
        if self.stiffness is None and self.utilisation is None and self.gap is None:
            rule, hint = "has no limit: the best is then the end of a range", "give stiffness, utilisation or gap"
            raise in_key("objective", self.objective.column, rule, hint)
        for keys in self.variables:
            if keys not in _NAMED and any(not key.startswith(_OF_THE_WHEEL) for _, key in tied_keys(keys)):
                rule = "is neither dimension nor material of the wheel: points would not be alike"
                raise in_key(f"variables.{keys}", "", rule, "vary keys of [wheel] or [materials]")
        if self.samples < self.batch:
            raise in_key("samples", self.samples, f"is less than one batch, {self.batch}", "raise it")
        return self

    @property
    def trade(self) -> Wish:
        """What stands beside the objective in the figure."""
        return self.against or Wish(most=f"stiffness_at_{self.load:g}N_N_per_m")

    @property
    def as_sweep(self) -> SweepSection:
        """The same points and columns as a sweep has them."""
        own: dict[str, Any] = {"design": "latin-hypercube", "samples": self.samples, "seed": self.seed}
        own |= {"models": (self.model,), "loads": (self.load,), "base": False}
        return SweepSection.model_validate({**own, **{k: _plain(v) for k, v in self.variables.items()}})


def _plain(values: tuple[Value, ...] | SweepRange) -> object:
    return values.model_dump() if isinstance(values, SweepRange) else list(values)
