"""Reads a study file; every defect becomes one StudyError with file, key, value, rule and what to try.

Verified by tests/unit/test_workbench_study.py and tests/end_to_end/test_bad_studies.py.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from contracts.curves import StiffnessCurve
from contracts.errors import InputError, StudyError
from contracts.input_file import input_table
from contracts.ranges import Key, dotted
from contracts.text import one_line
from workbench.study.curve_file import in_si, read_measured_curve
from workbench.study.key_units import nearest_key, parts_of, words_of
from workbench.study.magnitudes import impossible, numbers_of
from workbench.study.material_law import hint_of_its_place
from workbench.study.model import Study
from workbench.study.model_parameters import ancf_mesh, ancf_preset, brush_parameters
from workbench.study.own_mesh import materials_by_part, own_mesh
from workbench.study.own_mesh_rules import broken_own_mesh, misplaced
from workbench.study.reference import refuse_moved
from workbench.study.reference_file import read_band, stated_uncertainty
from workbench.study.rules import broken_rules, broken_springs
from workbench.study.wheel_design import SectionInputError

__all__ = ["built_in_study", "read_study", "read_study_table", "study_of"]

_HINTS = {
    "extra_forbidden": ("is not a known key", "remove it or correct its spelling"),
    "missing": ("is missing", "add it to the study file"),
    "tuple_type": ("must be a list", "put it in brackets, as in studies/exomars.toml"),
    "list_type": ("must be a list", "put it in brackets, as in studies/exomars.toml"),
    "int_type": ("must be a whole number", "write it without quotes, point and unit"),
    "bool_type": ("must be true or false", "write it without quotes"),
    "string_type": ("must be a text", "put it in quotes"),
    "string_too_short": ("must not be empty", "write what it is"),
}
_EXAMPLE = "studies/exomars.toml"
_EXAMPLES: Mapping[str | int, str] = {
    "optimise": "studies/leaf_optimise.toml",
    "sweep": "studies/strip_sweep.toml",
}
"""Section that the built-in study has not -> a study that has it."""
_NO_TABLE = ("dict_type", "model_type", "model_attributes_type")
_LIMITS = {"less_than": "lt", "less_than_equal": "le", "greater_than": "gt", "greater_than_equal": "ge"}
"""Pydantic's name of a complaint -> that of its limit, which is in SI whatever unit the user writes."""
_SORTED = (("environment", "temperatures"),)
"""Lists that the study holds in another order than its file."""
_PATHS = ("file", "surfaces")
"""Keys whose texts name files; they stay as they are."""


def built_in_study() -> Path:
    """Path of the ExoMars study: in the installed package, or in ``studies/`` of a checkout."""
    here = Path(__file__).parents[1]
    for path in (here / "studies" / "exomars.toml", here.parent / "studies" / "exomars.toml"):
        if path.is_file():
            return path
    raise StudyError("exomars.toml", "", "", "the built-in study was not found", "give the path of a study file")


def read_study(path: Path) -> Study:
    """Read, check and freeze a study file.

    Raises
    ------
    StudyError
        For the first defect found: unreadable file, TOML syntax, unknown or missing key, wrong type, unit or range,
        parts that do not fit together, a user curve or an ANCF tire's surfaces that cannot be used.
    """
    return study_of(path, read_study_table(path))


def study_of(path: Path, table: Mapping[str, Any]) -> Study:
    """Check and freeze the content of a study file, which may have been changed since it was read; as `read_study`."""
    written: Any = None
    try:
        refuse_moved(table)
        for broken in misplaced(table):
            raise StudyError(path, broken.key, broken.value, broken.rule, broken.hint)
        study = Study.model_validate(written := _in_one_line(table))
    except ValidationError as error:
        raise _study_error(path, error, written) from error
    except InputError as error:
        raise StudyError(path, error.what, error.value, error.rule, error.hint) from error
    for number in numbers_of(study):
        if isinstance(found := _at(written, number), bool):
            raise StudyError(path, dotted(number), found, "must be a number", "true and false are none")
    odd = impossible(study)
    if odd is not None:
        written = None if odd.key[:-1] in _SORTED else _at(table, odd.key)
        value = odd.value if written is None else _shown(written)
        plain = isinstance(written, int | float) and " " in odd.value
        hint = f"a number without a unit is SI, here {odd.value}; {odd.hint}" if plain else odd.hint
        raise StudyError(path, dotted(odd.key), value, odd.rule, hint)
    study = _with_whole_paths(study, path.parent)
    for broken in (*broken_own_mesh(study), *broken_springs(study)):
        raise StudyError(path, broken.key, broken.value, broken.rule, broken.hint)
    try:
        materials_by_part(study)
        if study.ancf is not None:
            ancf_preset(study)
        if study.brush is not None:
            brush_parameters(study)
    except SectionInputError as error:
        key = _key_of(error)
        if key.endswith(".shape") and _at(table, parts_of(key)) == "spline":
            key = f"{key.removesuffix('shape')}points"
        raise StudyError(path, key, error.value, f"{error.what} {error.rule}", error.hint) from error
    for broken in broken_rules(study):
        raise StudyError(path, broken.key, broken.value, broken.rule, broken.hint)
    if study.ancf is not None:
        _check_surfaces(path, study, table)
    _check_curves(path, study, table)
    return study.kept_in(path.with_suffix(".kept"))


