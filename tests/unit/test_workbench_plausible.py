"""The plausible set: which wheels of a search are kept, and what the package holds."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from workbench.questions.words import keeping
from workbench.questions.words.figures import centrelines
from workbench.questions.words.plausible import RECORD, SHOWN, STRESS, TWIN_SPREAD, plausible, record_key
from workbench.study.wheel_design import wheel_design

ROOT = Path(__file__).parents[2]


def _wheel(number: int, miss: float, stress: float | None) -> dict[str, Any]:
    numbers = {keeping.SPREAD: 0.3} | ({} if stress is None else {STRESS: stress})
    misses = {"tire": miss, "small": 0.1}
    return {"point": number, "values": {"x": "0.123456789 mm"}, "misses": misses, "numbers": numbers}


def _record(*wheels: dict[str, Any]) -> dict[str, Any]:
    return {"study": {"reference": {}, "name": "x"}, "aims": {}, "searched": 9, "refused": 0, "wheels": list(wheels)}


@pytest.fixture
def unsolved(monkeypatch: pytest.MonkeyPatch) -> None:
    """No finite elements: wheel 4 has a twin that varies less."""

    def twins(study: Mapping[str, Any], wheels: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
        return [dict(one) for one in wheels if one["point"] != 4]

    monkeypatch.setattr(keeping, "_varying_less_than_in_phase", twins)
    monkeypatch.setattr(keeping, "record_key", lambda record: "key")


@pytest.mark.usefixtures("unsolved")
def test_wheels_that_satisfy_everything_are_kept_in_order_of_stress() -> None:
    wheels = (_wheel(1, 0.9, 970.123456789e6), _wheel(2, 1.2, 500e6), _wheel(3, 0.5, 700e6), _wheel(4, 0.5, 600e6))
    kept = keeping.kept_record(_record(*wheels, _wheel(5, 0.2, None), _wheel(6, 0.2, 1101e6)))
    assert kept["annealed"] == 1
    assert not kept["empty"]
    assert [one["point"] for one in kept["wheels"]] == [3, 1]
    assert kept["wheels"][1]["numbers"][STRESS] == 970.123e6
    assert kept["wheels"][0]["values"] == {"x": "0.123456789 mm"}  # text, never rounded
    assert "reference" not in kept["study"]
    assert (kept["key"], kept["searched"], kept["confirmed"]) == ("key", 9, 6)


@pytest.mark.usefixtures("unsolved")
def test_of_an_empty_set_the_nearest_are_kept() -> None:
    kept = keeping.kept_record(_record(_wheel(1, 1.5, 870e6), _wheel(2, 1.2, 900e6)))
    assert kept["empty"]
    assert [one["point"] for one in kept["wheels"]] == [1, 2]


def test_what_the_package_holds_is_a_set_of_wheels() -> None:
    """Every one satisfies every statement, varies less than its twin in phase, and stands in the table."""
    found, table = plausible(), (ROOT / "studies" / "words_search.csv").read_text(encoding="utf-8")
    assert not found.empty
    assert found.annealed == sum(wheel.stress <= keeping.ANNEALED for wheel in found.wheels)
    for wheel in found.wheels:
        assert max(wheel.misses[name] for name in ("small", "tire", "load_at_30.303mm_N", "negative_pivots")) <= 1.0
        assert wheel.stress <= found.strength == keeping.AGED
        assert wheel.numbers[TWIN_SPREAD] > wheel.numbers[keeping.SPREAD]
        assert len(wheel.orientation_deg) == 24
        assert re.search(rf"^{wheel.point},", table, re.MULTILINE)
    assert [w.stress for w in found.wheels] == sorted(w.stress for w in found.wheels)
    assert len(found.shown) == min(SHOWN, len(found.wheels))
    assert found.shown[0] is found.wheels[0]


def test_a_key_goes_with_the_wheel() -> None:
    record = json.loads(RECORD.read_text(encoding="utf-8"))
    key = record_key(record)
    first = record["wheels"][0]
    first["values"] = first["values"] | {"wheel.tire.thickness": "0.7123 mm"}
    assert record_key(record) != key


def test_centrelines_are_those_of_the_wheel() -> None:
    found = plausible()
    design = wheel_design(found.point(found.wheels[0]).study)
    lines = centrelines(design)
    assert [len(lines[s.name]) for s in design.spring_sets] == [s.count for s in design.spring_sets]
    for springs in design.spring_sets:
        radius = np.linalg.norm(np.concatenate(lines[springs.name]), axis=1)
        assert design.outer_hub.outer_radius < radius.min()
        assert radius.max() < design.tire.inner_radius
