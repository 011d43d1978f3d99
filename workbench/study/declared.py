"""Sections of a study file that hold a library's parameters: unit, limits, default, meaning are the library's own.

    @reads(Tire)
    class TireSection(Section):
        material: MaterialName

has the attributes of `geometry.parts.Tire` beside its own. Verified by tests/unit/test_workbench_study.py.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from dataclasses import MISSING, fields
from typing import Annotated, Any, get_args, get_origin

from pydantic import BeforeValidator, Field, StrictInt, create_model

from contracts.declared import In, Whole, declared_types
from workbench.study.quantities import InUnit
from workbench.study.section import Section

__all__ = ["meanings", "reads"]

_ATTRIBUTE = re.compile(r"^([\w, ]+?) : (.*(?:\n    .*)*)", re.MULTILINE)


def reads[S: Section](kind: type, *left_out: str, optional: tuple[str, ...] = ()) -> Callable[[type[S]], type[S]]:
    """Decorator of a section that has the attributes of a dataclass, but for those ``left_out`` and its own.

    Those that are ``optional`` may be missing and are None then, whatever the dataclass says.
    """

    def with_attributes(section: type[S]) -> type[S]:
        types, texts, found = declared_types(kind), meanings(kind), dict[str, Any]()
        for one in fields(kind):
            if one.name not in (*left_out, *section.model_fields):
                default, declared = ... if one.default is MISSING else one.default, _in_file(types[one.name])
                if one.name in optional:
                    default, declared = None, declared | None
                found[one.name] = (declared, Field(default, description=texts.get(one.name)))
        text = section.__doc__ or inspect.getdoc(kind)
        return create_model(section.__name__, __base__=section, __module__=section.__module__, __doc__=text, **found)

    return with_attributes


def meanings(kind: type) -> dict[str, str]:
    """Attribute -> what the class says of it under "Attributes", in one line."""
    _, _, text = (inspect.getdoc(kind) or "").partition("Attributes\n----------\n")
    found = _ATTRIBUTE.findall(text.partition("\n\n")[0])
    return {name.strip(): " ".join(words.split()) for names, words in found for name in names.split(",")}


def _in_file(declared: Any) -> Any:
    """The type of a value in a study file, by what the library declares of it."""
    if get_origin(declared) is Annotated:
        rule = next(one for one in declared.__metadata__ if isinstance(one, In | Whole))
        if isinstance(rule, Whole):
            return Annotated[StrictInt, Field(ge=rule.least, le=rule.most)]
        unit = BeforeValidator(InUnit(rule.unit.replace("^", "**")))
        return Annotated[float, unit, Field(gt=rule.above, lt=rule.below, ge=rule.least)]
    if declared is str:
        return Annotated[str, Field(min_length=1)]
    if get_origin(declared) is tuple:
        return tuple[tuple(one if one is ... else _in_file(one) for one in get_args(declared))]  # type: ignore[misc]
    if type(None) in get_args(declared):
        (inner,) = (one for one in get_args(declared) if one is not type(None))
        return _in_file(inner) | None
    return declared
