"""Contents and first screen: every section has one place, every check a section, nothing outside is left out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from contracts.records import Check
from workbench.comparison.agreement import Agreement
from workbench.report.contents import contents, section_of
from workbench.report.opening import check_groups, opening
from workbench.study.reading import built_in_study, read_study
from workbench.topics.registry import TOPICS

STUDY = read_study(built_in_study())
TITLES = {topic.name: topic.title for topic in TOPICS} | {
    name: name for name in ("models", "wheel", "fe", "ancf", "checks", "numerics", "origin", "reading", "new")
}


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


def test_every_section_stands_in_one_group() -> None:
    placed = [section.name for group in contents(TITLES) for section in group.sections]
    assert sorted(placed) == sorted(TITLES)
    assert {"checks", "origin", "reading", "new"} <= {s.name for s in contents(TITLES)[-1].sections}
    assert all(group.sections for group in contents({"fe": "Finite elements"}))


@pytest.mark.parametrize(
    ("check", "section"),
    [
        ("fe.initial_tangent", "fe"),
        ("fe.mesh_uncertainty", "mesh_study"),
        ("fe.first_yield_load", "strength"),
        ("user_3.relative_l2", "models"),
        ("ancf_vs_fe.iso_18571", "models"),
        ("rover_ancf.drop", "rover_ancf"),
        ("verify.ring_load", "verification"),
        ("unheard.of", "checks"),
    ],
)
def test_a_check_links_to_the_section_that_shows_it(check: str, section: str) -> None:
    assert section_of(_check(check), TITLES) == section


def test_a_check_of_a_section_that_is_left_out_goes_one_up() -> None:
    without = {name: title for name, title in TITLES.items() if name != "strength"}
    assert section_of(_check("fe.yield"), without) == "fe"


def test_checks_are_grouped_in_the_order_of_the_sections() -> None:
    made = [_check("rover.load"), _check("fe.reach"), _check("rover.drop")]
    groups = [(name, [c.id for c in held]) for name, _, held in check_groups(made, {"fe": "F", "rover": "R"})]
    assert groups == [("fe", ["fe.reach"]), ("rover", ["rover.load", "rover.drop"])]


def test_the_first_screen_shows_all_that_did_not_pass_gates_first() -> None:
    made = [_check("fe.yield", "fail"), _check("fe.reach"), _check("mesh.mass", "error", "gate", value=None)]
    found = opening(STUDY, made, {"brush": _agreement(0.2, 0.01, "differs")}, TITLES)
    assert [(o.check.id, o.section, o.value) for o in found.outside] == [
        ("mesh.mass", "wheel", "–"),
        ("fe.yield", "strength", "1 N"),
    ]
    assert "1 of 1 gates did not pass" in found.verdict


def test_a_rating_draws_its_doubt_inside_the_scale() -> None:
    rating, unknown = (
        opening(STUDY, [], {"brush": one}, TITLES).ratings[0]
        for one in (_agreement(0.2, 0.03, "differs"), _agreement(0.02, None, "not known"))
    )
    assert (rating.name, rating.tone, unknown.tone) == ("Brush tire", "fail", "error")
    assert rating.at(0.0) == 0.0
    assert rating.at(0.1) < rating.at(0.2) < rating.at(0.23) <= 100.0
    assert unknown.at(0.1) == pytest.approx(62.5)


def test_scripts_and_styles_are_there() -> None:
    """What the page includes lies beside its templates, so that it is installed with them."""
    folder = Path(__file__).parents[2] / "workbench" / "report" / "templates"
    text = (folder / "report.html.j2").read_text(encoding="utf-8")
    styles, scripts = ("style.css.j2", "print.css.j2"), ("unpack", "scenes", "legend", "touch", "figures", "page")
    for name in (*styles, *(f"{script}.js" for script in scripts)):
        assert f'include "{name}"' in text
        assert (folder / name).stat().st_size > 200
