"""The page docs/reference/study_keys.md from the declarations of the study's sections.

    python docs/hooks/study_keys.py        writes the page's tables anew, in half a minute

Meaning and default stand where a key is declared (`workbench/study`, or the library whose parameter it is), ranges in
`workbench/data/ranges.toml`; what a key changes is found by moving it. Verified by
tests/unit/test_workbench_key_effects.py.
"""

from __future__ import annotations

import ast
import fnmatch
import inspect
import re
from collections.abc import Iterator, Mapping
from contextlib import nullcontext, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from contracts.errors import InputError, WorkbenchError
from workbench.execution.fingerprint import canonical_json
from workbench.questions import study_graph
from workbench.questions.study_graph import report_tasks
from workbench.study.full import full_study
from workbench.study.magnitudes import study_ranges
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study

PAGE = Path(__file__).parents[1] / "reference" / "study_keys.md"
REPORT_ONLY = (
    *("name", "title", "*.source", "inferred.*", "reference.slope.*", "reference.band.*"),
    *("tolerances.*", "ancf.thesis_preset", "input_uncertainty.*"),
)
"""Words, limits and what results are held against, and what another command samples: the comparison reads them, nothing
of the report is computed again."""
ASKS = ("ancf.thesis_preset",)
"""Keys among those that ask a question of their own."""
GROUPS = {
    "mesh": ("mesh", "mesh_*"),
    "FE": ("fe_phi*", "fe_x*", "footprint_*", "pictures", "parts_overlap"),
    "hub study": ("fe_hub*", "mesh_hub"),
    "soil": ("carcass_*", "soil_*", "mesh_soil"),
    "penalty study": ("fe_penalty*", "mesh_penalty"),
    "temperature": ("environment_*",),
    "section model": ("section_*", "crosscheck_*", "words_twin_*", "words_hoops_*"),
    "ANCF tire": ("ancf_*", "words_hub*"),
    "fitted ANCF tires": ("ancf_fit_*", "ancf_as_it_is"),
    "brush line": ("brush",),
    "rover": ("rover_*",),
    "benchmarks": ("verify_*", "multibody_*"),
    "comparison": ("metrics",),
}
"""What the page calls tasks of these names; the last pattern that fits counts."""
type Key = tuple[str | int, ...]
GROUND: Key = ("ground", "friction")
"""The one number that the built-in study leaves to its tires: moved from 0.5."""


def leaves(value: Any, key: Key = (), allowed: Any = None) -> Iterator[tuple[Key, Any, Any]]:
    """Key, value and declared type of every value of a study, its own and defaults; those that are None left out."""
    inner: Mapping[str | int, Any] = {}
    if isinstance(value, BaseModel):
        for name, field in type(value).model_fields.items():
            part = getattr(value, name)
            if isinstance(part, BaseModel | tuple | dict):
                yield from leaves(part, (*key, name), field.annotation)
            elif part is not None:
                yield (*key, name), part, field.annotation
        return
    if isinstance(value, dict):
        inner = value
    elif isinstance(value, tuple):
        inner = dict(enumerate(value))
    for part, content in inner.items():
        if isinstance(content, BaseModel | tuple | dict):
            yield from leaves(content, (*key, part), allowed)
        else:
            yield (*key, part), content, allowed


