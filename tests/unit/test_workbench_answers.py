"""The three answers of the first page: what passed, what failed, and that nothing undecided ever counts as passed."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from contracts.records import Check
from workbench.questions.comparison import Comparison
from workbench.questions.model_curves import ModelCurves, RunNumbers, mean_curve
from workbench.questions.models.metrics import compare_curves
from workbench.questions.models.results import ComparedModels
from workbench.report.answers import answers, computation, wheel
from workbench.report.stand_ins import range_within, stand_ins
from workbench.study.reading import built_in_study, read_study
from workbench.study.reference import CurveReference, ReferenceSection
from workbench.verdict.decision import together
from workbench.verdict.status import exit_status, overall_status

STUDY = read_study(built_in_study())
AT = np.linspace(0.0, 0.035, 36)
LINE = 8000.0 * AT


def _check(name: str, status: str = "pass", role: str = "finding", **more: Any) -> Check:
    fields: dict[str, Any] = {
        "title": name,
        "quantity": "load",
        "unit": "N",
        "value": 1.0,
        "reference": 2.0,
        "tolerance": "at most 2 N",
        "claim": "It holds.",
        "why": "ours",
    }
    return Check(id=name, status=status, role=role, source="s", **(fields | more))  # type: ignore[arg-type]


def _sections(checks: list[Check]) -> dict[str, str]:
    return {c.id: c.id.partition(".")[0] for c in checks}


def test_several_answers_come_to_one() -> None:
    assert together(["yes", "yes"]) == "yes"
    assert together(["yes", "undecided"]) == "undecided"
    assert together(["undecided", "no"]) == "no"
    assert together([]) == "undecided"


@pytest.mark.parametrize(
    ("status", "decision", "overall", "code"),
    [
        ("pass", "yes", "pass", 0),
        ("fail", "no", "fail", 1),
        ("undecided", "undecided", "fail", 1),
        ("error", "undecided", "error", 1),
    ],
)
def test_a_gate_decides_about_the_computation(status: str, decision: str, overall: str, code: int) -> None:
    checks = [_check("mesh.mass", role="gate"), _check("fe.balance", status, "gate"), _check("fe.yield", "fail")]
    found = computation(checks, _sections(checks))
    assert found.decision == decision
    assert overall_status(checks) == overall
    assert exit_status(checks) == code
    assert found.sentence == ("All 2 gates hold." if status == "pass" else "1 of 2 gates does not hold.")
    assert [part.section for part in found.parts] == ([] if status == "pass" else ["fe"])


def test_without_a_gate_nothing_is_sound() -> None:
    assert computation([], {}).decision == "undecided"


@pytest.mark.parametrize(
    ("reach", "yields", "mission", "decision"),
    [
        ("pass", "pass", "pass", "yes"),
        ("pass", "fail", "undecided", "no"),
        ("pass", "pass", "undecided", "undecided"),
        ("error", "pass", "pass", "undecided"),
    ],
)
def test_the_wheel_does_its_job_if_every_part_is_met(reach: str, yields: str, mission: str, decision: str) -> None:
    checks = [
        _check("fe.reach", reach),
        _check("fe.first_yield_load", yields, tolerance="at least 2 N"),
        _check("rover_mission.fe", mission, unit="-", tolerance="at least 6"),
        _check("words.brush_fails", "fail"),  # of the thesis' words the inferred band alone judges the wheel
    ]
    found = wheel(STUDY, checks, _sections(checks))
    assert found.decision == decision
    parts = {part.name: part for part in found.parts}
    assert set(parts) == {"reach", "strength", "mission"}
    assert parts["strength"].text.startswith("no part yields below 1 N (at least 2 N); the alloy")
    assert parts["mission"].text == "requirements that the rover meets on it 1 (at least 6)"


@pytest.mark.parametrize(("status", "decision"), [("pass", "yes"), ("fail", "no"), ("undecided", "undecided")])
def test_an_inferred_reference_is_told_as_what_it_is(status: str, decision: str) -> None:
    """The band of the wheels from which this one was chosen: no independent evidence."""
    checks = [_check("words.band", status, tolerance="at most 2 %")]
    (part,) = wheel(STUDY, checks, _sections(checks)).parts
    assert (part.name, part.decision) == ("stiffness", decision)
    assert "the reference is inferred, what Sivo's curve must look like, if the thesis" in part.text
    assert "agreement is no independent evidence" in part.text


def test_a_measured_curve_decides_and_is_named_measured() -> None:
    curve = CurveReference(file="a.csv", label="rig", kind="measured", source="June", uncertainty="3 %")
    study = STUDY.model_copy(update={"reference": ReferenceSection(curves=(curve,))})
    checks = [_check("user_0.relative_l2", "fail", tolerance="at most 10 %; uncertainty ±3 %: differs")]
    (part,) = wheel(study, checks, _sections(checks)).parts
    assert (part.decision, part.text.rpartition("; ")[2]) == ("no", "the reference is measured")


def test_without_a_reference_the_page_says_so() -> None:
    silent = STUDY.model_copy(update={"reference": None})
    assert wheel(silent, [], {}).sentence.endswith("No reference: nothing of its stiffness is judged.")
    assert "No reference" not in wheel(STUDY, [], {}).sentence


def test_evenness_is_asked_where_the_study_asks_for_it() -> None:
    checks = [_check("fe.spread_5mm", "fail")]
    own = STUDY.tolerances.model_copy()
    assert "orientation_spread" in own.model_fields_set
    assert wheel(STUDY, checks, _sections(checks)).decision == "no"
    silent = STUDY.model_copy(update={"tolerances": type(own)()})
    assert wheel(silent, checks, _sections(checks)).sentence == "The study asks nothing of it."


def test_a_part_is_told_by_what_is_worst() -> None:
    checks = [
        _check("fe.spread_5mm", value=0.1, reference=0.5, tolerance="at most 0.5"),
        _check("fe.spread_20mm", value=0.4, reference=0.5, tolerance="at most 0.5"),
    ]
    assert "0.4" in wheel(STUDY, checks, _sections(checks)).parts[0].text


def _curve(load: Any, orientation: float | None = 0.0, at: Any = AT) -> StiffnessCurve:
    return StiffnessCurve(model="x", orientation_deg=orientation, deflection=at, load=load)


def _models(loads: dict[float, Any]) -> ModelCurves:
    curves = {o: _curve(load, o) for o, load in loads.items()}
    runs = dict.fromkeys(curves, RunNumbers())
    return ModelCurves(model="x", by_orientation=curves, average=mean_curve(list(curves.values())), runs=runs)


def _found(brush: Any, uncertainty: float | None = 0.01) -> Comparison:
    """An FE wheel 5 % to both sides of a line, beside a brush line."""
    fe, line = _models({0.0: 1.05 * LINE, 30.0: 0.95 * LINE}), _curve(brush, None)
    mesh = None if uncertainty is None else SimpleNamespace(l2_uncertainty=lambda *_: uncertainty)
    models = ComparedModels(
        continuum=cast(Any, SimpleNamespace(fe=fe, mesh_study=mesh, users=())),
        ancf=None,
        brush=line,
        metrics={"brush": compare_curves(line, fe.average)},
        limit=0.10,
    )
    return cast(
        Comparison,
        SimpleNamespace(checks=(), question_of={}, answers={"models": models}, agreements=models.agreements),
    )


@pytest.mark.parametrize(
    ("share", "uncertainty", "average", "decision"),
    [
        (1.00, 0.01, "yes", "yes"),  # single orientations 5 % off
        (1.07, 0.01, "yes", "no"),  # 7 % on average, 12.6 % at 30 degrees
        (1.042, 0.01, "yes", "undecided"),  # 9.7 % at 30 degrees
        (1.20, 0.01, "no", "no"),
        (1.00, None, "undecided", "undecided"),
    ],
)
def test_a_model_may_stand_in_on_average_and_at_every_orientation(
    share: float, uncertainty: float | None, average: str, decision: str
) -> None:
    found = stand_ins(_found(share * LINE, uncertainty))
    assert [one.key for one in found] == ["brush"]
    assert (found[0].on_average, found[0].decision) == (average, decision)
    assert found[0].worst == pytest.approx(max(abs(share / 1.05 - 1.0), share / 0.95 - 1.0))
    told = answers(STUDY, _found(share * LINE, uncertainty))
    assert told.summary["models"] == {"brush": decision}
    assert told.stand_in.decision == {"yes": "yes", "no": "no", "undecided": "undecided"}[decision]


def test_the_third_answer_names_ranges_and_what_is_open() -> None:
    assert answers(STUDY, _found(LINE)).stand_in.sentence == "Brush tire, within 10 % up to 250 N."
    assert answers(STUDY, _found(1.07 * LINE)).stand_in.sentence == "On average alone: Brush tire."
    assert answers(STUDY, _found(1.042 * LINE)).stand_in.sentence == "Not decided: Brush tire."
    assert answers(STUDY, _found(1.2 * LINE)).stand_in.sentence == "None of those compared."


def test_the_range_is_the_widest_in_which_the_loads_agree() -> None:
    reference = _curve(LINE)
    assert range_within(_curve(1.05 * LINE), reference, 0.10) == (0.0, pytest.approx(250.0, abs=1.0))
    assert range_within(_curve(1.20 * LINE), reference, 0.10) is None
    late = _curve(np.maximum(0.0, LINE - 8.0))  # within 10 % from 80 N on
    assert range_within(late, reference, 0.10) == pytest.approx((80.0, 250.0), abs=1.0)


def test_the_scale_of_a_rating_has_room_for_its_doubt() -> None:
    found, unknown = stand_ins(_found(1.2 * LINE, 0.03))[0], stand_ins(_found(LINE, None))[0]
    assert (found.tone, unknown.tone) == ("fail", "error")
    assert found.at(0.0) == 0.0
    assert found.at(0.1) < found.at(0.2) < found.at(0.23) <= 100.0
    assert unknown.at(0.1) == pytest.approx(62.5)


def test_a_curve_without_common_range_is_left_out() -> None:
    found = _found(LINE)
    models = found.answers["models"]
    far = replace(models, brush=_curve(LINE, None, AT + 1.0))
    cast(Any, found).answers["models"] = far
    assert stand_ins(found) == []


@pytest.mark.parametrize(
    ("end", "words"),
    [
        (0.040, "8 N/mm over the first 5 mm, 31.2 mm at 250 N; "),
        (0.020, "8 N/mm over the first 5 mm; "),
        (0.004, ""),
    ],
)
def test_the_line_on_stiffness_begins_with_the_average_as_far_as_it_goes(end: float, words: str) -> None:
    at = np.linspace(0.0, end, 9)
    average = StiffnessCurve(model="fe", orientation_deg=None, deflection=at, load=8000.0 * at)
    checks = [_check("words.band")]
    plain, told = (wheel(STUDY, checks, _sections(checks), one).parts[0].text for one in (None, average))
    assert told == f"{words}{plain}"


def test_the_first_answer_names_what_the_mesh_may_move() -> None:
    checks = [_check("fe.mesh_uncertainty", role="gate", value=0.009), _check("fe.stress_uncertainty", value=0.042)]
    sentence = computation(checks, _sections(checks)).sentence
    assert sentence == "All 1 gates hold; the mesh may move the load by 0.9 % and the stress by 4.2 %."


def test_the_stiffness_told_is_that_of_the_elements_average() -> None:
    """1.05 and 0.95 times the line; not the brush tire's, 1.2 times it."""
    found = cast(Any, _found(1.2 * LINE))
    found.checks, found.question_of = (_check("words.band"),), {"words.band": "words"}
    told = answers(STUDY, found).wheel.parts[0].text
    slope = _models({0.0: LINE}).average.load_at(0.005) / 0.005 / 1e3
    assert told.startswith(f"{slope:.3g} N/mm over the first 5 mm")
