"""No check without its words: what it claims, why its tolerance is that, and tests and theory that exist.

Source: the words of workbench/data/statements. The shipped report's checks stand in tests/data/shipped_checks.csv
(identifier, quantity, title), written from its summary.json by `make evidence`.
"""

from __future__ import annotations

import ast
import csv
import re
from dataclasses import replace
from pathlib import Path
from typing import TypeGuard

import pytest

from contracts.errors import InputError
from workbench.study.sections import ToleranceSection
from workbench.verdict import rules
from workbench.verdict.rules import Claim, at_most
from workbench.verdict.statements import Family, Statement, families, statement_of

ROOT = Path(__file__).parents[2]
with (ROOT / "tests" / "data" / "shipped_checks.csv").open(encoding="utf-8", newline="") as stream:
    SHIPPED = [(row["id"], row["quantity"], row["title"]) for row in csv.DictReader(stream)]
FAMILY = Family(
    ids=("a.b_*",), quantities=(), words={"x": "the x"}, statement=Statement(claim="It is {0}: {what}.", why="ours")
)


def _claim(id: str) -> Claim:
    return Claim(id=id, title="t", quantity="q", unit="-", role="gate", source="s")


def test_every_shipped_check_has_words_of_its_own() -> None:
    assert len(SHIPPED) > 150
    said = {id: statement_of(id, quantity, title) for id, quantity, title in SHIPPED}
    assert [id for id, words in said.items() if not words.claim.endswith(".") or len(words.why) < 30] == []
    assert [id for id, words in said.items() if re.search(r"[{}]", f"{words.claim}{words.why}{words.tasks}")] == []


def test_tests_theory_and_settings_named_exist() -> None:
    chapters = [ROOT / "docs" / "theory.md", *(ROOT / "docs" / "theory").glob("*.md")]
    headings = re.findall(r"^#+ ([\d.]+)", "\n".join(c.read_text(encoding="utf-8") for c in chapters), re.MULTILINE)
    numbers = {heading.rstrip(".") for heading in headings}
    for words in (family.statement for family in families()):
        assert words.theory in {*numbers, ""}, words.claim
        assert words.setting in {*ToleranceSection.model_fields, ""}, words.claim
        assert all(any(ROOT.glob(path)) for path in words.tests), words.tests
        assert words.tests, words.claim


def test_what_breaks_a_gate_is_a_test_that_exists() -> None:
    named = {name for family in families() for name in family.statement.broken_by}
    assert len(named) > 30
    for name in named:
        path, _, function = name.partition("::")
        found = {node.name for node in ast.parse((ROOT / path).read_text(encoding="utf-8")).body if _is_test(node)}
        assert function in found, name


def _is_test(node: ast.stmt) -> TypeGuard[ast.FunctionDef]:
    return isinstance(node, ast.FunctionDef) and node.name.startswith("test_")


def test_a_gate_that_nothing_breaks_cannot_be_made(monkeypatch: pytest.MonkeyPatch) -> None:
    words = Statement(claim="It holds.", why="ours", tests=("tests/unit/test_workbench_statements.py",))
    monkeypatch.setattr(rules, "statement_of", lambda *of: words)
    with pytest.raises(InputError, match="must have been seen to fail"):
        at_most(_claim("a.gate"), lambda: 1.0, 2.0)
    assert at_most(replace(_claim("a.gate"), role="finding"), lambda: 1.0, 2.0).status == "pass"
    monkeypatch.setattr(rules, "statement_of", lambda *of: replace(words, broken_by=("here::test_it",)))
    assert at_most(_claim("a.gate"), lambda: 1.0, 2.0).role == "gate"


def test_every_family_is_of_a_check_that_the_report_makes() -> None:
    """But for those that other studies make: mirrored orientations, own references, runs that do not end so."""
    elsewhere = {
        *("fe.initial_tangent", "fe.deflection_at_*N", "fe.band"),
        *("fe.mirror_symmetry", "user_*.relative_l2", "rover.mission_*", "rover_ancf.mission_*", "rover_mission.*"),
        *("rover_mission.torque", "rover_mission.rock", "rover.exudyn_*", "traverse.*", "traverse.*_strength"),
        *("rover_ancf.straight_energy", "rover_ancf.straight_momentum", "soil.rover_*"),
    }
    unused = [f.ids[0] for f in families() if not any(f.match(id, q) is not None for id, q, _ in SHIPPED)]
    assert set(unused) <= elsewhere


def test_a_check_without_words_cannot_be_made() -> None:
    with pytest.raises(InputError, match=r"statements\.toml, is to 0"):
        at_most(_claim("fe.unheard_of"), lambda: 1.0, 2.0)
    with pytest.raises(InputError, match="is to 2"):
        statement_of("a.b_x", "q", "t", [FAMILY, FAMILY])
    made = at_most(_claim("fe.energy"), lambda: 1.0, 2.0)
    for name in ("claim", "why", "source", "id"):
        with pytest.raises(InputError, match=f"no {name}"):
            replace(made, **{name: " "})
    with pytest.raises(InputError, match="must be a sentence"):
        replace(made, claim="energy is kept")


@pytest.mark.parametrize(
    ("id", "title", "claim"),
    [
        ("a.b_x", "Here, there: what", "It is the x: what."),
        ("a.b_x_2", "what", "It is the x: what."),
        ("a.b_xy", "what", "It is xy: what."),
        ("a.b_-40C", "what", "It is -40 °C: what."),
        ("a.b_015", "what", "It is 15: what."),
    ],
)
def test_words_of_what_varies(id: str, title: str, claim: str) -> None:
    assert statement_of(id, "q", title, [FAMILY]).claim == claim
