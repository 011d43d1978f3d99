"""What became of each point of a parameter study: its curves, and the numbers read from them.

Verified by tests/unit/test_workbench_sweep.py.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.curves import Around, StiffnessCurve, read_curve
from contracts.errors import InputError
from contracts.hub_travel import Way
from contracts.travel_curve import read_travel
from workbench.execution.result_files import early_ends
from workbench.execution.store import Entry
from workbench.execution.task import bare_name
from workbench.questions.model_curves import CURVE, distances_from, mean_curve
from workbench.questions.models.metrics import compare_curves
from workbench.questions.sweep.graph import SweepGraph, SweepRun
from workbench.questions.sweep.wheel_facts import WheelFacts, wheel_facts, wheel_numbers
from workbench.questions.travel_start import TRAVEL
from workbench.questions.wheel.graph import MESH
from workbench.study.curve_file import read_measured_curve
from workbench.study.full import around
from workbench.study.model import Study
from workbench.study.sweep import SweepSection

__all__ = [
    "Outcome",
    "Reference",
    "measured",
    "nearest_orientation",
    "outcomes",
    "own_curves",
    "pivots_up_to",
    "references",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """One model at one point.

    Attributes
    ----------
    run : point, model and tasks
    by_orientation : curve of each orientation; none where a task failed
    curve : their mean, the curve itself where there is one orientation only; None where a task failed
    note : why there is no curve, or why it ends early
    wall_s : of all its tasks [s], those it shares with other points included
    wheel : the wheel's masses, room and strengths; None where they are not known
    travels : way -> what holds back the hub that is moved so, mean of the orientations [N/m; N m/rad]
    """

    run: SweepRun
    by_orientation: tuple[StiffnessCurve, ...] = ()
    curve: StiffnessCurve | None = None
    note: str = ""
    wall_s: float | None = None
    wheel: WheelFacts | None = None
    travels: Mapping[Way, float] = field(default_factory=dict)

    @property
    def state(self) -> str:
        """``"whole"``, ``"partial"``: the curve ends before its target or a travel is not there, or ``"failed"``."""
        if self.curve is None:
            return "failed"
        return "partial" if self.curve.partial or self.run.travels.keys() - self.travels.keys() else "whole"


@dataclass(frozen=True, slots=True, kw_only=True)
class Reference:
    """The curve that others are held against, what it is called, and what it is the mean of, by orientation [deg]."""

    label: str
    curve: StiffnessCurve
    by_orientation: Mapping[float, StiffnessCurve] = field(default_factory=dict)

    def beside(self, outcome: Outcome) -> Reference:
        """For an outcome at one orientation alone the curve at that one, not the mean, if there is such a curve."""
        (only, *more) = outcome.by_orientation or (None,)
        at = None if only is None or more else only.orientation_deg
        if at is None or len(self.by_orientation) < 2 or at not in self.by_orientation:
            return self
        return Reference(label=f"{self.label}, {at:g} deg", curve=self.by_orientation[at])


def outcomes(graph: SweepGraph, entries: Mapping[str, Entry], failures: Mapping[str, str]) -> list[Outcome]:
    """What became of every run of the graph, by the results and the failures of its tasks."""
    return [_outcome(run, entries, failures) for run in graph.runs]


def _outcome(run: SweepRun, entries: Mapping[str, Entry], failures: Mapping[str, str]) -> Outcome:
    missing = [name for name in run.tasks if name not in entries]
    told = list(dict.fromkeys(failures[name] for name in missing if name in failures))
    moved = {name for names in run.travels.values() for name in names.values()}
    mesh = next((entries[name].path for name in run.tasks if bare_name(name) == MESH and name in entries), None)
    wheel = wheel_facts(run.point.study, mesh)
    if not moved.issuperset(missing):
        return Outcome(run=run, note="; ".join(told), wheel=wheel)
    folders = {name: entries[task].path for name, task in run.curves.items()}
    curves = []
    for name, folder in folders.items():
        _, _, orientation = name.partition("_phi")
        curves.append(
            read_curve(folder / CURVE, model=run.model, orientation_deg=float(orientation) if orientation else None)
        )
    return Outcome(
        run=run,
        by_orientation=tuple(curves),
        curve=curves[0] if len(curves) == 1 else mean_curve(curves, _around(run)),
        note="; ".join(_reach(curves) + list(early_ends(folders).values()) + told),
        wall_s=sum(entries[name].wall_s for name in run.tasks if name in entries),
        wheel=wheel,
        travels=_travels(run, entries),
    )


def _travels(run: SweepRun, entries: Mapping[str, Entry]) -> dict[Way, float]:
    """Stiffness against each way, mean of the orientations by the arcs they stand for; none where one has none."""
    found: dict[Way, float] = {}
    for way, names in run.travels.items():
        paths = {o: entries[name].path / TRAVEL for o, name in names.items() if name in entries}
        if len(paths) == len(names) and all(path.exists() for path in paths.values()):
            each = [read_travel(path, run.model, way, o).stiffness for o, path in paths.items()]
            found[way] = float(np.average(each, weights=around(run.point.study).weights(list(paths))))
    return found


def _around(run: SweepRun) -> Around | None:
    """Of a curve of the wheel; a fitted ANCF tire's orientations count alike."""
    return around(run.point.study) if run.model in ("fe", "section", "ancf_wheel") else None


