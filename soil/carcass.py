"""How the rim of a wheel gives way to what presses on it, by harmonics of the angle around it.

A force f(theta) [N/rad] on the rim, towards the hub, moves it by

    w(theta) = int G(theta - theta') f(theta') d theta',    G(theta) = sum_m g_m cos(m theta)    [m/N],

G the mean over what of the wheel faces the ground. Of a pressure p it is b p (R - w), whichever way the rim leans: the
force conjugate to w, so that pressure alone makes no moment about the hub, as G is even. The wheel pressed on rigid
ground under a load N tells it: its patch is short, so that w = N G there. G is then a secant at that load; at another
one it is as much stiffer or softer as the wheel's own curve. What G does not know: that the patch has a length, and
that a spring here or there changes the shape.

Verified by tests/unit/test_soil_carcass.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError

__all__ = ["HARMONICS", "RIGID", "Carcass", "RimShape", "carcass_from_shapes", "shape_under"]

FloatArray = NDArray[np.float64]
HARMONICS = 12
"""Largest m that is taken from shapes: waves of 75 mm on a wheel of 285 mm; shorter ones bend a rim hardly."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Carcass:
    """Compliance by harmonics.

    Attributes
    ----------
    compliance : g_0, g_1, ... [m/N]; empty for a rim that is rigid and held rigidly
    load : at which it is a secant [N]
    curve : loads [N], ascending, with the deflections [m] of the hub on rigid ground; empty for a line
    source : what it is from
    """

    compliance: tuple[float, ...] = ()
    load: float = 0.0
    curve: tuple[tuple[float, float], ...] = ()
    source: str = "rigid"

    def at(self, load: float) -> Carcass:
        """The secant at another load [N]; beyond the curve that at its end."""
        if not self.curve:
            return self
        loads, ways = np.array(self.curve).T
        here, there = (float(np.interp(x, loads, ways / loads)) for x in (load, self.load))
        return replace(self, compliance=tuple(here / there * g for g in self.compliance), load=load)

    @property
    def deflection_per_load(self) -> float:
        """Of the hub over a point of rigid ground, G(0) [m/N]."""
        return math.fsum(self.compliance)


RIGID = Carcass()


class RimShape(NamedTuple):
    """w(theta) = sum_m a_m cos(m theta) + b_m sin(m theta) [m], towards the hub."""

    cosines: FloatArray
    sines: FloatArray

    def at(self, angle: FloatArray) -> tuple[FloatArray, FloatArray]:
        """w and dw/d theta at angles (n,) [m]."""
        m = np.arange(len(self.cosines))
        turned = np.multiply.outer(angle, m)
        cosine, sine = np.cos(turned), np.sin(turned)
        return cosine @ self.cosines + sine @ self.sines, cosine @ (m * self.sines) - sine @ (m * self.cosines)


def shape_under(carcass: Carcass, angle: FloatArray, force: FloatArray) -> RimShape:
    """Shape of the rim under forces (n,) [N], towards the hub, at angles (n,) [rad]."""
    g = np.array(carcass.compliance)
    turned = np.multiply.outer(np.arange(len(g)), angle)
    return RimShape(g * (np.cos(turned) @ force), g * (np.sin(turned) @ force))


def carcass_from_shapes(shapes: Sequence[tuple[FloatArray, FloatArray]], load: float, source: str) -> Carcass:
    """Compliance from the rim's shapes on rigid ground under one load.

    Parameters
    ----------
    shapes : for each orientation, angles (n,) from the ground's direction [rad], all around, and how far the rim moved
        towards the hub there (n,) [m]; the mean over orientations and both sides is taken
    load : of each [N]
    source : what they are from

    Raises
    ------
    InputError
        For a load that is not above zero, or angles that leave a gap of more than a harmonic's half wave.
    """
    if not (math.isfinite(load) and load > 0.0):
        raise InputError("load of the carcass", f"{load:g} N", "must be above zero", "give e.g. 200 N")
    found = [_harmonics(angle, moved) for angle, moved in shapes]
    mean = np.mean(found, axis=0) / load
    return Carcass(compliance=tuple(float(g) for g in mean), load=load, source=source)


def _harmonics(angle: FloatArray, moved: FloatArray) -> FloatArray:
    """Cosine coefficients of a shape (HARMONICS + 1,) [m], from a line through its points."""
    order = np.argsort(np.mod(angle, 2.0 * np.pi))
    at, w = np.mod(angle, 2.0 * np.pi)[order], moved[order]
    widest = float(np.diff(np.concatenate([at, [at[0] + 2.0 * np.pi]])).max()) if len(at) else 2.0 * np.pi
    if widest > np.pi / HARMONICS:
        value = f"{math.degrees(widest):.3g} deg"
        rule = f"must be at most {180.0 / HARMONICS:g} deg"
        raise InputError("gap between points of the rim", value, rule, "give a finer mesh")
    even = np.linspace(0.0, 2.0 * np.pi, 32 * HARMONICS, endpoint=False)
    values = np.interp(even, at, w, period=2.0 * np.pi)
    spectrum = np.fft.rfft(values).real[: HARMONICS + 1] / len(even)
    spectrum[1:] *= 2.0
    return np.asarray(spectrum)
