"""Rules that bind several sections of a study file: part names, room for the deflection.

Asked once the wheel and the tire are known to fit together. Verified by tests/unit/test_workbench_study.py and
tests/unit/test_workbench_study_rules.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from contracts.errors import InputError
from workbench.study.broken_rule import BrokenRule
from workbench.study.fit import AncfFitSection
from workbench.study.key_units import absent, as_written, is_table, parts_of
from workbench.study.laws import other_law, plastic_parts
from workbench.study.model import Study
from workbench.study.model_parameters import ancf_preset, fit_start, rover_radius
from workbench.study.own_mesh import own_mesh, sized_mesh
from workbench.study.reference_rules import broken_reference
from workbench.study.sweep import SweepSection, tied_keys
from workbench.study.wheel_design import SectionInputError, materials, wheel_design

__all__ = ["broken_rules", "broken_springs"]


def broken_springs(study: Study) -> Iterator[BrokenRule]:
    """What the springs' keys say together, before a wheel is built of them."""
    wheel = study.wheel
    if wheel is None:
        return
    sets = {f"wheel.springs[{i}]": springs for i, springs in enumerate(wheel.springs)}
    for key, springs in (sets | {"wheel.impact_springs": wheel.impact_springs}).items():
        if springs is None:
            continue
        shape, points, direction = (getattr(springs, name) for name in ("shape", "points", "direction"))
        if shape != "spline" and points:
            value = ", ".join(f"({fraction:g}, {math.degrees(angle):g} deg)" for fraction, angle in points)
            rule, hint = 'belong to shape = "spline", and only to it', "remove them, or change the shape"
            yield BrokenRule(key=f"{key}.points", value=value, rule=rule, hint=hint)
        if shape == "spline" and not points:
            rule, hint = 'must be given for shape = "spline"', 'e.g. points = [[0.5, "70 deg"]]'
            yield BrokenRule(key=f"{key}.points", value="", rule=rule, hint=hint)
        for number, (fraction, _) in enumerate(points):
            if not 0.0 <= fraction <= 1.0:
                rule, hint = "must lie between 0 and 1", "0 is at the rim's weld, 1 at the hub's"
                yield BrokenRule(key=f"{key}.points[{number}][0]", value=f"{fraction:g}", rule=rule, hint=hint)
        if shape == "hoop" and direction != 1:
            rule, hint = (
                "has no effect on a hoop, which leaves its weld to both sides",
                "remove it, or change the shape",
            )
            yield BrokenRule(key=f"{key}.direction", value=str(direction), rule=rule, hint=hint)


def broken_rules(study: Study) -> Iterator[BrokenRule]:
    """Every rule between sections that the study breaks, in the order of the file."""
    yield from _of_the_curves(study)
    yield from broken_reference(study)
    yield from _of_the_sweep(study)
    if study.ancf is not None:
        preset = ancf_preset(study)
        yield from _room("ancf", study.ancf.max_deflection, preset.zero_radius - preset.hub_radius)
    if own_mesh(study) is None:
        yield from _of_the_wheel(study)


def _of_the_wheel(study: Study) -> Iterator[BrokenRule]:
    """What the wheel's dimensions have to do with the other sections."""
    design = wheel_design(study)
    for name, size in sized_mesh(study).refinement.items():
        if name not in design.materials:
            yield BrokenRule(
                key=f"mesh.refinement.{name}",
                value=f"{1e3 * size:g} mm",
                rule="names no part of the wheel",
                hint=f"use {', '.join(design.materials)}",
            )
    yield from _lonely(study)
    gap = design.tire.inner_radius - design.outer_hub.outer_radius
    yield from _room("fe", study.fe.max_deflection, gap)
    if study.input_uncertainty is not None:
        yield from _room("input_uncertainty", study.input_uncertainty.max_deflection, gap)
    yield from _environment(study)
    yield from _of_the_fit(study)


def _of_the_sweep(study: Study) -> Iterator[BrokenRule]:
    """Models and parameters of [sweep] and [optimise] that the study has no section for."""
    if study.sweep is not None:
        yield from _of_varied(study, study.sweep, "sweep", "sweep.models")
    if study.optimise is not None:
        yield from _of_varied(study, study.optimise.as_sweep, "optimise.variables", "optimise.model")
        if study.optimise.load > study.fe.max_load:
            rule = f"lies beyond fe.max_load, {study.fe.max_load:g} N, where curves end"
            value, hint = f"{study.optimise.load:g} N", "raise fe.max_load"
            yield BrokenRule(key="optimise.load", value=value, rule=rule, hint=hint)


