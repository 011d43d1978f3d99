"""The fitted ANCF tire under the standing rover against the FE curves: orientations, differences, what is allowed.

Orientations of the wheel that are equal: phi and phi + 120 deg by its period, phi and -phi where it is its own mirror
image. Those without a solid run are solved by the planar section model. An ANCF tire repeats itself after 360 deg over
its spokes. Verified by tests/unit/test_workbench_rover_crosscheck.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError

if TYPE_CHECKING:
    from workbench.questions.mesh_study.results import MeshStudy

__all__ = [
    "ALLOWED",
    "STEP",
    "CrossCheck",
    "Difference",
    "LoadRow",
    "StoodTire",
    "WheelPoint",
    "image",
    "lattice",
    "unsolved",
]

STEP = 5.0
"""Between orientations [deg]."""
ALLOWED = 0.05
"""Beside the numerical uncertainty of the FE load [-]."""
_SAME = 1e-6


def lattice(period: float) -> list[float]:
    """Orientations [deg] from 0 in equal steps until a wheel repeats itself; steps of `STEP` or a little less."""
    n = int(np.ceil(period / STEP - _SAME))
    return [round(period * i / n, 9) for i in range(n)]


def image(orientation: float, period: float, mirrored: bool) -> float:
    """The equal orientation [deg] in 0 ... period, or 0 ... period / 2 of a wheel that is its own mirror image."""
    phi = orientation % period
    if period - phi < _SAME:
        phi = 0.0
    return round(period - phi if mirrored and phi > 0.5 * period + _SAME else phi, 9)


def unsolved(solid: Sequence[float], period: float, mirrored: bool) -> list[float]:
    """Orientations [deg] of the lattice, up to equal ones, that no solid run has."""
    known = [image(o, period, mirrored) for o in solid]
    wanted = dict.fromkeys(image(o, period, mirrored) for o in lattice(period))
    return [o for o in wanted if not any(abs(o - k) < _SAME for k in known)]


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelPoint:
    """One wheel of the rover at rest: mean load of all six [N], orientation [deg], own load [N], deflection [m]."""

    mean_load: float
    orientation: float
    load: float
    deflection: float


@dataclass(frozen=True, slots=True, kw_only=True)
class StoodTire:
    """A fitted tire under the rover: its name, its period [deg], its points or why there is none."""

    name: str
    period: float
    points: tuple[WheelPoint, ...]
    failure: str | None = None

    def at(self, mean_load: float, orientation: float) -> WheelPoint:
        """The wheel at an orientation [deg], or at an equal one; raises InputError if the rover did not stand there."""
        phi = orientation % self.period
        for point in self.points:
            away = abs(point.orientation - phi)
            if abs(point.mean_load - mean_load) < _SAME and min(away, self.period - away) < _SAME:
                return point
        raise InputError(
            "orientation", f"{phi:g} deg at {mean_load:g} N", "was not stood on", self.failure or "stand it"
        )

    @property
    def loads(self) -> list[float]:
        """Mean wheel loads [N], ascending."""
        return sorted({point.mean_load for point in self.points})


@dataclass(frozen=True, slots=True, kw_only=True)
class Difference:
    """A wheel point against one FE curve.

    Attributes
    ----------
    orientation : of the FE wheel [deg]
    point : the ANCF wheel
    model : "solid", "section" or "average"
    deflection : FE's at the wheel's load [m]
    in_load : load over the FE's at equal deflection, less one [-]
    in_deflection : deflection over the FE's at equal load, less one [-]
    allowed : numerical uncertainty of the FE load there and `ALLOWED` [-]
    """

    orientation: float
    point: WheelPoint
    model: str
    deflection: float
    in_load: float
    in_deflection: float
    allowed: float

    @property
    def largest(self) -> float:
        """The larger of both differences, its size [-]."""
        return max(abs(self.in_load), abs(self.in_deflection))

    @property
    def beyond(self) -> float:
        """The same less what is allowed [-]."""
        return self.largest - self.allowed

    @property
    def inside(self) -> bool:
        """Whether load and deflection both differ by no more than what is allowed."""
        return self.beyond <= 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Warmth:
    """The standing rover at a temperature [K]: modulus over that at 20 C [-], mean deflection of its wheels [m]."""

    temperature: float
    modulus_ratio: float
    deflection: float


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadRow:
    """The kept tire at one mean load: its mean against the average, orientations inside, the worst; rover's weight?"""

    mean: Difference
    inside: int
    worst: Difference
    own: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class CrossCheck:
    """All that is compared.

    Attributes
    ----------
    stood : fitted tires under the rover
    kept : the one with a load sweep
    solid, section : FE curves by orientation [deg]; section without those the solid model has
    average : of the solid ones
    period, mirrored : of the FE wheel
    mesh_study : numerical uncertainty of the FE load
    static_load : mean wheel load of the rover [N]
    warmth : the kept tire with its stiffness scaled as the metal's modulus
    """

    stood: tuple[StoodTire, ...]
    kept: str
    solid: Mapping[float, StiffnessCurve]
    section: Mapping[float, StiffnessCurve]
    average: StiffnessCurve
    period: float
    mirrored: bool
    mesh_study: MeshStudy
    static_load: float
    warmth: tuple[Warmth, ...] = ()

    def fe_deflection(self, modulus_ratio: float) -> float:
        """Of the FE average under the rover with another modulus [m]: all loads of an elastic wheel go as E."""
        return self.average.deflection_at(self.static_load / modulus_ratio)

    @property
    def best(self) -> StoodTire:
        """The kept tire; raises InputError with the reason if it does not stand."""
        tire = next(tire for tire in self.stood if tire.name == self.kept)
        if not tire.points:
            raise InputError(
                "fitted ANCF tire", tire.name, f"does not carry the rover: {tire.failure}", "look at its fit"
            )
        return tire

    def reference(self, orientation: float) -> tuple[str, StiffnessCurve]:
        """Model and FE curve at an orientation [deg], by symmetry; raises InputError if there is none."""
        phi = image(orientation, self.period, self.mirrored)
        for model, curves in (("solid", self.solid), ("section", self.section)):
            for o, curve in curves.items():
                if abs(image(o, self.period, self.mirrored) - phi) < _SAME:
                    return model, curve
        raise InputError("FE orientation", f"{phi:g} deg", "was not solved", "add it to fe.orientations")

    def difference(self, point: WheelPoint, orientation: float, *, average: bool = False) -> Difference:
        """A wheel against the FE at an orientation [deg], or against the average; InputError beyond a curve's end."""
        model, curve = ("average", self.average) if average else self.reference(orientation)
        uncertainty = float(self.mesh_study.relative_uncertainty(np.array([point.deflection]))[0])
        deflection = curve.deflection_at(point.load)
        return Difference(
            orientation=orientation,
            point=point,
            model=model,
            deflection=deflection,
            in_load=point.load / float(curve.load_at(point.deflection)) - 1.0,
            in_deflection=point.deflection / deflection - 1.0,
            allowed=uncertainty + ALLOWED,
        )

    def around(self, tire: StoodTire, mean_load: float) -> list[Difference]:
        """Each orientation of the FE wheel's period against its own curve."""
        return [self.difference(tire.at(mean_load, o), o) for o in lattice(self.period)]

    def on_average(self, tire: StoodTire, mean_load: float) -> Difference:
        """Mean over the orientations of the FE wheel's period against the FE average."""
        each = [self.difference(tire.at(mean_load, o), o, average=True) for o in lattice(self.period)]
        mean = WheelPoint(
            mean_load=mean_load,
            orientation=float("nan"),
            load=float(np.mean([d.point.load for d in each])),
            deflection=float(np.mean([d.point.deflection for d in each])),
        )
        return Difference(
            orientation=float("nan"),
            point=mean,
            model="average",
            deflection=float(np.mean([d.deflection for d in each])),
            in_load=float(np.mean([d.in_load for d in each])),
            in_deflection=float(np.mean([d.in_deflection for d in each])),
            allowed=min(d.allowed for d in each),
        )

    @property
    def lattice(self) -> list[float]:
        """Orientations compared [deg]."""
        return lattice(self.period)

    @property
    def rows(self) -> list[LoadRow]:
        """One for each mean load of the kept tire."""
        found = []
        for load in self.best.loads:
            each = self.around(self.best, load)
            found.append(
                LoadRow(
                    mean=self.on_average(self.best, load),
                    inside=sum(d.inside for d in each),
                    worst=max(each, key=lambda d: d.beyond),
                    own=abs(load - self.static_load) < _SAME,
                )
            )
        return found

    def spread(self, tire: StoodTire) -> tuple[float, float]:
        """Root mean square over the orientations of the deflection's deviation from its mean, tire and FE [-]."""
        found = self.around(tire, self.static_load)
        both = np.array([(d.point.deflection, d.deflection) for d in found])
        ours, fe = both.std(axis=0) / both.mean(axis=0)
        return float(ours), float(fe)

    def correlation(self, tire: StoodTire) -> float:
        """Of the tire's deflection with the FE's over the orientations, at the static load [-]."""
        found = self.around(tire, self.static_load)
        return float(np.corrcoef([d.point.deflection for d in found], [d.deflection for d in found])[0, 1])

    def shared(self, tire: StoodTire) -> float:
        """Part of the FE deflection's variance around the wheel in waves that a tire of this period can have [-]."""
        waves = np.abs(np.fft.rfft([d.deflection for d in self.around(tire, self.static_load)])[1:]) ** 2
        turns = np.arange(1, len(waves) + 1) * 360.0 / self.period
        possible = np.abs(np.mod(turns + 0.5, 360.0 / tire.period) - 0.5) < _SAME
        return float(waves[possible].sum() / waves.sum())
