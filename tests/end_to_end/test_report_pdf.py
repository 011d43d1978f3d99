"""The report as a document: written beside the page, whole, with the same verdict."""

from __future__ import annotations

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
    for text in ("gates passed", "Who agrees with the continuum?", "Contents", "Continuum finite elements", "1 / "):
        assert text in words, text
