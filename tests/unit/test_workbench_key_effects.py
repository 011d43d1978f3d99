"""Every key of a study decides some result: moved, it changes what a task is given. What the report alone reads changes
none."""

from __future__ import annotations

import fnmatch
import tomllib
from collections.abc import Iterator
from contextlib import suppress
from typing import Any, Literal, get_args, get_origin

import pytest
from pydantic import BaseModel

from contracts.errors import InputError, StudyError, WorkbenchError
from workbench.execution.fingerprint import canonical_json
from workbench.graph import study_graph
from workbench.graph.study_graph import report_tasks
from workbench.study.full import full_study
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study, study_of

STUDY = read_study(built_in_study())
REPORT_ONLY = ("name", "title", "*.source", "inferred.*", "reference.*", "tolerances.*", "ancf.thesis_preset")
"""Words, limits and what results are held against: the comparison reads them, nothing is computed again."""
UNASKED = {f"ancf_fit.bounds.{part}_thickness.{end}" for part in ("rim", "spoke") for end in (0, 1)}
"""At their defaults, because no tire of the study frees them; to state them is refused."""
type Key = tuple[str | int, ...]


def _leaves(value: Any, key: Key = (), allowed: Any = None) -> Iterator[tuple[Key, Any, Any]]:
    """Key, value, and what its declaration allows."""
    inner: dict[str | int, Any] = {}
    if isinstance(value, BaseModel):
        for name, field in type(value).model_fields.items():
            part = getattr(value, name)
            if isinstance(part, BaseModel | tuple | dict):
                yield from _leaves(part, (*key, name), field.annotation)
            elif part is not None:
                yield (*key, name), part, field.annotation
        return
    if isinstance(value, dict):
        inner = dict(value)
    elif isinstance(value, tuple):
        inner = dict(enumerate(value))
    for part, content in inner.items():
        if isinstance(content, BaseModel | tuple | dict):
            yield from _leaves(content, (*key, part), allowed)
        else:
            yield (*key, part), content, allowed


def _moved(value: Any, annotation: Any) -> Iterator[Any]:
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
        yield from (other for other in ("AISI 301", "Ti-6Al-4V", "other") if other != value)


def _choices(annotation: Any) -> Iterator[Any]:
    annotation = getattr(annotation, "__value__", annotation)  # of a named type
    if get_origin(annotation) is Literal:
        yield from get_args(annotation)
    for part in get_args(annotation):
        yield from _choices(part)


def _with(owner: Any, key: Key, value: Any) -> Any:
    """The same with one value replaced, unchecked: what it reaches is asked here, not whether it is allowed."""
    if not key:
        return value
    first, *rest = key
    if isinstance(owner, BaseModel):
        assert isinstance(first, str)
        return owner.model_copy(update={first: _with(getattr(owner, first), tuple(rest), value)})
    if isinstance(owner, tuple):
        assert isinstance(first, int)
        return (*owner[:first], _with(owner[first], tuple(rest), value), *owner[first + 1 :])
    return {**owner, first: _with(owner[first], tuple(rest), value)}


def _given(study: Study) -> dict[str, str]:
    """What each task of the report is given, and of the fine one if the study has one."""
    folder = built_in_study().parent
    tasks = {f"report/{task.name}": task for task in report_tasks(study, folder)}
    with suppress(InputError):
        tasks |= {f"full/{task.name}": task for task in report_tasks(full_study(study), folder)}
    return {name: canonical_json({"inputs": t.inputs, "needs": list(t.needs)}) for name, t in tasks.items()}


def _shown(key: Key) -> str:
    return ".".join(str(part) for part in key)


@pytest.fixture(scope="module", autouse=True)
def _no_foresight() -> Iterator[None]:
    """Nobody asks here how long a task takes."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(study_graph, "foreseen", tuple)
        yield


@pytest.fixture(scope="module")
def base() -> dict[str, str]:
    return _given(STUDY)


LEAVES = {_shown(key): (key, value, annotation) for key, value, annotation in _leaves(STUDY)}


@pytest.mark.parametrize("shown", sorted(LEAVES.keys() - UNASKED))
def test_a_key_moved_changes_what_a_task_is_given(shown: str, base: dict[str, str]) -> None:
    key, value, annotation = LEAVES[shown]
    changed: set[str] = set()
    for other in _moved(value, annotation):
        try:
            now = _given(_with(STUDY, key, other))
        except WorkbenchError:
            continue  # does not fit the rest of the study: another one
        changed = {name for name in base.keys() | now.keys() if base.get(name) != now.get(name)}
        if changed:
            break
    only_read = any(fnmatch.fnmatch(shown, pattern) for pattern in REPORT_ONLY)
    assert bool(changed) != only_read, (shown, sorted(changed)[:5])


def test_the_keys_are_all_of_the_built_in_study() -> None:
    """Negative control: the leaves hold what a file states and what it leaves at its default."""
    assert {"wheel.springs.1.bands.0.1", "brush.friction_min", "fe.camber", "mesh.factor"} <= LEAVES.keys()
    assert len(LEAVES) > 200


@pytest.mark.parametrize("part", ["rim_thickness", "spoke_thickness"])
def test_a_bound_that_no_tire_asks_for_is_refused(part: str) -> None:
    table = tomllib.loads(built_in_study().read_text(encoding="utf-8"))
    table["ancf_fit"]["bounds"][part] = ["2 mm", "40 mm"]
    with pytest.raises(StudyError, match=rf"ancf_fit.bounds.{part}.* no tire frees it"):
        study_of(built_in_study(), table)
