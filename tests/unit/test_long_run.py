"""The record of the long tests: stale once a source changes, and its page says what the record says."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.long_run import MARK, PAGE, RECORD, ROOT, key_of, outcomes, page_of, state_of

JUNIT = """<testsuites><testsuite>
<testcase classname="tests.unit.test_a" name="test_one" time="1.26"/>
<testcase classname="tests.unit.test_a" name="test_two[b.c]" time="2"><failure message="x"/></testcase>
<testcase classname="tests.unit.test_a" name="test_three" time="0"><skipped message="why"/></testcase>
</testsuite></testsuites>"""


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A project of two sources, one long test and one that is not."""
    for name, text in {
        "contracts/curves.py": "A = 1\n",
        "tests/shared.py": "B = 1\n",
        "tests/unit/test_kills.py": f"@{MARK}\ndef test_kill(): ...\n",
        "tests/unit/test_quick.py": "def test_quick(): ...\n",
    }.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize(
    ("name", "state"),
    [
        ("contracts/curves.py", "stale"),
        ("tests/shared.py", "stale"),
        ("tests/unit/test_kills.py", "stale"),
        ("tests/unit/test_quick.py", "current"),
    ],
)
def test_a_record_is_stale_once_a_source_changes(tree: Path, name: str, state: str) -> None:
    assert state_of(tree) == "not run yet"
    (tree / RECORD).parent.mkdir()
    (tree / RECORD).write_text(json.dumps({"key": key_of(tree)}), encoding="utf-8")
    assert state_of(tree) == "current"
    (tree / name).write_text((tree / name).read_text(encoding="utf-8") + "C = 1\n", encoding="utf-8")
    assert state_of(tree) == state


def test_outcomes_are_those_of_the_report(tmp_path: Path) -> None:
    (tmp_path / "junit.xml").write_text(JUNIT, encoding="utf-8")
    found = {row["test"]: (row["outcome"], row["seconds"]) for row in outcomes(tmp_path / "junit.xml")}
    assert found == {
        "tests/unit/test_a.py::test_one": ("passed", 1.3),
        "tests/unit/test_a.py::test_two[b.c]": ("failed", 2.0),
        "tests/unit/test_a.py::test_three": ("skipped", 0.0),
    }


def test_the_page_is_the_records_own() -> None:
    page = (ROOT / PAGE).read_text(encoding="utf-8")
    assert "<!-- state -->" in page
    if (ROOT / RECORD).is_file():
        assert page == page_of(json.loads((ROOT / RECORD).read_text(encoding="utf-8")))


def test_long_tests_are_left_out_unless_asked_for() -> None:
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    assert "-m 'not long'" in text
    assert '"long: takes minutes; make test-long"' in text
