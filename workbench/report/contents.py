"""What stands where in the report: groups, their sections, and the section a check belongs to.

Verified by tests/unit/test_workbench_contents.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from contracts.records import Check
from workbench.study.model import Study
from workbench.topics.registry import topics_of

__all__ = ["Group", "Section", "contents", "section_of", "section_titles"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """One section: ``templates/section_{name}.html.j2``, and its title in the contents."""

    name: str
    title: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Group:
    """Sections under one heading of the contents."""

    title: str
    sections: Sequence[Section]


_WHEEL = ("wheel", "fe", "orientations", "strength", "mesh_study", "contact", "section", "hub", "environment")
_TIRE = ("ancf", "ancf_fit", "ancf_mesh", "ancf_dynamics")
_ROVER = ("rover", "rover_mission", "rover_ancf", "rover_crosscheck", "rover_closer")
_SOLVERS = ("verification", "multibody", "speed", "numerics")
_LAST = "Behind the numbers"
_GROUPS: Mapping[str, Sequence[str]] = {
    "Result": ("models",),
    "Wheel": _WHEEL,
    "ANCF tire": _TIRE,
    "Rover": _ROVER,
    "Solvers": _SOLVERS,
    _LAST: (),
}
"""Group -> names of its sections; a section named nowhere stands in the last one."""

_FIRST = {"models": "Models compared", "wheel": "Wheel", "fe": "Finite elements"}
_ANCF = {"ancf": "ANCF"}
_REST = {
    "numerics": "Mesh and solver",
    "checks": "All checks",
    "evidence": "Evidence",
    "chosen": "Chosen and inferred",
    "origin": "Timings, provenance",
    "reading": "How to read this",
}

_SECTIONS = {
    "fe.mesh_uncertainty": "mesh_study",
    "fe.penalty_study": "contact",
    "fe.penetration": "contact",
    "fe.hub_compliance": "hub",
    "fe.yield": "strength",
    "fe.first_yield_load": "strength",
    "fe.mirror_symmetry": "orientations",
    "fe.initial_tangent_around": "orientations",
    "fe.residual": "numerics",
    "fe.balance": "numerics",
    "fe.moment_balance": "numerics",
    "fe.energy": "numerics",
    "ancf.mesh_excess": "ancf_mesh",
    "ancf.energy_drop": "ancf_dynamics",
    "ancf.energy_ride": "ancf_dynamics",
    "ancf.integrators": "ancf_dynamics",
    "ancf_vs_fe": "models",
    "brush_vs_fe": "models",
    "user": "models",
    "mesh": "wheel",
    "verify": "verification",
}
"""Whole id of a check, or what stands before its first point -> section, where that is not the section's name."""


def section_titles(study: Study) -> dict[str, str]:
    """Section -> its title in the contents, of every section a study's report has."""
    ancf = {} if study.ancf is None else _ANCF
    return _FIRST | ancf | {topic.name: topic.title for topic in topics_of(study)} | _REST


def contents(titles: Mapping[str, str]) -> list[Group]:
    """Groups with those of the sections (name -> title) that the report has, none empty."""
    placed = {name for names in _GROUPS.values() for name in names}
    rest = [name for name in titles if name not in placed]
    found = []
    for title, names in _GROUPS.items():
        here = [name for name in names if name in titles] + (rest if title == _LAST else [])
        if here:
            found.append(Group(title=title, sections=[Section(name=name, title=titles[name]) for name in here]))
    return found


def section_of(check: Check, titles: Mapping[str, str]) -> str:
    """Name of the section that shows what a check is about; the one with all checks where there is none."""
    start = check.id.partition(".")[0]
    kind = "user" if start.startswith("user_") else start
    name = _SECTIONS.get(check.id) or _SECTIONS.get(kind) or kind
    return name if name in titles else start if start in titles else "checks"
