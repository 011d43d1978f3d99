"""What a designer weighs of one outcome: mass, stiffness, strength and the room that is left.

Verified by tests/unit/test_workbench_trade_offs.py.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from geometry.closed_form import closed_form_volume, part_masses
from workbench.questions.strength.yielding import judged_stress, largest_utilisation
from workbench.questions.wheel.question import mesh_numbers
from workbench.study.laws import HUB_PARTS
from workbench.study.model import Study
from workbench.study.own_mesh import own_mesh
from workbench.study.strengths import yield_strengths
from workbench.study.wheel_design import wheel_design

__all__ = ["WheelFacts", "stress_kinds", "wheel_facts", "wheel_numbers"]


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelFacts:
    """What a wheel has before anything presses on it.

    Attributes
    ----------
    masses : of each part, in closed form from its dimensions, or on its mesh where that comes from a file [kg]
    room : from the hub's outer to the rim's inner face [m]; None where nobody knows, or the ground is not flat
    strengths : yield strength of each part that is judged [Pa]
    """

    masses: Mapping[str, float]
    room: float | None
    strengths: Mapping[str, float]


def wheel_facts(study: Study, mesh: Path | None = None) -> WheelFacts:
    """The facts of a study's wheel; ``mesh`` is the folder of its mesh, without which one from a file has no mass."""
    strengths = yield_strengths(study)
    if own_mesh(study) is not None:
        parts = {} if mesh is None else mesh_numbers(study, mesh).parts
        return WheelFacts(masses={name: part.mass for name, part in parts.items()}, room=None, strengths=strengths)
    design = wheel_design(study)
    masses = part_masses(closed_form_volume(design, half_width=False), design.materials)
    flat = study.fe.obstacle.shape == "plane" and not study.fe.turned
    room = design.tire.inner_radius - design.outer_hub.outer_radius if flat else None
    return WheelFacts(masses=masses, room=room, strengths=strengths)


def wheel_numbers(
    facts: WheelFacts | None, mean: StiffnessCurve | None, curves: Sequence[StiffnessCurve], loads: Iterable[float]
) -> dict[str, float | None]:
    """Mass, and at each load [N] stiffness, strength and room, by names with units; None where it is not known.

    ``mass_kg`` is all parts', ``mass_off_hub_kg`` that of all but hubs, cone and impact springs. Stiffness is the
    secant, load over deflection, of the mean and of the softest and the stiffest orientation. ``utilisation`` is the
    largest of any part at any orientation, up to the load, ``weakest`` the orientation that has it. ``gap`` is the room
    between hub and rim less the largest deflection; a rim that is dented has less.
    """
    masses = {} if facts is None else facts.masses
    off_hub = [mass for part, mass in masses.items() if part not in HUB_PARTS]
    found: dict[str, float | None] = {
        "mass_kg": sum(masses.values()) if masses else None,
        "mass_off_hub_kg": sum(off_hub) if masses else None,
    }
    for load in loads:
        each = [_deflection(curve, load) for curve in curves]
        known = [d for d in each if d is not None and d > 0.0] if mean is not None else []
        whole = len(known) == len(curves) > 0
        middle = _deflection(mean, load) if mean is not None else None
        found[f"stiffness_at_{load:g}N_N_per_m"] = load / middle if middle else None
        found[f"lowest_stiffness_at_{load:g}N_N_per_m"] = load / max(known) if whole else None
        found[f"highest_stiffness_at_{load:g}N_N_per_m"] = load / min(known) if whole else None
        strongest = _weakest(facts, curves, load)
        found[f"utilisation_at_{load:g}N"], found[f"weakest_at_{load:g}N_deg"] = strongest or (None, None)
        room = None if facts is None else facts.room
        found[f"gap_at_{load:g}N_m"] = room - max(known) if whole and room is not None else None
    return found


def _deflection(curve: StiffnessCurve, load: float) -> float | None:
    try:
        return curve.deflection_at(load)
    except InputError:  # beyond the curve's end
        return None


def _weakest(
    facts: WheelFacts | None, curves: Sequence[StiffnessCurve], load: float
) -> tuple[float, float | None] | None:
    """Largest utilisation [-] and its orientation [deg]; None where an orientation does not come to the load."""
    if facts is None or not curves:
        return None
    try:
        used = [largest_utilisation(curve, facts.strengths, load) for curve in curves]
    except InputError:  # no stress, or beyond the curve's end
        return None
    most = int(np.argmax(used))
    return used[most], curves[most].orientation_deg


def stress_kinds(facts: WheelFacts | None, curves: Sequence[StiffnessCurve]) -> str:
    """Which stress of each part is judged, in words: ``"leaves linearised, grousers von Mises"``; else ``""``."""
    if facts is None or not curves:
        return ""
    kinds = []
    for part in facts.strengths:
        stress = [judged_stress(curve, part) for curve in curves]
        if all(one is not None for one in stress):
            peak = all(
                one is curve.columns.get(f"max_von_mises_{part}_Pa") for one, curve in zip(stress, curves, strict=True)
            )
            kinds.append(f"{part} {'von Mises' if peak else 'linearised'}")
    return ", ".join(kinds)
