"""Another code's loads beside ours: which are compared, what a stale record decides, what the page says."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.crosscheck.question import CROSSCHECK
from workbench.questions.crosscheck.results import COMMAND, NAME, PeerCheck, crosscheck_tasks, peer_check, points_of
from workbench.questions.kept import Kept, keep, kept
from workbench.report.page import page_environment
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study

RUNS = [
    {"orientation_deg": 0.0, "ours_N": [80.0, 150.0], "peer_N": [80.4, 150.3], "iterations": 40, "wall_s": 50.0},
    {"orientation_deg": 15.0, "ours_N": [90.0, 160.0], "peer_N": [90.0, 158.0], "iterations": 60, "wall_s": 50.0},
]
MOVED = {
    "orientation_deg": 0.0,
    "deflection_m": 0.025,
    "friction": 0.6,
    "travel_m": [0.0, 0.001, 0.002],
    "ours_N": [-1.0, -4.0, -7.0],
    "peer_N": [-1.1, -4.13, -7.07],
}
FOUND = {"peer": "Peer 1", "peer_unknowns": 99, "deflections_m": [0.01, 0.02], "runs": RUNS, "travel": MOVED}


@pytest.fixture
def study(tmp_path: Path) -> Study:
    path = tmp_path / "own.toml"
    path.write_text(built_in_study().read_text(encoding="utf-8"), encoding="utf-8")
    return read_study(path)


@pytest.fixture
def record(study: Study) -> Kept:
    keep(study, NAME, COMMAND, crosscheck_tasks(study, (0.0, 15.0)), 100.0, FOUND)
    found = kept(study, NAME)
    assert found is not None
    return found


def curve(orientation: float, loads: tuple[float, ...]) -> StiffnessCurve:
    deflections = 0.01 * np.arange(len(loads) + 1)
    return StiffnessCurve(
        model="fe", orientation_deg=orientation, deflection=deflections, load=np.array([0.0, *loads]), source="test"
    )


def stale(study: Study) -> Study:
    return study.model_copy(update={"mesh": study.mesh.model_copy(update={"element_size": 0.01})})


def page(study: Study, results: PeerCheck) -> str:
    template = page_environment().get_template("crosscheck/evidence.html.j2")
    return str(template.render(results=results, study=study, figures={}))


def test_without_a_record_nothing_is_asked(study: Study) -> None:
    assert not CROSSCHECK.applies(study)


def test_ours_are_the_curves_of_this_report(study: Study, record: Kept) -> None:
    """A change of our loads is seen against the kept ones; where the report has no point, the record's own stands."""
    results = peer_check(study, record, {0.0: curve(0.0, (100.0, 150.0)), 15.0: curve(15.0, (90.0,))})
    assert results.state == "current"
    assert [row.ours for row in results.rows] == [100.0, 150.0, 90.0, 160.0]
    first, second, along = CROSSCHECK.checks(study, results)
    assert (first.id, first.status, first.value) == ("crosscheck.load_10mm", "fail", pytest.approx(0.196))
    assert (second.id, second.status, second.value) == ("crosscheck.load_20mm", "fail", pytest.approx(0.0125))
    assert (along.id, along.status, along.value) == ("crosscheck.fore_aft", "pass", pytest.approx(0.01))


def test_loads_within_one_percent_pass(study: Study, record: Kept) -> None:
    results = peer_check(study, record, {0.0: curve(0.0, (80.0, 150.0)), 15.0: curve(15.0, (90.0, 158.5))})
    assert [check.status for check in CROSSCHECK.checks(study, results)] == ["pass"] * 3
    assert [check.role for check in CROSSCHECK.checks(study, results)] == ["finding"] * 3


def test_a_record_of_another_mesh_decides_nothing(study: Study, record: Kept) -> None:
    other = stale(study)
    results = peer_check(other, record, {0.0: curve(0.0, (1.0, 1.0))})
    assert (results.state, results.rows[0].ours) == ("stale", 80.0)
    assert {check.status for check in CROSSCHECK.checks(other, results)} == {"undecided"}
    assert "stale" in page(other, results)
    assert COMMAND in page(other, results)


