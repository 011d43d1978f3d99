"""Every key of a study decides some result: moved, it changes what a task is given. What the report alone reads changes
none. The page of all keys says so."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

import pytest

from contracts.errors import StudyError
from workbench.study.reading import built_in_study, read_study, study_of

sys.path.insert(0, str(Path(__file__).parents[2] / "docs" / "hooks"))
import study_keys  # type: ignore[import-not-found]

STUDY = read_study(built_in_study())
UNASKED = {f"ancf_fit.bounds.{part}_thickness.{end}" for part in ("rim", "spoke") for end in (0, 1)}
"""At their defaults, because no tire of the study frees them; to state them is refused."""
KEYS = {".".join(map(str, key)): key for key in (*(key for key, _, _ in study_keys.leaves(STUDY)), study_keys.GROUND)}


@pytest.fixture(scope="module")
def effects() -> dict[study_keys.Key, set[str]]:
    return dict(study_keys.effects_of(STUDY))


@pytest.mark.parametrize("shown", sorted(KEYS.keys() - UNASKED))
def test_a_key_moved_changes_what_a_task_is_given(shown: str, effects: dict[study_keys.Key, set[str]]) -> None:
    assert bool(effects[KEYS[shown]]) != study_keys.only_read(shown), sorted(effects[KEYS[shown]])[:5]


def test_the_keys_are_all_of_the_built_in_study() -> None:
    """Those that the file states, and those that it leaves at their defaults."""
    assert {"wheel.springs.1.bands.0.1", "brush.friction_min", "fe.camber", "mesh.factor"} <= KEYS.keys()
    assert len(KEYS) > 200


def test_the_page_of_keys_is_that_of_the_declarations(effects: dict[study_keys.Key, set[str]]) -> None:
    page = study_keys.PAGE.read_text(encoding="utf-8")
    assert page == study_keys.written(page, effects), "run python docs/hooks/study_keys.py"


@pytest.mark.parametrize("part", ["rim_thickness", "spoke_thickness"])
def test_a_bound_that_no_tire_asks_for_is_refused(part: str) -> None:
    table = tomllib.loads(built_in_study().read_text(encoding="utf-8"))
    table["ancf_fit"]["bounds"][part] = ["2 mm", "40 mm"]
    with pytest.raises(StudyError, match=rf"ancf_fit.bounds.{part}.* no tire frees it"):
        study_of(built_in_study(), table)