def read_study_table(path: Path) -> dict[str, Any]:
    """The content of a study file as TOML has it; raises StudyError for a file that is no readable TOML."""
    try:
        table = input_table(path, "study file", "studies/exomars.toml")
    except InputError as error:
        raise StudyError(path, "", "", error.rule, error.hint) from error
    if not table:
        raise StudyError(path, "", "", "is empty", "copy studies/exomars.toml and change it")
    return table


def _in_one_line(content: Any) -> Any:
    """The content of a study file with every text and every name in one line, see `contracts.text.one_line`.

    Raises InputError for two names of one table that are then the same.
    """
    if isinstance(content, Mapping):
        if twice := [name for name, times in Counter(map(one_line, content)).items() if times > 1]:
            raise InputError(
                "name", repr(twice[0]), "stands for two names that differ in what is not shown", "rename one"
            )
        return {one_line(k): v if k in _PATHS and isinstance(v, str) else _in_one_line(v) for k, v in content.items()}
    if isinstance(content, list):
        return [_in_one_line(one) for one in content]
    return one_line(content) if isinstance(content, str) else content


def _study_error(path: Path, error: ValidationError, table: Any) -> StudyError:
    """Turn pydantic's first complaint into our message; an unknown key comes before a missing one (a misspelling).

    Last comes a list that is too short because what it held has complaints of its own.
    """
    every = error.errors()

    def rank(one: ErrorDetails) -> int:
        loc = one["loc"]
        hollow = one["type"] == "too_short" and any(e["loc"][: len(loc)] == loc and e["loc"] != loc for e in every)
        return 2 if hollow else int(one["type"] == "missing")

    first = min(every, key=rank)
    place = _in_file(first["loc"], table)
    key = dotted(place)
    value = "" if first["type"] == "missing" else _shown(first["input"])
    if first["type"] in _HINTS:
        rule, hint = _HINTS[first["type"]]
        hint = hint.replace(_EXAMPLE, _example(place))
        if first["type"] == "extra_forbidden" and (meant := nearest_key(place)):
            hint = f"use {meant}, if that is meant; else remove it"
    elif first["type"] in _NO_TABLE:
        shown = f"[[{key.rpartition('[')[0]}]]" if key.endswith("]") else f"[{key}]"
        rule, hint = "must be a table", f"write it as {shown} and its keys below"
    elif first["type"] == "string_pattern_mismatch":
        rule, hint = _rule_of_a_name(first["ctx"]["pattern"]), "choose another name"
    elif first["type"] in ("union_tag_not_found", "union_tag_invalid"):
        name = first["ctx"]["discriminator"].strip("'")
        key, value = f"{key}.{name}", _shown(first["input"][name]) if name in first["input"] else ""
        rule, hint = f"must be one of {', '.join(words_of((*place, name)))}", "see docs/reference/study_keys.md"
    elif first["type"] == "key_in_section":
        rule, hint, value = (str(first["ctx"][name]) for name in ("rule", "hint", "value"))
        place = _in_file((*first["loc"], first["ctx"]["key"]), table)
        key, found = dotted(place), _at(table, place)
        if value and found and isinstance(found, list) and not any(isinstance(one, dict | list) for one in found):
            value = ", ".join(map(str, found))
        elif value and isinstance(found, str | int | float):
            value = str(found)
    elif first["type"] in ("too_short", "too_long"):
        limit = first["ctx"]["min_length" if first["type"] == "too_short" else "max_length"]
        rule = f"must have {'at least' if first['type'] == 'too_short' else 'at most'} {limit} items"
        hint = f"see {_example(place)} for an example"
    elif first["type"] == "quantity":
        rule, hint = str(first["ctx"]["rule"]), str(first["ctx"]["hint"])
    else:
        rule = _lower_first(first["msg"].removeprefix("Value error, ").replace("Input should", "must"))
        if first["type"] in _LIMITS and isinstance(first["input"], str):
            limit = first["ctx"][_LIMITS[first["type"]]]
            shown = f"{math.degrees(limit):g} deg" if "deg" in first["input"] else f"{limit:g} in SI units"
            rule = re.sub(r"\S+$", lambda _: shown, rule)  # pydantic writes 0.0 as 0
        hint = f"see {_example(place)} for an example"
    if first["type"] in ("extra_forbidden", "literal_error"):
        hint = hint_of_its_place(place) or hint
    return StudyError(path, key, value, rule, hint)


def _example(place: Key) -> str:
    """A study that has the section of a place."""
    return _EXAMPLES.get(place[0], _EXAMPLE) if place else _EXAMPLE


def _in_file(loc: Key, table: Any) -> Key:
    """A place of pydantic's as the file has it: without the kind of a table that it names after the table."""
    kept: list[str | int] = []
    for number, part in enumerate(loc, 1):
        if number < len(loc) and isinstance(part, str) and isinstance(table, dict) and part not in table:
            continue
        kept.append(part)
        table = _at(table, (part,))
    return tuple(kept)