def _of_varied(study: Study, sweep: SweepSection, where: str, models: str) -> Iterator[BrokenRule]:
    asked = {model: f"sweep.models, {model}" for model in sweep.models}
    if (other := other_law(study)) is not None:
        for model in sorted({"section", "ancf_wheel"}.intersection(asked)):
            rule, hint = f"has no law of {' = '.join(other)}", "take the solid model, or another law"
            yield BrokenRule(key=models, value=model, rule=rule, hint=hint)
    if "plates" in sweep.parameters:
        asked["ancf"] = "sweep.plates"
    for name, section in (("ancf", study.ancf), ("brush", study.brush)):
        if name in asked and section is None:
            hint = f"add [{name}], or remove it from the sweep"
            yield BrokenRule(key=asked[name], value="", rule=f"needs [{name}]", hint=hint)
    for key in (one for keys in sweep.parameters for _, one in tied_keys(keys)):
        missing = absent(study, parts_of(key))
        if missing is not None and is_table(missing) and not missing.endswith("]"):
            hint = f"add [{missing}], or remove it from the {'sweep' if where == 'sweep' else 'variables'}"
            yield BrokenRule(key=f"{where}.{key}", value="", rule=f"needs [{missing}]", hint=hint)


def _lonely(study: Study) -> Iterator[BrokenRule]:
    """A section that asks for what another has: the fit for tire and uncertainty, the rover for a wheel of its size."""
    radius, wanted = wheel_design(study).tire.outer_radius, rover_radius()
    if study.rover is not None and abs(radius - wanted) > 1e-9:
        rule = f"is for a wheel of radius {1e3 * wanted:g} mm, the study's has {1e3 * radius:g} mm"
        yield BrokenRule(key="rover", value="a table", rule=rule, hint="remove [rover]: the rover cannot stand on it")
    if study.ancf_fit is not None:
        for name, section in (("ancf", study.ancf), ("mesh_study", study.mesh_study)):
            if section is None:
                what = "the tire it starts from" if name == "ancf" else "the uncertainty of the curves it follows"
                yield BrokenRule(
                    key="ancf_fit", value="a table", rule=f"needs [{name}], {what}", hint=f"add [{name}], or remove it"
                )
    if study.parametric.inner_hub is None:
        rule = "needs [wheel.inner_hub], whose bore is held"
        if study.fe.hub == "elastic":
            hint = 'add it, or set hub = "rigid", which holds the outer hub'
            yield BrokenRule(key="fe.hub", value="elastic", rule=rule, hint=hint)
        if study.hub_study is not None:
            hint = "add it, or remove [hub_study]"
            yield BrokenRule(key="hub_study", value="a table", rule=rule, hint=hint)


def _environment(study: Study) -> Iterator[BrokenRule]:
    """Its orientation must be one of the FE's, its materials known at every temperature."""
    section = study.environment
    if section is None:
        return
    if not any(abs(section.orientation - o) < 1e-9 for o in study.fe.orientations):
        value, rule = f"{math.degrees(section.orientation):g} deg", "must be one of fe.orientations"
        hint = "its curve at 20 C is what the others are held against"
        yield BrokenRule(key="environment.orientation", value=value, rule=rule, hint=hint)
    if "points" in section.model_fields_set and section.points > study.fe.points:
        rule, hint = f"must not exceed fe.points = {study.fe.points}", "they are some of the points of the FE curve"
        yield BrokenRule(key="environment.points", value=str(section.points), rule=rule, hint=hint)
    first = study.fe.max_deflection / study.fe.points
    if section.max_deflection is not None and section.max_deflection < first:
        value, rule = f"{1e3 * section.max_deflection:g} mm", f"lies before the first point, {1e3 * first:g} mm"
        hint = "raise it, or fe.points"
        yield BrokenRule(key="environment.max_deflection", value=value, rule=rule, hint=hint)
    known = materials(study)
    for name in section.variants:
        if name not in known:
            hint = f"add [materials.{name!r}] or remove it"
            yield BrokenRule(key="environment.variants", value=name, rule="is not in [materials]", hint=hint)
            return
    used = {material.name: material for material in wheel_design(study).materials.values()}
    for material in (used | {name: known[name] for name in section.variants}).values():
        for temperature in section.temperatures:
            try:
                material.at(temperature)
            except InputError as error:
                value = f"{temperature - 273.15:g} C"
                rule = f"{material.name}: {error.rule}"
                yield BrokenRule(key="environment.temperatures", value=value, rule=rule, hint=error.hint)