def test_a_record_of_older_sources_still_judges(study: Study, record: Kept) -> None:
    older = replace(record, sources="0")
    results = peer_check(study, older, {0.0: curve(0.0, (80.0, 150.0)), 15.0: curve(15.0, (70.0, 158.0))})
    assert results.state == "older sources"
    assert CROSSCHECK.checks(study, results)[0].status == "fail"
    assert CROSSCHECK.checks(study, results)[-1].status == "undecided"  # both of its sides are as they were kept
    assert "older sources" in page(study, results)


def test_the_page_shows_both_loads_and_where_they_come_from(study: Study, record: Kept) -> None:
    text = page(study, peer_check(study, record, {}))
    told = ("Peer 1", "80.40", "+0.50 %", "40 to 60 iterations", "is current", "code to code", record.date[:10])
    for words in (*told, "3.030", "+1.00 %"):
        assert words in text, words


def test_points_are_some_of_the_study(study: Study) -> None:
    orientations, deflections = points_of(study)
    assert orientations == pytest.approx((0.0, 25.0, 60.0, 80.0, 105.0))
    assert deflections == pytest.approx((0.01, 0.02, 0.03))


def test_the_record_of_the_built_in_study_is_whole() -> None:
    built_in = read_study(built_in_study())
    record = kept(built_in, NAME)
    assert record is not None
    assert json.dumps(record.found["deflections_m"]) == json.dumps(list(points_of(built_in)[1]))
    assert [run["orientation_deg"] for run in record.found["runs"]] == list(points_of(built_in)[0])
    assert all(len(run["peer_N"]) == len(run["ours_N"]) == 3 for run in record.found["runs"])


@pytest.mark.parametrize(
    "damage",
    [
        {"runs": []},
        {"peer": None},
        {"deflections_m": []},
        {"deflections_m": [-0.01, 0.02]},
        {"runs": [RUNS[0] | {"ours_N": [80.0]}]},
        {"runs": [RUNS[0] | {"ours_N": [0.0, 150.0]}]},
        {"runs": [RUNS[0] | {"peer_N": [80.0, 1e308]}]},
        {"runs": [RUNS[0] | {"peer_N": [80.0, "a"]}]},
        {"runs": [RUNS[0] | {"orientation_deg": "x"}]},
        {"travel": None},
        {"travel": MOVED | {"travel_m": [0.0, 0.0, 0.002]}},
        {"travel": MOVED | {"ours_N": [-4.0, -4.0, -7.0]}},
        {"travel": MOVED | {"ours_N": [-4.0, -5.0, -4.0]}},
        {"travel": MOVED | {"friction": "0.6"}},
        {"peer_unknowns": None},
        {"deflections_m": [0.01, 0.01]},
        {"runs": [RUNS[0] | {"iterations": "1.5"}]},
        {"travel": MOVED | {"ours_N": [-1.0]}},
        {"travel": MOVED | {"travel_m": [0.1, 0.2, 0.3]}},
        {"travel": MOVED | {"peer_N": [-1.0, -1.0, 1e10]}},
        {"travel": {k: v for k, v in MOVED.items() if k != "friction"}},
        {"runs": [{k: v for k, v in RUNS[0].items() if k != "iterations"}]},
    ],
)
def test_numbers_that_no_run_can_have_are_refused_before_anything_is_computed(
    study: Study, damage: dict[str, Any]
) -> None:
    keep(study, NAME, COMMAND, crosscheck_tasks(study, (0.0, 15.0)), 100.0, FOUND)
    assert CROSSCHECK.applies(study)
    keep(study, NAME, COMMAND, crosscheck_tasks(study, (0.0, 15.0)), 100.0, FOUND | damage)
    with pytest.raises(InputError, match=r"kept record.*cannot be read"):
        CROSSCHECK.applies(study)
