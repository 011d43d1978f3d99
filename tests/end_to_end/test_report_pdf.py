"""The report as a document: written beside the page, whole, with the same verdict."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.end_to_end.small_study import ROOT

BUILT_IN = ROOT / "build" / "report" / "report.pdf"
MOST_PAGES = 1 + 12


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
        "May a reduced model stand in for the wheel?",
        "Contents",
        "Continuum finite elements",
        "1/",
    ):
        assert text in words, text


@pytest.mark.skipif(shutil.which("pdftotext") is None, reason="no pdftotext on PATH")
def test_paper_asks_for_no_pointer(first_report: subprocess.CompletedProcess[str], workspace: Path) -> None:
    """Nothing to drag, hover, click or tap."""
    run = subprocess.run(
        ["pdftotext", "-raw", workspace / "report" / "report.pdf", "-"], capture_output=True, text=True, check=True
    )
    assert not re.findall(r"\b(drag to|hover|click|tap|slider|buttons?)\b", run.stdout, re.IGNORECASE)


@pytest.mark.skipif(shutil.which("pdfinfo") is None, reason="no pdfinfo on PATH")
def test_it_has_at_most_twelve_pages_behind_the_first(
    first_report: subprocess.CompletedProcess[str], workspace: Path
) -> None:
    assert pages(workspace / "report" / "report.pdf") <= MOST_PAGES


@pytest.mark.long
@pytest.mark.skipif(
    shutil.which("pdfinfo") is None or not BUILT_IN.exists(), reason="no pdfinfo, or no make report yet"
)
def test_that_of_the_built_in_study_too() -> None:
    assert pages(BUILT_IN) <= MOST_PAGES


def pages(path: Path) -> int:
    told = subprocess.run(["pdfinfo", path], capture_output=True, text=True, check=True).stdout
    return int(re.findall(r"Pages:\s+(\d+)", told)[0])
