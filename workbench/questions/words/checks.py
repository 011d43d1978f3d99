"""The thesis' sentences as findings, and which of them hold. Verified by tests/unit/test_workbench_thesis_words.py."""

from __future__ import annotations

from functools import partial

from contracts.curves import StiffnessCurve
from contracts.records import Check
from workbench.questions.words.results import AVERAGE, FOLLOWS, LOADS, SMALL, SPREAD_AT, Words, follows, spread
from workbench.verdict.rules import Claim, Doubt, at_least, at_most, near

__all__ = ["verdicts", "words_checks"]

SLOPE, END, FAILS = 0.03, 0.05, 0.05
"""Relative: slope up to 5 mm, load at the 160 N end, and by how much the brush line must fail at the 250 N end."""
BAND = 0.02
"""By how much the solid model's average may leave the band of the section model's, relative."""


def words_checks(words: Words) -> list[Check]:
    """Each sentence as findings."""
    low, high = LOADS
    slope, reading = words.brush_slope, words.reading.text
    checks = [
        near(
            _claim(
                "small.slope", f"slope of the average up to {1e3 * SMALL:g} mm, and the brush line's", "slope", "N/m"
            ),
            lambda: words.average.initial_tangent(SMALL),
            slope,
            SLOPE,
            _doubt(words.mesh, slope),
        ),
        near(
            _claim("small.end", f"load of the average where the brush line carries {low:g} N", "load", "N"),
            lambda: float(words.average.load_at(low / slope)),
            low,
            END,
            _doubt(words.mesh, low),
        ),
        at_least(
            _claim("brush_fails", f"distance of average and brush line where that carries {high:g} N", "difference"),
            lambda: abs(words.brush_misses(high)),
            FAILS,
        ),
    ]
    for deflection, limit in AVERAGE.items():
        text = f"average over that of the thesis' tire ({reading}), at {1e3 * deflection:g} mm"
        claim = _claim(f"average_{1e3 * deflection:g}mm", text, "load / load")
        checks.append(near(claim, partial(words.average_over, words.tire, deflection), 1.0, limit, _doubt(words.mesh)))
    for orientation, curve in words.tire.by_orientation.items():
        text = (
            f"the thesis' tire ({reading}) at {orientation:g} deg, {low:g} to {high:g} N, "
            "and the nearest orientation of the wheel"
        )
        claim = _claim(f"follows_{orientation:g}deg", text, "largest relative difference")
        distance = partial(_follows, words, curve)
        checks.append(at_most(claim, distance, FOLLOWS, _doubt(words.mesh)))
    own, twin = partial(spread, words.section, SPREAD_AT), partial(spread, words.twin, SPREAD_AT)
    of_all = f"over that of the wheel as it is, at {1e3 * SPREAD_AT:g} mm (section model)"
    checks += [
        at_least(
            _claim(
                "out_of_phase", f"spread of the orientations with all springs in phase, {of_all}", "spread / spread"
            ),
            lambda: twin() / own(),
            1.0,
        ),
        at_most(
            _claim("no_yielding", f"largest linearised stress over yield strength at {high:g} N", "stress / yield"),
            partial(words.stress, high),
            1.0,
        ),
        at_most(
            _claim("stable", f"negative eigenvalues of the tangent up to {high:g} N", "count"),
            partial(words.negative_pivots, high),
            0.0,
        ),
        at_most(
            _claim("band", "distance of the average from the band of the plausible set", "difference"),
            lambda: words.plausible.outside(words.average),
            BAND,
            _doubt(words.mesh),
        ),
    ]
    return checks


def _follows(words: Words, curve: StiffnessCurve) -> float:
    return follows(words.fe, curve)[1]


def _doubt(mesh: float | None, of: float = 1.0) -> Doubt:
    """What the mesh leaves open ``of`` a number; of the band's distance, its own uncertainty is the limit."""
    if mesh is None:
        return Doubt(width=0.0, words="numerical uncertainty not known")
    return Doubt(width=mesh * of, words=f"numerical uncertainty ±{100.0 * mesh:.2g} %")


def _claim(name: str, title: str, quantity: str, unit: str = "-") -> Claim:
    source = "the thesis' words, read as numbers by us; no independent evidence, the wheel is chosen by them"
    title = title[0].upper() + title[1:]
    return Claim(id=f"words.{name}", title=title, quantity=quantity, unit=unit, role="finding", source=source)


_STATEMENTS = {
    "small": ("small.slope", "small.end"),
    "brush_fails": ("brush_fails",),
    "averages": ("average_",),
    "follows": ("follows_",),
    "out_of_phase": ("out_of_phase",),
    "ours": ("no_yielding", "stable"),
}
"""Statement -> how the names of its findings begin."""


def verdicts(words: Words) -> dict[str, str]:
    """By statement: "holds", "does not hold", or "not decided" where a finding that it needs was not evaluated, or the
    mesh of the curves does not know it well enough.

    Of the two readings of the first one is enough.
    """
    found = {check.id.removeprefix("words."): check.status for check in words_checks(words)}
    told = {}
    for statement, names in _STATEMENTS.items():
        statuses = [status for name, status in found.items() if name.startswith(names)]
        holds = any(s == "pass" for s in statuses) if statement == "small" else all(s == "pass" for s in statuses)
        undecided = bool({"error", "undecided"} & set(statuses)) and (statement == "small" or "fail" not in statuses)
        told[statement] = "holds" if holds else "not decided" if undecided else "does not hold"
    return told
