"""What a fit of the ANCF tire found, as its task writes it. Verified by tests/unit/test_workbench_ancf_fit.py."""

from __future__ import annotations

from dataclasses import dataclass

from ancf_reduced.fit.phase_search import PhaseTrial
from ancf_reduced.tire.preset import TirePreset

__all__ = ["AverageError", "Fitted", "FittedParameter", "Held", "TravelRow"]


@dataclass(frozen=True, slots=True, kw_only=True)
class AverageError:
    """Largest difference of an average curve from the FE's over the FE's load, with its sign [-], and where [N]."""

    largest: float
    at_load: float


@dataclass(frozen=True, slots=True, kw_only=True)
class TravelRow:
    """Stiffness against one travel of the hub at one orientation.

    Attributes
    ----------
    way, orientation_deg : which one [deg]
    unit : N/m, or N m/rad
    fe, tire : of the solid wheel and of the tire [unit]; ``tire`` None where it does not stand under the load
    difference : tire over solid wheel, less one [-]; None likewise
    """

    way: str
    orientation_deg: float
    unit: str
    fe: float
    tire: float | None
    difference: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Held:
    """A tire held against the FE curves.

    Attributes
    ----------
    preset : the tire
    flexible_mass_kg : of its plates [kg]
    orientations_deg : of the FE curves that carry load [deg]
    load_range_N : loads of the FE average between which curves are compared [N]
    relative_rms : at each orientation, rms of the difference of load over that of the FE load [-]
    largest_N : at each orientation, largest difference of load [N]
    average : error of the mean over the orientations
    mirrored_rms : as ``relative_rms``, at minus each orientation; None if not asked for or without equilibrium
    travel_load_N : under which the hub was moved [N]; None without travels
    travels : stiffnesses against travel, orientation by orientation; none if not asked for
    """

    preset: TirePreset
    flexible_mass_kg: float
    orientations_deg: tuple[float, ...]
    load_range_N: tuple[float, float]
    relative_rms: tuple[float, ...]
    largest_N: tuple[float, ...]
    average: AverageError
    mirrored_rms: tuple[float, ...] | None
    travel_load_N: float | None
    travels: tuple[TravelRow, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class FittedParameter:
    """A free parameter, its numbers in ``unit``.

    Attributes
    ----------
    name, unit : of the parameter
    value, bounds, start : found, where it may lie, where the search began
    at_bound : it lies on a bound
    interval : 95 % from the fit; None on a bound or where not determined
    """

    name: str
    unit: str
    value: float
    bounds: tuple[float, float]
    start: float
    at_bound: bool
    interval: tuple[float, float] | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Fitted(Held):
    """A tire fitted to the FE curves: what `Held` says, and how well the curves determine its parameters.

    Attributes
    ----------
    correlation : of the unknowns, row by row [-]; None for one that a bound holds
    condition : of their scaled normal matrix [-]; None without
    weakest : direction that the curves determine least, by unknown [-]
    indistinguishable : pairs of names whose correlation is above 0.95
    evaluations : tires solved
    settled : the search ended by its tolerance
    deflections_m : at which loads were fitted [m]
    parameters : the free ones
    phase_trials : the coarse searches it began with
    """

    correlation: tuple[tuple[float | None, ...], ...]
    condition: float | None
    weakest: tuple[float | None, ...]
    indistinguishable: tuple[tuple[str, str], ...]
    evaluations: int
    settled: bool
    deflections_m: tuple[float, ...]
    parameters: tuple[FittedParameter, ...]
    phase_trials: tuple[PhaseTrial, ...]
