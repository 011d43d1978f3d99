"""Rules of a study whose wheel's mesh comes from another program: what it cannot have, and why.

Verified by tests/unit/test_workbench_own_mesh.py.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import chain
from pathlib import PurePath
from typing import Any

from geometry.own_mesh.files import ENDINGS
from geometry.own_mesh.step_files import STEP_ENDINGS
from workbench.study.broken_rule import BrokenRule
from workbench.study.key_units import as_written
from workbench.study.model import Study
from workbench.study.own_mesh import own_mesh
from workbench.study.own_mesh_section import OwnMeshSection
from workbench.study.sections import MeshSection
from workbench.study.sweep import tied_keys

__all__ = ["NEEDS_WHEEL", "broken_own_mesh", "misplaced"]

NEEDS_WHEEL = {
    "wheel": "describes a wheel of our own beside mesh.file, which is one already",
    "hub_study": "meshes the wheel's hubs, which a mesh from a file does not tell apart",
    "soil": "needs the rim's radius, width and grousers of [wheel]",
    "penalty_study": "meshes the wheel with other sizes, which a mesh from a file does not have",
    "ancf_fit": "is not offered for a wheel whose mesh comes from a file",
    "ancf_wheel": "makes plates of the strips of [wheel], which a mesh from a file does not have",
    "environment": "lets hubs expand with their part of [wheel], which a mesh from a file does not have",
    "optimise": "varies the section model or the ANCF wheel, which need the dimensions of [wheel]",
    "input_uncertainty": "samples the section model, which needs the dimensions of [wheel]",
}
"""Section -> why it cannot stand beside mesh.file."""
_OF_STRIPS = ("strip_thickness", "strip_scale", "orientation_step")
"""Parameters of a sweep that are several keys of [wheel], or a step over its period."""
_SWEPT = ("fe", "ancf", "brush")
"""Models that a sweep has without [wheel]."""


def misplaced(table: Mapping[str, Any]) -> Iterator[BrokenRule]:
    """What cannot stand beside mesh.file, whatever is in it; of the content of a study file, before it is checked."""
    mesh = table.get("mesh")
    if not isinstance(mesh, dict) or not isinstance(file := mesh.get("file"), str):
        return
    for name, rule in NEEDS_WHEEL.items():
        if name in table:
            yield BrokenRule(key=name, value="a table", rule=rule, hint=f"remove [{name}], or mesh.file")
    ending = PurePath(file).suffix
    if ending.lower() not in (*ENDINGS, *STEP_ENDINGS):
        rule = f"{ending or 'a file without ending'} is not read; {', '.join((*ENDINGS, *STEP_ENDINGS))} are"
        yield BrokenRule(key="mesh.file", value=repr(file), rule=rule, hint="export STEP, or save the mesh as .msh")
    for key in (key for key in MeshSection.model_fields if key in mesh and key not in OwnMeshSection.model_fields):
        rule = "is for wheels of [wheel]; a mesh from a file has its cells"
        hint = "remove it" if key != "half_width" else "remove it; half a wheel names its mid-plane in mesh.symmetry"
        yield BrokenRule(key=f"mesh.{key}", value="", rule=rule, hint=hint)


def broken_own_mesh(study: Study) -> Iterator[BrokenRule]:
    """What a study with its own mesh has and cannot have; nothing for a wheel of [wheel]."""
    mesh = own_mesh(study)
    if mesh is None:
        return
    if study.of_the_thesis:
        rule = "speaks of the thesis' wheel, not of one whose mesh comes from a file"
        yield BrokenRule(key="reference.thesis_words", value="true", rule=rule, hint="remove it")
    if study.fe.hub == "elastic":
        rule = "is for the hubs of [wheel]; what of a mesh from a file is held, mesh.hub says"
        yield BrokenRule(key="fe.hub", value="elastic", rule=rule, hint="remove it")
    if study.fe.turned and mesh.half_width:
        angle = math.degrees(study.fe.camber or getattr(study.fe.obstacle, "yaw", 0.0))
        rule = "turns the ground out of the plane of symmetry, mesh.symmetry"
        yield BrokenRule(key="fe.camber", value=f"{angle:g} deg", rule=rule, hint="mesh the whole wheel")
    if study.mesh_study is not None and any(factor != round(factor) for factor in study.mesh_study.factors):
        shown = ", ".join(f"{factor:g}" for factor in study.mesh_study.factors)
        rule = "must be whole numbers: into so many the cells of a mesh from a file are divided"
        yield BrokenRule(key="mesh_study.factors", value=shown, rule=rule, hint="e.g. 1, 2, 3")
    for key in sorted(study.full.model_fields_set - {"orientation_step"} if "full" in study.model_fields_set else ()):
        rule = "meshes the wheel more finely, which a mesh from a file cannot be"
        yield BrokenRule(key=f"full.{key}", value=str(getattr(study.full, key)), rule=rule, hint="remove it")
    if study.rover is not None and mesh.half_width:
        rule = "moves wheels sideways over the ground, which half a wheel, mesh.symmetry, cannot be"
        yield BrokenRule(key="rover", value="a table", rule=rule, hint="mesh the whole wheel, or remove [rover]")
    yield from _of_the_sweep(study)
    yield from _of_the_file(mesh)
    yield from _of_the_names(mesh)


def _of_the_sweep(study: Study) -> Iterator[BrokenRule]:
    """Models, parameters and choices of [sweep] that need the dimensions of [wheel]."""
    sweep = study.sweep
    if sweep is None:
        return
    rule = "needs the dimensions of [wheel], which a mesh from a file does not have"
    for model in sweep.models:
        if model not in _SWEPT:
            hint = f'give models = ["fe"], or one of {", ".join(_SWEPT)}'
            yield BrokenRule(key="sweep.models", value=model, rule=rule, hint=hint)
    for keys in sweep.parameters:
        if keys in _OF_STRIPS or any(name.partition(".")[0] == "wheel" for _, name in tied_keys(keys)):
            yield BrokenRule(key=f"sweep.{keys}", value="", rule=rule, hint="vary another key, or describe the wheel")
    for key, given in (("scaled", sweep.scaled), ("confirm", sweep.confirm > 0)):
        if given:
            yield BrokenRule(key=f"sweep.{key}", value=str(getattr(sweep, key)), rule=rule, hint="remove it")


def _of_the_file(mesh: OwnMeshSection) -> Iterator[BrokenRule]:
    """What solids need and meshes have already, and the other way round."""
    if not mesh.of_solids:
        if mesh.units is None:
            yield BrokenRule(key="mesh.units", value="", rule="is missing", hint="the unit of the file's lengths: mm")
        sizes = {f"parts.{name}.element_size": part.element_size for name, part in mesh.parts.items()}
        numbers = {"element_size": mesh.element_size, "around": mesh.around} | sizes
        given = {key: as_written(f"mesh.{key}", value) for key, value in numbers.items() if value is not None}
        for key, value in (given | ({"faces": "a table"} if mesh.faces else {})).items():
            rule = "is for solids in a STEP file; this file is meshed already, and names its faces"
            yield BrokenRule(key=f"mesh.{key}", value=value, rule=rule, hint="remove it")
        return
    if mesh.units is not None:
        rule = "is not needed: a STEP file states its own unit"
        yield BrokenRule(key="mesh.units", value=mesh.units, rule=rule, hint="remove it")
    if mesh.element_size is None:
        hint = 'the largest edge of an element, e.g. "8 mm"'
        yield BrokenRule(key="mesh.element_size", value="", rule="is missing: solids have to be meshed", hint=hint)
    used = {*mesh.hub, *mesh.ground, *chain(*mesh.contact), mesh.symmetry}
    for name, rule_of in mesh.faces.items():
        key = f"mesh.faces.{name}"
        if name in mesh.parts:
            yield BrokenRule(key=key, value="a table", rule="is the name of a part", hint="give another name")
        if name not in used:
            rule = "is named nowhere: not in hub, ground, contact or symmetry"
            yield BrokenRule(key=key, value="a table", rule=rule, hint="use the name, or remove the table")
        if not rule_of.model_fields_set:
            hint = "give part, radius, position or numbers"
            yield BrokenRule(key=key, value="an empty table", rule="stands for no face", hint=hint)
        if "numbers" in rule_of.model_fields_set and not rule_of.numbers:
            hint = "give numbers that workbench check lists, or remove it"
            yield BrokenRule(key=f"{key}.numbers", value="[]", rule="is empty: no face has one of these", hint=hint)
        if rule_of.part is not None and rule_of.part not in mesh.parts:
            rule = f"is not in [mesh.parts], which has {', '.join(mesh.parts)}"
            yield BrokenRule(key=f"{key}.part", value=rule_of.part, rule=rule, hint="correct the name")
        for end in ("radius", "position"):
            pair = getattr(rule_of, end)
            if pair is not None and end == "radius" and min(pair) < 0.0:
                value, rule = f"{1e3 * min(pair):g} mm", "is a distance from the axle, which is not negative"
                yield BrokenRule(key=f"{key}.{end}", value=value, rule=rule, hint="drop the sign")
            if pair is not None and pair[0] > pair[1]:
                value = f"{1e3 * pair[0]:g} to {1e3 * pair[1]:g} mm"
                yield BrokenRule(key=f"{key}.{end}", value=value, rule="must ascend", hint="swap them")
    middle = (mesh.symmetry,) if mesh.symmetry else ()
    asked = {"hub": mesh.hub, "ground": mesh.ground, "contact": tuple(chain(*mesh.contact)), "symmetry": middle}
    for where, names in asked.items():
        for name in names:
            if name not in mesh.faces and not name.isdecimal() and not (where == "hub" and name in mesh.parts):
                rule = f"is not in [mesh.faces], which has {', '.join(mesh.faces) or 'no table'}"
                rule = f"is no part, and {rule}" if where == "hub" else rule
                yield BrokenRule(key=f"mesh.{where}", value=name, rule=rule, hint=f"add [mesh.faces.{name}]")


def _of_the_names(mesh: OwnMeshSection) -> Iterator[BrokenRule]:
    """A name cannot be two things at once."""
    if mesh.axle == mesh.up:
        yield BrokenRule(key="mesh.up", value=mesh.up, rule="must not be the axle", hint="name another axis")
    owner: dict[str, str] = {}
    for name, part in mesh.parts.items():
        for group in part.groups or (name,):
            if group in owner:
                rule = f"holds {group}, which {owner[group]} has already"
                hint = "give a group of cells to one part"
                yield BrokenRule(key=f"mesh.parts.{name}.groups", value=group, rule=rule, hint=hint)
            owner[group] = name
    if set(mesh.parts) <= set(mesh.hub):
        rule = "holds every part"
        yield BrokenRule(key="mesh.hub", value=", ".join(mesh.hub), rule=rule, hint="leave a part that can deform")
    used = {"hub": mesh.hub, "ground": mesh.ground, "symmetry": (mesh.symmetry,) if mesh.symmetry else ()}
    for key, names in used.items():
        for name, times in Counter(names).items():
            others = [other for other, more in used.items() if other != key and name in more]
            others += ["contact"] if key in ("hub", "symmetry") and name in chain(*mesh.contact) else []
            if times > 1 or others:
                rule = "names it twice" if times > 1 else f"names what mesh.{others[0]} names too"
                yield BrokenRule(key=f"mesh.{key}", value=name, rule=rule, hint="name it once")
    pairs = Counter(tuple(sorted(pair)) for pair in mesh.contact)
    for pair, times in pairs.items():
        if times > 1:
            yield BrokenRule(key="mesh.contact", value=", ".join(pair), rule="names it twice", hint="name it once")