def _of_the_curves(study: Study) -> Iterator[BrokenRule]:
    """What is made of the FE curves must lie on them: their orientations, their range, their mesh."""
    fe, mesh_study = study.fe, study.mesh_study
    for name, part in (("mesh_study", mesh_study), ("hub_study", study.hub_study)):
        if part is not None and max(part.deflections) > fe.max_deflection:
            yield BrokenRule(
                key=f"{name}.deflections",
                value=f"{1e3 * max(part.deflections):g} mm",
                rule="must not exceed fe.max_deflection",
                hint="choose smaller ones",
            )
    for angle in mesh_study.orientations if mesh_study is not None else ():
        if not any(abs(angle - o) < 1e-9 for o in fe.orientations):
            key, value = "mesh_study.orientations", f"{math.degrees(angle):g} deg"
            hint = "add it there or choose one of them"
            yield BrokenRule(key=key, value=value, rule="must be one of fe.orientations", hint=hint)
    penalty, environment = study.penalty_study, study.environment
    for key, drop in (
        ("penalty_study.deflection", penalty.deflection if penalty else None),
        ("environment.max_deflection", environment.max_deflection if environment else None),
    ):
        if drop is not None and drop > fe.max_deflection * (1.0 + 1e-9):
            value, rule = f"{1e3 * drop:g} mm", "must not exceed fe.max_deflection"
            yield BrokenRule(key=key, value=value, rule=rule, hint="choose a smaller one")
    if fe.turned and study.mesh.half_width:
        rule = "turns the ground out of the plane of symmetry that mesh.half_width relies on"
        name, angle = ("camber", fe.camber) if fe.camber else ("obstacle.yaw", getattr(fe.obstacle, "yaw", 0.0))
        value, hint = f"{math.degrees(angle):g} deg", "set mesh.half_width = false"
        yield BrokenRule(key=f"fe.{name}", value=value, rule=rule, hint=hint)
    if mesh_study is not None and study.mesh.factor not in mesh_study.factors:
        yield BrokenRule(
            key="mesh_study.factors",
            value=", ".join(f"{factor:g}" for factor in mesh_study.factors),
            rule=f"must contain mesh.factor = {study.mesh.factor:g}, the mesh of the curves",
            hint="the uncertainty is that of the curves' mesh",
        )
    if mesh_study is not None and study.full.factor not in study.full.mesh_study_factors:
        factors = ", ".join(f"{factor:g}" for factor in study.full.mesh_study_factors)
        rule = f"must be one of full.mesh_study_factors = {factors}"
        hint = "the uncertainty is that of the curves' mesh; give both"
        yield BrokenRule(key="full.factor", value=f"{study.full.factor:g}", rule=rule, hint=hint)


def _of_the_fit(study: Study) -> Iterator[BrokenRule]:
    """Each fitted tire must begin as a possible one, within its bounds."""
    section = study.ancf_fit
    if section is None:
        return
    if plastic := plastic_parts(study):
        rule = f"makes elastic tires, which cannot follow {plastic[0]}, whose law.kind is j2_plasticity"
        hint = "remove it, or give the material another law"
        yield BrokenRule(key="ancf_fit", value="a table", rule=rule, hint=hint)
    yield from _of_the_travels(study, section)
    freed = {name for tire in section.tires for name in tire.free}
    for name in sorted(section.bounds.model_fields_set - freed):
        key = f"ancf_fit.bounds.{name}"
        value = ", ".join(as_written(key, end) for end in getattr(section.bounds, name))
        rule, hint = "bounds nothing: no tire frees it", "remove it, or add it to a tire's free"
        yield BrokenRule(key=key, value=value, rule=rule, hint=hint)
    for number, tire in enumerate(section.tires):
        key = f"ancf_fit.tires[{number}]"
        try:
            start = fit_start(study, tire)
        except SectionInputError as error:
            key += f".start.{error.key}" * (error.key in tire.start.model_fields_set)
            yield BrokenRule(key=key, value=str(error.value), rule=f"{error.what} {error.rule}", hint=error.hint)
            continue
        for name in tire.free:
            bounds = f"ancf_fit.bounds.{name}"
            own = "rim_thickness" if name == "thickness" else name
            low, high = getattr(section.bounds, name)
            if not low <= getattr(start, own) <= high:
                value, ends = as_written(bounds, getattr(start, own)), [as_written(bounds, end) for end in (low, high)]
                rule = f"must begin within its bounds, {bounds} = {' to '.join(ends)}"
                hint = "give another start or widen the bounds"
                yield BrokenRule(key=f"{key}.start.{own}", value=value, rule=rule, hint=hint)


def _of_the_travels(study: Study, section: AncfFitSection) -> Iterator[BrokenRule]:
    """The load under which a wheel is moved must be among those that its curves come to, and that are fitted."""
    if section.travel is None:
        return
    load, low, high = section.travel.load, section.load_range[0], min(section.load_range[1], study.fe.max_load)
    if not low <= load <= high:
        rule = f"must lie within ancf_fit.load_range and fe.max_load, {low:g} to {high:g} N"
        hint = "give a load between, or widen them"
        yield BrokenRule(key="ancf_fit.travel.load", value=f"{load:g} N", rule=rule, hint=hint)


def _room(section: str, deflection: float, gap: float) -> Iterator[BrokenRule]:
    """The ground must stay below the hub: ``deflection`` < ``gap``, both in metres."""
    if deflection >= gap:
        yield BrokenRule(
            key=f"{section}.max_deflection",
            value=f"{1e3 * deflection:g} mm",
            rule=f"must be less than the gap between rim and hub, {1e3 * gap:g} mm",
            hint="give a smaller deflection or a smaller hub",
        )
