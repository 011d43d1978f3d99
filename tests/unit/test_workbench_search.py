"""A search of a sweep: aims and misses, the thickness at which a point is read, the strategy, what is best."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.errors import StudyError
from workbench.questions.sweep.graph import SweepRun
from workbench.questions.sweep.results import Outcome, nearest_orientation
from workbench.questions.sweep.search import MISSING, Judged, Strategy, best_points, judge, pareto
from workbench.study.reading import built_in_study, read_study, read_study_table, study_of
from workbench.study.sweep import SweepSection
from workbench.study.sweep_points import Point

PATH = built_in_study()
VARIED = {
    "wheel.tire.thickness": {"low": "0.5 mm", "high": "0.8 mm"},
    "wheel.grousers.phase": {"low": "0 deg", "high": "30 deg"},
}
AIMS = {"load_at_20mm_N": {"target": 160.0, "within": 0.03}, "max_linearised_at_160N_Pa": {"at_most": 400e6}}
SEARCH = {"design": "search", "samples": 40, "aims": AIMS, **VARIED}


def _section(**changes: Any) -> SweepSection:
    return SweepSection.model_validate(SEARCH | changes)


def _outcome(slope: float, stress: float, number: int = 1) -> Outcome:
    """A straight line of 40 mm with two orientations, 10 % off the mean, and a stress in proportion to the load."""
    deflection = np.linspace(0.0, 0.04, 41)

    def line(k: float) -> StiffnessCurve:
        load = k * deflection
        columns = {"max_linearised_tire_Pa": stress * load, "negative_pivots": 0.0 * load}
        return StiffnessCurve(model="section", orientation_deg=0.0, deflection=deflection, load=load, columns=columns)

    both = line(0.9 * slope), line(1.1 * slope)
    mean = line(slope)
    run = SweepRun(point=Point(number=number, values={}, study=read_study(PATH)), model="section", curves={}, tasks=())
    return Outcome(run=run, by_orientation=both, curve=mean)


def test_misses_are_one_at_the_limits() -> None:
    """160 N at 20 mm within 3 %: 164.8 N is 1; stress 400 MPa at 160 N is 1."""
    found = judge(_outcome(8240.0, 2.5e6), _section(), 0.005, {})
    assert found.scale == 1.0
    assert found.misses["load_at_20mm_N"] == pytest.approx(1.0)
    assert found.misses["max_linearised_at_160N_Pa"] == pytest.approx(1.0)
    assert found.cost == pytest.approx(found.largest)


def test_of_a_group_the_best_alternative_counts_with_all_its_aims() -> None:
    """8240 N/m: 3 % over 160 N at 20 mm, 0.5 % under 82.8 N at 10 mm, 3.8 % under 257 N at 30 mm."""
    near = {"load_at_10mm_N": {"target": 82.8, "within": 0.01}}
    groups = {"reading": {"late": {"load_at_30mm_N": {"target": 257.0, "within": 0.03}}, "early": near}}
    found = judge(_outcome(8240.0, 2.5e6), _section(one_of=groups), 0.005, {})
    assert found.chosen == {"reading": "early"}
    assert found.misses["reading"] == pytest.approx(abs(82.4 / 82.8 - 1.0) / 0.01)
    both = {"reading": {"early": near | groups["reading"]["late"]}}
    assert judge(_outcome(8240.0, 2.5e6), _section(one_of=both), 0.005, {}).misses["reading"] > 1.0


def test_a_search_may_read_a_point_at_the_thickness_that_meets_the_aims_best() -> None:
    """Twice as stiff: thinner by the cube root of two; at the same load its stress is higher by the square of that."""
    found = judge(_outcome(16000.0, 1e6), _section(scaled=True), 0.005, {})
    assert found.scale == pytest.approx(0.5 ** (1.0 / 3.0), rel=0.011)
    assert found.misses["load_at_20mm_N"] <= 1.0
    stress = found.misses["max_linearised_at_160N_Pa"] * 400e6
    assert stress == pytest.approx(160e6 * found.scale**-2.0, rel=1e-6)
    assert judge(_outcome(16000.0, 1e6), _section(), 0.005, {}).largest == MISSING  # negative control: 33 times 3 % off


def test_a_point_without_the_number_misses_by_far() -> None:
    short = _outcome(3000.0, 1e6)  # never reaches 160 N
    assert judge(short, _section(), 0.005, {}).misses["max_linearised_at_160N_Pa"] == MISSING
    failed = Outcome(run=short.run, note="why")
    assert set(judge(failed, _section(), 0.005, {}).misses.values()) == {MISSING}


def test_the_best_of_the_orientations_follows_a_curve() -> None:
    one = _outcome(8000.0, 1e6)
    reference = one.by_orientation[1]
    assert nearest_orientation(one.by_orientation, reference, (160.0, 250.0)) == pytest.approx(0.0)
    assert nearest_orientation(one.by_orientation[:1], reference, (160.0, 250.0)) == pytest.approx(1.0 - 0.9 / 1.1)
    assert nearest_orientation(one.by_orientation, reference, (400.0, 500.0)) is None


def _run(seed: int, batches: int) -> tuple[NDArray[np.float64], float]:
    """All points asked, and the least cost, for a bowl at (0.3, 0.7, 0.2)."""
    strategy, asked, least = Strategy(start=np.full(3, 0.5), batch=12, seed=seed), [], np.inf
    for _ in range(batches):
        batch = strategy.ask()
        costs = (np.abs(batch - [0.3, 0.7, 0.2])).max(axis=1)
        strategy.tell(costs.tolist())
        asked.append(batch)
        least = min(least, float(costs.min()))
    return np.concatenate(asked), least


def test_the_strategy_finds_a_minimum_and_goes_the_same_way_again() -> None:
    points, least = _run(1, 40)
    assert least < 1e-3
    assert points.min() >= 0.0
    assert points.max() < 1.0
    np.testing.assert_array_equal(points, _run(1, 40)[0])
    assert not np.array_equal(points[:12], _run(2, 1)[0])
    assert _run(1, 1)[1] > 0.05  # negative control: the first batch has not found it


def test_a_strategy_that_has_converged_starts_anew() -> None:
    points, _ = _run(1, 400)
    spread = points.reshape(-1, 12, 3).std(axis=1).max(axis=1)
    first_small = int(np.argmax(spread < 1e-6))
    assert spread[first_small] < 1e-6
    assert spread[first_small:].max() > 0.05


def _judged(number: int, *misses: float) -> Judged:
    outcome = _outcome(8000.0, 1e6, number)
    return Judged(scale=1.0, misses=dict(enumerate(misses)), chosen={}, outcome=outcome)  # type: ignore[arg-type]


def test_best_points_and_those_that_none_beats() -> None:
    table = {1: _judged(1, 2.0, 0.1), 2: _judged(2, 0.5, 1.5), 3: _judged(3, 2.0, 1.5), 4: _judged(4, 0.2, 3.0)}
    assert best_points(table, 2) == [2, 1]
    assert pareto(table) == {1, 2}  # 4 is no better than 2 where both are good


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"aims": {}}, "aims"),
        ({"design": "grid"}, "aims|range"),
        ({"models": ["section", "ancf"]}, "must be one for a search"),
        ({"aims": {"load_at_20mm_N": {"target": 160.0}}}, "within"),
        ({"aims": {"load_at_20mm_N": {"at_most": 1.0, "at_least": 2.0}}}, "must be one of three"),
        ({"samples": None}, "must say how many"),
        ({"batch": 2}, "batch"),
        ({"one_of": {"load_at_20mm_N": {"a": AIMS}}}, "is a column of the table too"),
        ({"one_of": {"reading": {}}}, "one_of.reading"),
        ({"one_of": {"reading": {"a": {}}}}, "one_of.reading.a"),
        ({"design": "latin-hypercube", "aims": {}, "scaled": True}, 'scaled = .*belongs to design = "search"'),
    ],
)
def test_a_bad_search_is_one_message(change: dict[str, Any], message: str) -> None:
    table = {key: value for key, value in (SEARCH | change).items() if value is not None}
    with pytest.raises(StudyError, match=message):
        study_of(PATH, read_study_table(PATH) | {"sweep": table})