def others(value: Any, annotation: Any) -> Iterator[Any]:
    """Other values of the same kind."""
    choices = [other for other in _choices(annotation) if other != value]
    if choices:
        yield from choices
    elif isinstance(value, bool):
        yield not value
    elif isinstance(value, int):
        yield from (value + 1, value + 2, 2 * value, value // 2)
    elif isinstance(value, float):
        yield from (1.01 * value, 0.99 * value, 2.0 * value) if value else (0.01,)
    else:
        yield from (other for other in ("AISI 301", "Ti-6Al-4V", "jsc1a", "other") if other != value)


def _choices(annotation: Any) -> Iterator[Any]:
    annotation = getattr(annotation, "__value__", annotation)  # of a named type
    if get_origin(annotation) is Literal:
        yield from get_args(annotation)
    for part in get_args(annotation):
        yield from _choices(part)


def with_value(owner: Any, key: Key, value: Any) -> Any:
    """The same with one value replaced, unchecked: what it reaches is asked here, not whether it is allowed."""
    if not key:
        return value
    first, *rest = key
    if isinstance(owner, BaseModel):
        assert isinstance(first, str)
        return owner.model_copy(update={first: with_value(getattr(owner, first), tuple(rest), value)})
    if isinstance(owner, tuple):
        assert isinstance(first, int)
        return (*owner[:first], with_value(owner[first], tuple(rest), value), *owner[first + 1 :])
    return {**owner, first: with_value(owner[first], tuple(rest), value)}


@dataclass(frozen=True, slots=True)
class Given:
    """What a task is given: its inputs as one text, and the tasks whose results it reads."""

    inputs: str
    needs: tuple[str, ...]


def given(study: Study, *, full: bool = False) -> dict[str, Given]:
    """What each task of the report is given, or of the fine one, which not every study has; not how long it takes."""
    foreseen = study_graph.foreseen
    study_graph.foreseen = tuple  # type: ignore[assignment]
    kind, tasks = "full" if full else "report", ()
    try:
        with suppress(InputError) if full else nullcontext():
            tasks = report_tasks(full_study(study) if full else study)
    finally:
        study_graph.foreseen = foreseen
    return {
        f"{kind}/{t.name}": Given(canonical_json(t.inputs), tuple(f"{kind}/{need}" for need in t.needs)) for t in tasks
    }


def both(study: Study) -> tuple[dict[str, Given], dict[str, Given]]:
    """What the tasks of the report are given, and those of the fine one."""
    return given(study), given(study, full=True)


def changed(
    study: Study, base: tuple[dict[str, Given], dict[str, Given]], key: Key, value: Any, annotation: Any
) -> set[str]:
    """Tasks that are computed again when a key is moved, by the first other value that is possible.

    They are given something else, or read the result of one that is; those that come or go count, too. Of the fine
    report only where the plain one has none. ``base`` is that of `both`.
    """
    for other in others(value, annotation):
        with suppress(WorkbenchError):
            moved = with_value(study, key, other)
            if key[-1] == "shape" and value == "spline":  # whose points no other shape has
                moved = with_value(moved, (*key[:-1], "points"), ())
            for full, before in zip((False, True), base, strict=True):
                now = given(moved, full=full)
                found = {name for name in before.keys() | now.keys() if before.get(name) != now.get(name)}
                for name, one in now.items():  # each after those that it needs
                    if found.intersection(one.needs):
                        found.add(name)
                if found:
                    return found
    return set()


def declared(kind: type[BaseModel]) -> dict[str, str]:
    """Field -> the text below its declaration, its own class's or an ancestor's, or what the library says of it."""
    found = {name: field.description for name, field in kind.model_fields.items() if field.description}
    for owner in reversed(kind.__mro__):
        if not (issubclass(owner, BaseModel) and owner.__module__.startswith("workbench.")):
            continue
        (body,) = ast.parse(inspect.getsource(owner)).body  # of a class that reads a library's: as it is written
        assert isinstance(body, ast.ClassDef)
        for one, text in zip(body.body, body.body[1:], strict=False):
            if isinstance(one, ast.AnnAssign) and isinstance(one.target, ast.Name) and isinstance(text, ast.Expr):
                found[one.target.id] = str(ast.literal_eval(text.value))
    return found


def sections(kind: Any, key: str = "") -> Iterator[tuple[str, type[BaseModel], str]]:
    """Dotted key of every section with its declaration and what it says of itself; lists end in ``[]``."""
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        yield key, kind, " ".join((inspect.getdoc(kind) or "").split("\n\n")[0].split())
        for name, field in kind.model_fields.items():
            yield from sections(field.annotation, f"{key}.{name}".lstrip("."))
        return
    kind = getattr(kind, "__value__", kind)
    mark = {tuple: "[]", dict: ".NAME"}.get(get_origin(kind), "")
    for part in get_args(kind):
        yield from sections(part, key + mark)


def rows(kind: type[BaseModel], key: str, effects: Mapping[str, str]) -> Iterator[str]:
    """A line of a table for each key of a section that holds a value."""
    texts = declared(kind)
    for name, field in kind.model_fields.items():
        if any(True for _ in sections(field.annotation)):
            continue
        whole = f"{key}.{name}".lstrip(".")
        words = "the report alone" if only_read(_pattern(whole)) else effects.get(_pattern(whole), "")
        cells = (f"`{name}`", texts[name], _usual(whole), _default(field), words)
        yield f"| {' | '.join(cell.replace('|', '/') for cell in cells)} |"


def only_read(key: str) -> bool:
    """Whether a dotted key is one of `REPORT_ONLY`."""
    return key not in ASKS and any(fnmatch.fnmatch(key, pattern) or pattern == f"{key}.*" for pattern in REPORT_ONLY)


def _pattern(key: str) -> str:
    return re.sub(r"\[\]|(?<=\.)NAME", "*", key.replace("[]", ".*")).replace(".*.*", ".*.*")


def _usual(key: str) -> str:
    """The range in which a number is used without a word."""
    row = study_ranges().row(tuple(_pattern(key).split("."))) or study_ranges().row((*_pattern(key).split("."), "*"))
    return "" if row is None else f"{row.usual[0]:g} … {row.usual[1]:g} {row.unit}".strip()


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return "required"
    value = field.get_default(call_default_factory=True)
    return "–" if value in (None, (), {}) else f"`{_shown(value)}`"


def _shown(value: Any) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(_shown(one) for one in value)}]"
    return str(value).lower() if isinstance(value, bool) else f"{value:g}" if isinstance(value, float) else str(value)


