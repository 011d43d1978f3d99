"""Contents and first screen: every section has one place, every check a section, nothing outside is left out."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

from contracts.records import Check
from workbench.questions.comparison import Comparison
from workbench.questions.models.agreement import Agreement
from workbench.questions.models.results import ComparedModels
from workbench.questions.registry import QUESTIONS
from workbench.report.contents import EVIDENCE, REPORT, contents, page_of, section_titles
from workbench.report.opening import check_groups, opening
from workbench.study.reading import built_in_study, read_study

STUDY = read_study(built_in_study())


def _check(name: str, status: str = "pass", role: str = "finding", **more: Any) -> Check:
    fields: dict[str, Any] = {
        "quantity": "load",
        "unit": "N",
        "value": 1.0,
        "reference": 2.0,
        "tolerance": "at most 2",
        "claim": "It holds.",
        "why": "ours",
    }
    return Check(id=name, title=name, status=status, role=role, source="s", **(fields | more))  # type: ignore[arg-type]


def _agreement(distance: float, uncertainty: float | None, verdict: str) -> Agreement:
    return Agreement(pair="brush", distance=distance, uncertainty=uncertainty, limit=0.1, verdict=verdict)  # type: ignore[arg-type]


def _found(checks: list[Check], judged: Mapping[str, Agreement] | None = None, **made_by: str) -> Comparison:
    """A comparison with these checks, each made by the question named like its first part unless said otherwise."""
    made = {c.id: made_by.get(c.id.replace(".", "_"), c.id.partition(".")[0]) for c in checks}
    models = ComparedModels(
        continuum=cast(Any, SimpleNamespace(fe=SimpleNamespace(average=None))),
        ancf=None,
        brush=None,
        metrics={},
        limit=0.1,
    )
    fields = {"checks": tuple(checks), "question_of": made, "agreements": judged or {}, "answers": {"models": models}}
    return cast(Comparison, SimpleNamespace(**fields))


def test_every_section_stands_in_one_group() -> None:
    own = {"checks", "evidence", "files", "chosen", "origin", "reading"}
    placed = {page: [s.name for group in contents(STUDY, page) for s in group.sections] for page in (REPORT, EVIDENCE)}
    assert all(len(set(names)) == len(names) for names in placed.values())
    assert set(placed[REPORT]) == {one.name for one in QUESTIONS if one.budget}
    assert set(placed[REPORT]) | set(placed[EVIDENCE]) == {one.name for one in QUESTIONS} | own
    assert set(section_titles(STUDY)) == set(placed[REPORT]) | set(placed[EVIDENCE])
    assert [s.name for s in contents(STUDY, REPORT)[0].sections] == ["models", "words"]
    assert {s.name for s in contents(STUDY, EVIDENCE)[-1].sections} == own
    assert {"verification", "multibody", "speed", "numerics", "contact", "hub", "mesh_study"} <= set(placed[EVIDENCE])


def test_a_check_leads_to_the_report_where_its_question_stands_there() -> None:
    pages = page_of(STUDY)
    assert (pages["strength"], pages["contact"], pages["checks"]) == (REPORT, EVIDENCE, EVIDENCE)
    assert list(pages) == list(section_titles(STUDY))


def test_the_budgets_leave_room_for_first_page_headings_and_later_questions() -> None:
    """15 screens of 1000 points in all, of which the first page, headings and footer take some 2500."""
    assert sum(one.budget for one in QUESTIONS) <= 12_500


def test_a_study_without_rover_has_no_group_of_it() -> None:
    without = STUDY.model_copy(update={"rover": None})
    assert "Rover" in [group.title for group in contents(STUDY, REPORT)]
    assert "Rover" not in [group.title for page in (REPORT, EVIDENCE) for group in contents(without, page)]
    assert all(group.sections for page in (REPORT, EVIDENCE) for group in contents(without, page))


def test_checks_are_grouped_in_the_order_of_the_sections() -> None:
    made = _found([_check("rover.load"), _check("fe.reach"), _check("rover.drop")])
    groups = [(name, [c.id for c in held]) for name, _, held in check_groups(made, {"fe": "F", "rover": "R"})]
    assert groups == [("fe", ["fe.reach"]), ("rover", ["rover.load", "rover.drop"])]


def test_the_first_screen_shows_all_that_did_not_pass_gates_first() -> None:
    made = [_check("fe.yield", "fail"), _check("fe.reach"), _check("mesh.mass", "error", "gate", value=None)]
    judged = {"brush": _agreement(0.2, 0.01, "differs")}
    found = opening(STUDY, _found(made, judged, fe_yield="strength", mesh_mass="wheel"))
    assert [(o.check.id, o.section, o.value) for o in found.outside] == [
        ("mesh.mass", "wheel", "–"),
        ("fe.yield", "strength", "1 N"),
    ]
    assert "1 of 1 gates did not pass" in found.verdict


def test_scripts_and_styles_are_there() -> None:
    """What the page includes lies beside its templates, so that it is installed with them."""
    folder = Path(__file__).parents[2] / "workbench" / "report" / "templates"
    text = (folder / "page.html.j2").read_text(encoding="utf-8")
    styles, scripts = ("style.css.j2", "print.css.j2"), ("unpack", "scenes", "legend", "touch", "figures", "page")
    for name in (*styles, *(f"{script}.js" for script in scripts)):
        assert f'include "{name}"' in text
        assert (folder / name).stat().st_size > 200
