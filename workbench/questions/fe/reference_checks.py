"""The average curve against slope and band of ``[reference]``, with what mesh and reference leave open.

Verified by tests/unit/test_workbench_reference_checks.py.
"""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path

import numpy as np

from contracts.curves import Around, StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.questions.mesh_study.results import MeshStudy
from workbench.questions.model_curves import ModelCurves, mean_curve
from workbench.questions.models.agreement import LEAST_COMMON
from workbench.study.reference import BandPoint, BandReference, ReferenceSection, SlopeReference
from workbench.study.reference_file import LoadBand, read_band
from workbench.study.sections import ToleranceSection
from workbench.verdict.rules import Claim, Doubt, at_most, near, within

__all__ = ["combined", "leaves_band", "mesh_share", "reference_checks"]


def reference_checks(
    fe: ModelCurves,
    reference: ReferenceSection,
    tolerances: ToleranceSection,
    around: Around | None = None,
    mesh: MeshStudy | None = None,
) -> list[Check]:
    """Average curve against the slope near first touch and the band of ``[reference]``, as far as it has them.

    Findings: whether the wheel meets a reference is what the computation is asked. ``mesh`` gives the numerical
    uncertainty; where it and the reference's own, root-sum-square, reach across a limit, a check is undecided.
    """
    checks = []
    if (slope := reference.slope) is not None:
        checks.append(_slope_check(_average_of(fe, slope, around), slope, tolerances, mesh))
    if (band := reference.band) is not None:
        checks += [_point_check(fe.average, point, band, mesh) for point in band.points]
        checks += [] if band.file is None else [_band_check(fe.average, read_band(Path(band.file)), band, mesh)]
    return checks


def mesh_share(mesh: MeshStudy | None, curve: StiffnessCurve, start: float, end: float) -> float | None:
    """Numerical uncertainty of a curve's loads from ``start`` to ``end`` [m], relative [-]; None if not known."""
    if mesh is None or curve.unloaded:
        return None
    try:
        return mesh.l2_uncertainty(curve, start, end)
    except InputError:
        return None


def combined(reference: float, mesh: float | None) -> tuple[float, str]:
    """Both relative uncertainties as one, root-sum-square (ASME V&V 20-2009) [-], and in words.

    One of the mesh that is not known counts as zero, and the words say so.
    """
    numerical = "numerical not known" if mesh is None else f"numerical ±{100.0 * mesh:.2g} %"
    return math.hypot(reference, mesh or 0.0), f"uncertainty of the reference ±{100.0 * reference:.2g} %, {numerical}"


def leaves_band(curve: StiffnessCurve, band: LoadBand) -> float:
    """By how much a curve leaves a band: the largest of F/F_high - 1 and 1 - F/F_low, negative within it [-].

    Raises
    ------
    InputError
        If the curve covers less than half of the band.
    """
    first, last = band.deflection[band.deflection > 0.0][[0, -1]]
    within = (band.deflection > 0.0) & (band.deflection >= curve.deflection[0])
    within &= band.deflection <= curve.deflection[-1]
    if not within.any() or band.deflection[within][-1] - first < LEAST_COMMON * (last - first):
        rule = f"covers less than half of the band, {1e3 * first:.3g} to {1e3 * last:.3g} mm"
        raise InputError("curve", f"{1e3 * curve.deflection[-1]:.3g} mm", rule, "compute it further")
    load = curve.load_at(band.deflection[within])
    return float(np.max([load / band.high[within] - 1.0, 1.0 - load / band.low[within]]))


def _average_of(fe: ModelCurves, slope: SlopeReference, around: Around | None) -> StiffnessCurve:
    """Average of the orientations that the slope names, of all if it names none."""
    named = slope.orientations
    if named is None or len(named) >= len(fe.by_orientation):
        return fe.average
    chosen = [c for o, c in fe.by_orientation.items() if any(abs(math.degrees(n) - o) < 1e-6 for n in named)]
    return mean_curve(chosen, around)


def _slope_check(
    average: StiffnessCurve, slope: SlopeReference, tolerances: ToleranceSection, mesh: MeshStudy | None
) -> Check:
    which = "Average FE curve"
    if slope.orientations is not None:
        which += f" of {', '.join(f'{math.degrees(o):g}' for o in slope.orientations)} degrees alone"
    title = f"{which}: slope from first contact to {slope.up_to * 1e3:g} mm"
    claim = _claim("fe.initial_tangent", title, "initial tangent", "N/m", slope)
    share, words = combined(slope.uncertainty, mesh_share(mesh, average, 0.0, slope.up_to))
    doubt = Doubt(width=share * slope.value, words=words)
    return near(claim, lambda: average.initial_tangent(slope.up_to), slope.value, tolerances.initial_tangent, doubt)


def _point_check(average: StiffnessCurve, point: BandPoint, band: BandReference, mesh: MeshStudy | None) -> Check:
    title = f"Average FE curve: deflection at {point.load:g} N"
    claim = _claim(f"fe.deflection_at_{point.load:g}N", title, "deflection", "m", band)
    number = partial(average.deflection_at, point.load)
    try:
        at = number()
        numerical = mesh_share(mesh, average, 0.0, at)
        softness = 1.0 / float(np.interp(at, average.deflection, np.gradient(average.load, average.deflection)))
    except InputError:
        at, numerical, softness = 0.0, None, 0.0
    _, words = combined(band.uncertainty, numerical)
    width = math.hypot(band.uncertainty * at, (numerical or 0.0) * point.load * softness)
    return within(claim, number, point.low, point.high, Doubt(width=width, words=words))


def _band_check(average: StiffnessCurve, loads: LoadBand, band: BandReference, mesh: MeshStudy | None) -> Check:
    title = "Average FE curve: by how much its load leaves the reference's band, negative within it"
    claim = _claim("fe.band", title, "difference", "-", band)
    share, words = combined(band.uncertainty, mesh_share(mesh, average, average.deflection[0], average.deflection[-1]))
    return at_most(claim, lambda: leaves_band(average, loads), 0.0, Doubt(width=share, words=words))


def _claim(id: str, title: str, quantity: str, unit: str, part: SlopeReference | BandReference) -> Claim:
    source = f"{part.kind}: {part.source}"
    return Claim(id=id, title=title, quantity=quantity, unit=unit, role="finding", source=source)
