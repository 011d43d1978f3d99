"""The manual as ``make docs`` builds it: strict, whole, and without anything from elsewhere.

Claim: mkdocs ends without a warning (a broken link, a page outside the menu and an unknown reference are warnings); no
page loads a script, style, picture or font from another host; every formula is MathML; each package has its page,
without private names. Negative controls: a broken link ends the build; a page that fetches a font is found.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ELSEWHERE = r"""=["']?(?:https?:)?//"""
FETCHED = re.compile(
    rf"<(?:script|img|iframe)[^>]*\ssrc{ELSEWHERE}"
    rf"|<link[^>]*rel=[\"']?(?:stylesheet|preload|preconnect)[^>]*\shref{ELSEWHERE}"
    rf"|url\([\"']?(?:https?:)?//"
)


def build(folder: Path, out: Path) -> subprocess.CompletedProcess[str]:
    """``mkdocs build`` of the manual in a folder."""
    return subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--site-dir", out],
        cwd=folder, capture_output=True, text=True, check=False,
    )  # fmt: skip


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("site")
    run = build(ROOT, out)
    assert run.returncode == 0, run.stdout + run.stderr
    return out


def pages(site: Path) -> dict[str, str]:
    return {str(path.relative_to(site)): path.read_text(encoding="utf-8") for path in site.rglob("*.html")}


def test_nothing_comes_from_elsewhere(site: Path) -> None:
    assert [name for name, text in pages(site).items() if FETCHED.search(text)] == []
    for path in site.rglob("*.css"):
        assert not FETCHED.search(path.read_text(encoding="utf-8")), path
    assert FETCHED.search('<link rel="stylesheet" href="https://fonts.example/a.css">')
    assert not FETCHED.search('<a href="https://example.org">elsewhere</a><link rel="stylesheet" href="../a.css">')


def test_formulas_are_mathml_and_thesis_numbers_stand_beside_them(site: Path) -> None:
    shown = pages(site)
    assert [name for name, text in shown.items() if 'class="arithmatex"' in text] == []
    assert shown["theory/ancf_plate.html"].count('<math display="block">') >= 8
    assert '<span class="equation-number">(2.23)</span>' in shown["theory/ancf_plate.html"]


def test_each_package_has_its_page_without_private_names(site: Path) -> None:
    reference = {p.stem: p.read_text(encoding="utf-8") for p in (site / "reference" / "api").glob("*.html")}
    assert set(reference) >= {"contracts", "geometry", "reference_fe", "ancf_reduced", "workbench.study"}
    assert 'id="contracts.curves.StiffnessCurve.load_at"' in reference["contracts"]
    assert 'id="reference_fe.problem.static_problem.StaticProblem"' in reference["reference_fe.problem"]
    assert not re.search(r'id="[\w.]+\._\w', "".join(reference.values()))


def test_negative_control_a_broken_link_ends_the_build(tmp_path: Path) -> None:
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "index.md").write_text("# A\n\n[there](nowhere.md)\n", encoding="utf-8")
    text = (ROOT / "mkdocs.yml").read_text(encoding="utf-8")
    kept = re.search(r"^validation:.*?(?=^\S)", text, flags=re.M | re.S)
    assert kept is not None
    (tmp_path / "mkdocs.yml").write_text(f"site_name: A\nstrict: true\n{kept.group(0)}", encoding="utf-8")
    run = build(tmp_path, tmp_path / "site")
    assert run.returncode == 1
    assert "nowhere.md" in run.stdout + run.stderr
    shutil.rmtree(tmp_path / "site", ignore_errors=True)