def _reach(curves: Sequence[StiffnessCurve]) -> list[str]:
    """How far those came that end early."""
    return [
        "converged nowhere" if c.unloaded else f"ends at {1e3 * c.deflection[-1]:.3g} mm and {c.load[-1]:.4g} N"
        for c in curves
        if c.partial
    ]


def references(study: Study, folder: Path, found: Sequence[Outcome]) -> dict[str, Reference]:
    """What each model is held against: the first curve of its reference, else the model's curve of the study as it is.

    ``folder`` is where the study's files lie. A model without either has none.
    """
    models = dict.fromkeys(outcome.run.model for outcome in found)
    if study.reference_curves:
        section = study.reference_curves[0]
        own = Reference(label=section.label, curve=read_measured_curve(Path(section.file)).curve)
        return dict.fromkeys(models, own)
    label = "the study as it is"
    base = {o.run.model: o for o in found if o.run.point.number == 0}
    return {
        model: Reference(label=label, curve=one.curve, by_orientation=_loaded(one))
        for model, one in base.items()
        if one.curve is not None and not one.curve.unloaded
    }


def _loaded(outcome: Outcome) -> dict[float, StiffnessCurve]:
    """Its curves that carry a load, by orientation [deg]."""
    return {c.orientation_deg: c for c in outcome.by_orientation if c.orientation_deg is not None and not c.unloaded}


def own_curves(study: Study) -> dict[str, StiffnessCurve]:
    """The reference's curves by their labels: small letters, underscores for what is neither letter nor digit."""
    curves = study.reference_curves
    names = [re.sub(r"[^0-9a-z]+", "_", one.label.lower()).strip("_") for one in curves]
    files = [Path(one.file) for one in curves]
    return {name: read_measured_curve(file).curve for name, file in zip(names, files, strict=True)}


