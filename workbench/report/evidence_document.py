"""The table "claim -> test or check -> last value" for the documentation, from the summary of a report.

``python -m workbench.report.evidence_document SUMMARY DOCUMENT [LIST]`` writes docs/evidence.md, and the list of checks
that the tests of the words know; `make evidence` does. Verified by tests/unit/test_evidence_document.py.
"""

from __future__ import annotations

import csv
import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from contracts.errors import InputError
from contracts.text import for_markdown
from workbench.verdict.number_format import displayed
from workbench.verdict.statements import statement_of

__all__ = ["document", "main", "rows_of", "written_list"]

_HEAD = """# Evidence

What each check of the shipped report claims, which tests hold the rule or the model behind it, its last value, and of a
gate the test in which a damaged model or number was seen to fail; made by `make evidence` from a report's
`summary.json`. The words are data, `workbench/questions/*/statements.toml`. Why each tolerance is what it is, and the
tasks and files behind each value, are in the report's section "Evidence".
"""


_COLUMNS = ("claim", "check", "tests", "last value", "limit", "seen to fail in")


def rows_of(summary: Path) -> tuple[Mapping[str, Any], list[Mapping[str, Any]]]:
    """Provenance and checks of a summary; InputError for anything else."""
    try:
        content = json.loads(summary.read_text(encoding="utf-8"))
        return content["provenance"], [row for row in content["checks"] if row["claim"]]
    except (OSError, ValueError, KeyError, TypeError):
        raise InputError("summary", summary, "is no summary of a report", "make report first") from None


def document(provenance: Mapping[str, Any], rows: Sequence[Mapping[str, Any]]) -> str:
    """The document: one table for each first part of the identifiers."""
    commit = str(provenance.get("commit") or "unknown")[:12]
    blocks = [_HEAD, f"Values of {str(provenance['created'])[:10]}, commit {commit}; {len(rows)} checks."]
    for name in dict.fromkeys(row["id"].split(".")[0] for row in rows):
        lines = [_line(row) for row in rows if row["id"].split(".")[0] == name]
        table = [f"| {' | '.join(_COLUMNS)} |", "|" + "---|" * len(_COLUMNS), *lines]
        blocks.append("\n".join([f"## `{name}`", "", *table]))
    return "\n\n".join(block.strip("\n") for block in blocks) + "\n"


def _line(row: Mapping[str, Any]) -> str:
    tests = ", ".join(f"`{Path(test).stem}`" for test in row["tests"])
    value = displayed(row["value"], row["unit"], row["quantity"])
    shown = for_markdown(value)
    status = {
        "pass": shown,
        "fail": f"**{shown}, outside**",
        "undecided": f"**{shown}, undecided**",
        "error": "not evaluated",
    }[row["status"]]
    cells = (for_markdown(row["claim"]), f"`{row['id']}`, {row['role']}", tests, status, for_markdown(_limit(row)))
    return "| " + " | ".join((*cells, _broken_by(row) if row["role"] == "gate" else "")) + " |"


def _broken_by(row: Mapping[str, Any]) -> str:
    """Functions of the tests that break the check; empty for one that the code no longer makes."""
    try:
        named = statement_of(row["id"], row["quantity"], row["title"]).broken_by
    except InputError:
        return ""
    return ", ".join(f"`{name.partition('::')[2]}`" for name in named)


def _limit(row: Mapping[str, Any]) -> str:
    reference = row["reference"]
    if isinstance(reference, list):
        low, high = (displayed(value, row["unit"], row["quantity"]) for value in reference)
        return f"{low} to {high}"
    if row["tolerance"].startswith("at ") or reference is None:
        return str(row["tolerance"])
    return f"{displayed(reference, row['unit'], row['quantity'])}, {row['tolerance']}"


def written_list(rows: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Identifier, quantity and title of each check as CSV."""
    with path.open("w", encoding="utf-8", newline="") as stream:
        table = csv.DictWriter(stream, ("id", "quantity", "title"), lineterminator="\n", extrasaction="ignore")
        table.writeheader()
        table.writerows(rows)


def main(arguments: Sequence[str]) -> None:
    """Write the document, and the list if its path is given."""
    provenance, rows = rows_of(Path(arguments[0]))
    Path(arguments[1]).write_text(document(provenance, rows), encoding="utf-8")
    if len(arguments) > 2:
        written_list(rows, Path(arguments[2]))


if __name__ == "__main__":
    main(sys.argv[1:])
