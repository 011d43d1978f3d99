"""The report as a document: written beside the page, whole, with the same verdict."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest


def test_the_document_lies_beside_the_page(first_report: subprocess.CompletedProcess[str], workspace: Path) -> None:
    data = (workspace / "report" / "report.pdf").read_bytes()
    assert data.startswith(b"%PDF-")
    assert data.rstrip().endswith(b"%%EOF")
    assert 100_000 < len(data) < 20_000_000


@pytest.mark.skipif(shutil.which("pdftotext") is None, reason="no pdftotext on PATH")
def test_it_says_what_the_page_says(first_report: subprocess.CompletedProcess[str], workspace: Path) -> None:
    path = workspace / "report" / "report.pdf"
    run = subprocess.run(["pdftotext", "-layout", path, "-"], capture_output=True, text=True, check=True)
    words = " ".join(run.stdout.split())
    for text in (
        "gates passed",
        "Is the computation sound?",
        "Which model may stand in for the wheel?",
        "Contents",
        "Continuum finite elements",
        "1 / ",
    ):
        assert text in words, text


@pytest.mark.skipif(shutil.which("pdftotext") is None, reason="no pdftotext on PATH")
def test_paper_holds_the_evidence_and_asks_for_no_pointer(
    first_report: subprocess.CompletedProcess[str], workspace: Path
) -> None:
    """Every claim with its source; nothing to drag, hover, click or tap."""
    run = subprocess.run(
        ["pdftotext", "-raw", workspace / "report" / "report.pdf", "-"], capture_output=True, text=True, check=True
    )
    words = letters(run.stdout)
    assert "Whysomuch" in words
    for check in json.loads((workspace / "report" / "summary.json").read_text(encoding="utf-8"))["checks"]:
        for text in (check["claim"], check["source"], check["id"]):
            assert letters(text) in words, text
    assert not re.findall(r"\b(drag to|hover|click|tap|slider|buttons?)\b", run.stdout, re.IGNORECASE)


def letters(text: str) -> str:
    """Without spaces, ends of lines and the hyphens there, however a text is broken."""
    return re.sub(r"[^0-9A-Za-z]", "", text)