def measured(
    outcome: Outcome,
    section: SweepSection,
    up_to: float,
    reference: Reference | None = None,
    followed: Mapping[str, StiffnessCurve] | None = None,
) -> dict[str, float | str | None]:
    """Numbers of one outcome by name, with units in the names; None where the curve does not reach.

    Parameters
    ----------
    outcome : one model at one point
    section : deflections [m] and loads [N] at which the curve is read
    up_to : range of the initial tangent [m]
    reference : what the curve is held against over the range both have, up to the largest of the section's loads; of a
        mean over orientations, an outcome at one of them is held against the curve at that one
    followed : curves that some orientation may follow between the section's loads, by a name for their column
    """
    curve = outcome.curve if outcome.curve is not None and not outcome.curve.unloaded else None
    found: dict[str, float | str | None] = {
        "initial_tangent_N_per_m": _or_none(curve, lambda c: c.initial_tangent(up_to))
    }
    for d in section.deflections:
        found[f"load_at_{1e3 * d:g}mm_N"] = _or_none(curve, lambda c, d=d: float(c.load_at(d)))  # type: ignore[misc]
    for load in section.loads:
        found[f"deflection_at_{load:g}N_m"] = _or_none(curve, lambda c, load=load: c.deflection_at(load))  # type: ignore[misc]
    for load in section.loads:
        found[f"max_von_mises_at_{load:g}N_Pa"] = _largest_stress(outcome.by_orientation, load, "max_von_mises_")
    for load in section.loads:
        found[f"max_linearised_at_{load:g}N_Pa"] = _largest_stress(outcome.by_orientation, load, "max_linearised_")
    for d in section.deflections:
        found[f"spread_at_{1e3 * d:g}mm"] = None if curve is None else _spread(curve, d)
    found |= wheel_numbers(outcome.wheel, curve, outcome.by_orientation, section.loads)
    for way in section.travels:
        unit = "N_m_per_rad" if way.turns else "N_per_m"
        found[f"{way}_stiffness_at_{section.loads[0]:g}N_{unit}"] = outcome.travels.get(way)
    found["negative_pivots"] = _negative_pivots(outcome.by_orientation, max(section.loads))
    for name, own in (followed or {}).items():
        loads = min(section.loads), max(section.loads)
        found[f"follows_{name}"] = nearest_orientation(outcome.by_orientation, own, loads)
    metrics, beside = None, None if reference is None else reference.beside(outcome)
    if beside is not None:
        metrics = _or_none(curve, lambda c: compare_curves(c, beside.curve, max(section.loads)))
    found["relative_l2"] = None if metrics is None else metrics.relative_l2
    found["held_against"] = None if metrics is None or beside is None else beside.label
    return found


def _or_none[T](curve: StiffnessCurve | None, read: Callable[[StiffnessCurve], T]) -> T | None:
    try:
        return None if curve is None else read(curve)
    except InputError:  # beyond the curve's end
        return None


def _spread(curve: StiffnessCurve, deflection: float) -> float | None:
    """Largest less smallest load of the orientations, over their mean [-], at a deflection [m]."""
    if deflection > curve.deflection[-1] or "load_min_N" not in curve.columns:
        return None
    low, high = (np.interp(deflection, curve.deflection, curve.columns[f"load_{end}_N"]) for end in ("min", "max"))
    return float((high - low) / curve.load_at(deflection))


def _negative_pivots(curves: Sequence[StiffnessCurve], load: float) -> float | None:
    """Largest number of negative pivots of all orientations up to a load [N]."""
    counts = [count for curve in curves if (count := pivots_up_to(curve, load)) is not None]
    return max((float(np.max(count)) for count in counts), default=None)


def pivots_up_to(curve: StiffnessCurve, load: float) -> NDArray[np.float64] | None:
    """Negative pivots at each point up to the first that bears the load [N], at all if none does; None if uncounted."""
    counts, reached = curve.columns.get("negative_pivots"), np.flatnonzero(curve.load >= load)
    return counts if counts is None or not len(reached) else counts[: int(reached[0]) + 1]


def nearest_orientation(
    curves: Sequence[StiffnessCurve], reference: StiffnessCurve, loads: tuple[float, float]
) -> float | None:
    """How nearly the best of the orientations follows a curve [-].

    Smallest, over the orientations, of the largest |F/F_ref - 1| at the points of the reference whose loads lie within
    ``loads`` [N]; None where no orientation reaches them all.
    """
    misses = distances_from(curves, reference, loads)
    return min((miss for miss in misses if miss is not None), default=None)


def _largest_stress(curves: Sequence[StiffnessCurve], load: float, kind: str) -> float | None:
    """Largest stress [Pa] of all parts and orientations where the load [N] is reached; None if one is not."""
    found = []
    for curve in curves:
        stresses = [values for name, values in curve.columns.items() if name.startswith(kind)]
        deflection = _or_none(curve, lambda c: c.deflection_at(load))
        if not stresses or deflection is None:
            return None
        found.append(max(float(np.interp(deflection, curve.deflection, values)) for values in stresses))
    return max(found, default=None)
