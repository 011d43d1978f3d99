"""The documentation's table of evidence has the checks of the code, in the code's words."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from contracts.errors import InputError
from contracts.text import for_markdown
from tests.unit.test_workbench_statements import SHIPPED
from workbench.report.evidence_document import document, main
from workbench.verdict.statements import statement_of

ROOT = Path(__file__).parents[2]
DOCUMENT = ROOT / "docs" / "evidence.md"
ROW = re.compile(r"^\| (?P<claim>.*?) \| `(?P<id>[\w.-]+)`, (gate|finding) \| (?P<tests>.*?) \|", re.MULTILINE)


def test_the_document_has_every_check_in_the_words_of_the_code() -> None:
    rows = {found["id"]: found for found in ROW.finditer(DOCUMENT.read_text(encoding="utf-8"))}
    words = {id: statement_of(id, quantity, title) for id, quantity, title in SHIPPED}
    assert list(rows) == sorted(rows, key=list(rows).index)
    assert set(rows) == set(words), "run make evidence after make report"
    claims = {id: for_markdown(said.claim) for id, said in words.items()}
    assert {id: row["claim"] for id, row in rows.items()} == claims
    assert [id for id, row in rows.items() if not row["tests"].startswith("`test_")] == []


def test_values_outside_and_not_evaluated_are_said() -> None:
    row = {
        "id": "fe.yield",
        "claim": "No part yields.",
        "tests": ["tests/unit/test_a.py"],
        "role": "finding",
        "value": 1.2,
        "unit": "-",
        "quantity": "stress / yield",
        "reference": 1.0,
        "tolerance": "at most 1",
        "status": "fail",
    }
    other = row | {"id": "mesh.mass", "value": None, "status": "error", "reference": [1.0, 2.0]}
    text = document({"created": "2026-11-22", "commit": None}, [row, other])
    assert "| No part yields. | `fe.yield`, finding | `test_a` | **1.2, outside** | at most 1 |" in text
    assert "| No part yields. | `mesh.mass`, finding | `test_a` | not evaluated | 1 to 2 |" in text
    gate = {"id": "fe.energy", "role": "gate", "quantity": "difference", "title": "FE: energy"}
    assert "`test_lost_energy_fails` |" in document({"created": "2026-11-22", "commit": None}, [row | gate])
    assert "test_lost" not in document({"created": "2026-11-22", "commit": None}, [row | gate | {"role": "finding"}])
    assert [line for line in text.splitlines() if line.startswith("## ")] == ["## `fe`", "## `mesh`"]


def test_what_is_no_summary_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="make report first"):
        main([str(tmp_path / "summary.json"), str(tmp_path / "evidence.md")])