def _rule_of_a_name(pattern: str) -> str:
    """In words: the pattern of a name's first character, then of those that may follow."""
    first, more = re.findall(r"\[([^]]*)\]", pattern)
    *most, last = ["letters", "digits", *str(more).removeprefix("A-Za-z0-9")]
    return f"must begin with a letter{' or a digit' * ('0-9' in first)}; {', '.join(most)} and {last} may follow"


def _at(table: Any, key: Sequence[str | int]) -> object:
    """What the user wrote at a path; None for a number that is a default."""
    for part in key:
        try:
            table = table[part]
        except (KeyError, IndexError, TypeError):
            return None
    return table


def _shown(value: object) -> str:
    if isinstance(value, dict | list | tuple):
        return "a table" if isinstance(value, dict) else f"a list of {len(value)}"
    return repr(value) if isinstance(value, str) else str(value)


def _lower_first(text: str) -> str:
    return text[:1].lower() + text[1:]


def _key_of(error: SectionInputError) -> str:
    """Key of the study file that breaks a rule: the attribute that the library names, within the error's section."""
    own = error.key.replace("spring_sets", "springs").replace("cornering_stiffness", "cornering_stiffness_per_degree")
    return f"{error.section}.{own}" if own else error.section


def _with_whole_paths(study: Study, folder: Path) -> Study:
    """The study with the whole paths of its own mesh, its ANCF tire's surfaces and its reference's files."""

    def whole(file: str) -> dict[str, str]:
        return {"file": str((folder / file).absolute())}

    changes: dict[str, Any] = {}
    if (mesh := own_mesh(study)) is not None:
        changes["mesh"] = mesh.model_copy(update=whole(mesh.file))
    if (reference := study.reference) is not None:
        band = reference.band
        moved: dict[str, Any] = {"curves": tuple(one.model_copy(update=whole(one.file)) for one in reference.curves)}
        if band is not None and band.file is not None:
            moved["band"] = band.model_copy(update=whole(band.file))
        changes["reference"] = reference.model_copy(update=moved)
    if study.ancf is not None and study.ancf.surfaces is not None:
        changes["ancf"] = study.ancf.model_copy(update={"surfaces": whole(study.ancf.surfaces)["file"]})
    return study.model_copy(update=changes)


def _check_surfaces(path: Path, study: Study, table: Mapping[str, Any]) -> None:
    """Make the ANCF tire's plates once, so that a bad file is found before anything runs."""
    try:
        ancf_mesh(study)
    except SectionInputError as error:
        found = "" if error.what == "STEP file" else f"{error.what} = {error.value}: "
        raise StudyError(path, error.section, table["ancf"]["surfaces"], f"{found}{error.rule}", error.hint) from error


def _check_curves(path: Path, study: Study, table: Mapping[str, Any]) -> None:
    """Read the reference's files once, so that a bad one is found before anything runs."""
    reference, key = study.reference, ""
    if reference is None:
        return
    try:
        if reference.band is not None and reference.band.file is not None:
            key = "reference.band.file"
            band, end = read_band(Path(reference.band.file)), study.fe.max_deflection
            if not ((band.deflection > 0.0) & (band.deflection <= end)).any():
                rule = f"has no row between first contact and fe.max_deflection = {1e3 * end:g} mm"
                raise InputError(
                    "band file", reference.band.file, rule, "compute the curves further, or give more rows"
                )
        for i, section in enumerate(reference.curves):
            key = f"reference.curves[{i}].file"
            found = read_measured_curve(Path(section.file))
            in_si(Path(section.file), found)
            _require_comparable(section.file, found.curve, study.fe.max_deflection)
            key = f"reference.curves[{i}].uncertainty"
            stated_uncertainty(section, found)
    except InputError as error:
        about = "" if error.what in ("curve file", "band file", "uncertainty") else f"{error.what} = {error.value}: "
        raise StudyError(path, key, _at(table, parts_of(key)) or "", f"{about}{error.rule}", error.hint) from error


def _require_comparable(file: str, curve: StiffnessCurve, end: float) -> None:
    """Refuse a curve that shares no range with the continuum's, or carries nothing there; InputError."""
    first, last = max(0.0, float(curve.deflection[0])), min(end, float(curve.deflection[-1]))
    if not last > first:
        told = f"from {1e3 * curve.deflection[0]:g} to {1e3 * curve.deflection[-1]:g} mm"
        rule = f"goes {told} and shares nothing with 0 to fe.max_deflection = {1e3 * end:g} mm"
        raise InputError("curve file", file, rule, "check its unit, or compute the curves further")
    inside = curve.load[(curve.deflection >= first) & (curve.deflection <= last)]
    if not max(float(curve.load_at(last)), float(inside.max(initial=0.0))) > 0.0:
        rule = f"holds no load above zero from {1e3 * first:g} to {1e3 * last:g} mm"
        raise InputError("curve file", file, rule, "give the load of the ground on the wheel, positive")