def effects_of(study: Study) -> dict[Key, set[str]]:
    """Every key of a study with the tasks that are computed again when it is moved, see `changed`."""
    base = both(study)
    found = {key: changed(study, base, key, value, annotation) for key, value, annotation in leaves(study)}
    stated = with_value(study, GROUND, 0.5)
    return found | {GROUND: changed(stated, both(stated), GROUND, 0.5, None)}


def _in_words(effects: Mapping[Key, set[str]]) -> dict[str, str]:
    """Key with ``*`` for every place and name -> what the page calls the tasks that it changes."""
    found: dict[str, set[str]] = {}
    for key, tasks in effects.items():
        found.setdefault(_starred(key), set()).update(_called(task.partition("/")[2]) for task in tasks)
    return {key: ", ".join(name for name in GROUPS if name in names) for key, names in found.items()}


def _starred(key: Key) -> str:
    places = ["*" if isinstance(part, int) else part for part in key]
    if places[0] == "materials":
        places[1] = "*"
    while places[-1] == "*":
        places.pop()
    return ".".join(places)


def _called(task: str) -> str:
    return [name for name, patterns in GROUPS.items() if any(fnmatch.fnmatch(task, p) for p in patterns)][-1]


def tables(effects: Mapping[Key, set[str]]) -> str:
    """Every section with its keys."""
    words, parts = _in_words(effects), []
    for key, kind, text in sections(Study):
        lines = list(rows(kind, key, words))
        if lines:
            title = f"`[{key.replace('[]', '')}]`" if key else "At the top"
            title += " (one of several: `[[...]]`)" if key.endswith("[]") else ""
            head = "| key | meaning | usual | default | changes |\n|---|---|---|---|---|"
            parts.append(f"## {title}\n\n{text}\n\n{head}\n" + "\n".join(lines))
    return "\n\n".join(parts)


def written(page: str, effects: Mapping[Key, set[str]]) -> str:
    """The page with its tables anew."""
    head, mark, rest = page.partition("<!-- tables -->\n")
    tail = rest.partition("<!-- end of tables -->")[2]
    return f"{head}{mark}\n{tables(effects)}\n\n<!-- end of tables -->{tail}"


if __name__ == "__main__":
    found = effects_of(read_study(built_in_study()))
    PAGE.write_text(written(PAGE.read_text(encoding="utf-8"), found), encoding="utf-8")
