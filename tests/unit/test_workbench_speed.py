"""The Speed section: kept benchmark runs are whole and readable, aims say met or missed, and the page shows them."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
import pytest

from benchmarks.fe_wheel import CASES
from benchmarks.output.run import Run
from contracts.curves import StiffnessCurve, average_curve
from contracts.errors import IncrementRecord, InputError
from workbench.questions.model_curves import ModelCurves, RunNumbers
from workbench.questions.speed.aims import (
    BESIDE_EXUDYN,
    CHRONO,
    FASTER,
    PATHS,
    PEER_TIME,
    STRAIGHT_PATH,
    TIME,
    Aim,
    ancf_aims,
    flexible_aims,
    rover_aims,
)
from workbench.questions.speed.question import RANKS, SPEED, CurveCost, SpeedResults, _costs, kept_runs
from workbench.questions.speed.record import read_record
from workbench.report.page import TEMPLATES
from workbench.verdict.number_format import displayed

SOLID = CurveCost(model="fe", orientation=15.0, dofs=40, points=18, increments=19, iterations=72, solve_s=9.0)


def results(*curves: CurveCost) -> SpeedResults:
    return SpeedResults(**kept_runs(), curves=curves or (SOLID,))


def test_the_kept_runs_are_whole() -> None:
    wheel, ranks = read_record("fe_wheel"), read_record("fe_ranks")
    far = [case for case in CASES if not case.startswith("ground")]  # those are pressed by 5 mm
    assert set(wheel.cases("time to 20 mm")) == {f"{c} against {p}" for c in far for p in ("CalculiX", "FElupe")}
    assert len(ranks.cases(RANKS)) == 1
    for run in kept_runs().values():
        assert len(run.commit) == 40
        assert run.versions["numpy"] != "missing"
        for row in run.rows:
            if row.ratio is not None and row.peer is not None:
                assert row.ratio == pytest.approx(row.peer / row.ours)
    with pytest.raises(InputError, match="must be among the rows"):
        wheel.row("half-cylinder-40 against CalculiX", "time to the moon")


@pytest.mark.parametrize(
    ("rule", "met"),
    [("at least", (False, True, True)), ("more than", (False, False, True)), ("at most", (True, True, False))],
)
def test_an_aim_is_met_on_the_right_side(rule: Any, met: tuple[bool, ...]) -> None:
    assert tuple(Aim(title="", found=found, limit=3.0, rule=rule).met for found in (2.9, 3.0, 3.1)) == met


def test_aims_take_the_worst_number() -> None:
    found = results(SOLID, replace(SOLID, iterations=90), replace(SOLID, model="section", solve_s=6.0))
    iterations, planar = found.own_aims
    assert (iterations.found, iterations.met) == (pytest.approx(100.0), False)
    assert (planar.found, planar.met) == (6.0, False)
    assert [aim.met for aim in results().own_aims] == [True]
    calculix = [row.ratio for row in found.wheel.rows if "CalculiX" in row.case and row.metric.startswith("Newton")]
    assert found.aims[2].found == min(calculix)


def test_aims_of_the_ancf_tire_follow_the_kept_run() -> None:
    """Each is met where the run is far inside its limit, and missed where it is far outside."""
    record = read_record("ancf_tire")
    for factor, met in ((1e-3, (True, False)), (1e3, (False, True))):  # all numbers smaller, all larger
        scaled = replace(record, rows=tuple(replace(row, ours=factor * row.ours) for row in record.rows))
        aims = ancf_aims(scaled)
        assert [aim.met for aim in aims] == [met[0] if aim.rule == "at most" else met[1] for aim in aims]
    assert len(aims) == 6
    meshes = [row for row in record.rows if row.metric == "force, a plate"]
    assert [row.case for row in meshes] == ["8 plates", "50 plates", "400 plates", "3000 plates"]


def test_aims_of_the_rover_follow_the_kept_run() -> None:
    record = read_record("rover_brush")
    for faster, met in ((19.9, False), (20.1, True)):
        rows = tuple(replace(r, ours=faster) if r.metric == FASTER else r for r in record.rows)
        assert [aim.met for aim in rover_aims(replace(record, rows=rows))][:2] == [met, met]
    for ratio, met in ((1.9, False), (2.1, True)):
        rows = tuple(replace(r, ratio=ratio) if r.metric == PEER_TIME else r for r in record.rows)
        assert rover_aims(replace(record, rows=rows))[2].met is met
    for case, end in PATHS.items():
        assert record.row(case, FASTER).ours == pytest.approx(end / record.row(case, "processor time").ours)
    ours, theirs = (getattr(record.row(BESIDE_EXUDYN, "error along the path"), side) for side in ("ours", "peer"))
    assert theirs == pytest.approx(ours, rel=0.5)
    alone = tuple(r for r in record.rows if r.case != BESIDE_EXUDYN)
    assert len(rover_aims(replace(record, rows=alone))) == 2


def test_the_aim_of_the_rover_on_ancf_tires_follows_the_kept_run() -> None:
    record = read_record("rover_ancf")
    for seconds, met in ((19.9, True), (20.1, False)):
        rows = tuple(replace(r, ours=seconds) if r.metric == TIME else r for r in record.rows)
        assert [aim.met for aim in flexible_aims(replace(record, rows=rows))] == [met]
    spent = record.row(STRAIGHT_PATH, TIME).ours
    assert record.row(STRAIGHT_PATH, FASTER).ours == pytest.approx(40.0 / spent)


def test_the_check_fails_where_a_curve_took_too_many_iterations() -> None:
    statuses = [SPEED.checks(None, results(replace(SOLID, iterations=n)))[0].status for n in (72, 73)]  # type: ignore[arg-type]
    assert statuses == ["pass", "fail"]


def test_cost_is_read_from_the_stored_numbers() -> None:
    D = np.linspace(0.0, 0.03, 4)
    curve = StiffnessCurve(model="fe", orientation_deg=0.0, deflection=D, load=1e4 * D)
    attempts = (
        IncrementRecord(target=0.01, step=0.01, converged=True, residuals=(1.0, 1e-3, 1e-9)),
        IncrementRecord(target=0.02, step=0.01, converged=False, residuals=(1.0, 2.0)),
    )
    run = RunNumbers(dofs=81, solve_s=2.5, increments=attempts)
    curves = ModelCurves(model="fe", by_orientation={0.0: curve}, average=average_curve([curve]), runs={0.0: run})
    (cost,) = _costs("fe", curves)
    wanted = CurveCost(model="fe", orientation=0.0, dofs=81, points=3, increments=1, iterations=3, solve_s=2.5)
    assert cost == wanted


def test_the_section_says_met_and_missed() -> None:
    loader = jinja2.FileSystemLoader(TEMPLATES)
    environment = jinja2.Environment(loader=loader, undefined=jinja2.StrictUndefined, autoescape=True)
    environment.filters["number"] = displayed
    found = results(SOLID, replace(SOLID, model="section", solve_s=6.0))
    text = environment.get_template("speed/evidence.html.j2").render(results=found)
    met = sum(aim.met for aim in found.aims)
    assert (text.count("✓ met"), text.count("△ missed")) == (met, len(found.aims) - met)
    assert 0 < met < len(found.aims)
    assert found.wheel.commit in text
    assert "another machine" in text
    assert all(f"{value:g}" in text for value in CHRONO.values())


def test_a_run_is_kept_only_when_asked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import benchmarks.output.run as module

    monkeypatch.setattr(module, "ROOT", tmp_path)
    monkeypatch.setattr(module, "DATA", tmp_path / "data")
    row = {"case": "a", "metric": "b", "unit": "s", "ours": 1.0, "peer": 3.0, "ratio": 3.0}
    run = Run("made_up", {"ccx": "2.20"})
    run.write([row], keep=False)
    assert not (tmp_path / "data").exists()
    plain = json.loads((tmp_path / "build" / "bench" / "made_up.json").read_text(encoding="utf-8"))
    assert plain == {"schema": 1, "name": "made_up", "rows": [row]}
    run.write([row], keep=True)
    kept = read_record("made_up", tmp_path / "data")
    assert (kept.row("a", "b").ratio, kept.versions["ccx"]) == (3.0, "2.20")
