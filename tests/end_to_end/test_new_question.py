"""A new question of the report is one folder and its name in the registry.

Claim: the question that docs/extending.md writes, in some sixty lines, put into a copy of the package as the page says,
is computed, shown, checked and listed by ``workbench report``; nothing else of the report is computed anew. Source: the
page itself. Negative control: without its name in the registry the report knows nothing of it.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.end_to_end.small_study import ROOT, command, environment

PAGE = ROOT / "docs" / "extending.md"
FILE = re.compile(r'^```\w+ title="(workbench/[^"]+)"\n(.*?)^```$', re.MULTILINE | re.DOTALL)
REGISTRY = "workbench/questions/registry.py"


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a copy of ``workbench`` and the page's files in it."""
    folder = tmp_path_factory.mktemp("package")
    shutil.copytree(ROOT / "workbench", folder / "workbench", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(ROOT / "studies", folder / "studies")  # as in the installed package
    for name, text in FILE.findall(PAGE.read_text(encoding="utf-8")):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    return folder


def _report(package: Path, workspace: Path, store: Path, out: str) -> subprocess.CompletedProcess[str]:
    settings = environment() | {"PYTHONPATH": f"{package}:{ROOT}"}
    arguments = command("report", "study.toml", "--out", out, "--store", str(store))
    return subprocess.run(arguments, cwd=workspace, env=settings, capture_output=True, text=True, check=False)


def _named(package: Path) -> None:
    path = package / REGISTRY
    text = path.read_text(encoding="utf-8")
    imported = "from workbench.questions.work.question import WORK\n"
    text = text.replace("from workbench.study.model", f"{imported}from workbench.study.model", 1)
    path.write_text(text.replace("    STRENGTH,\n", "    STRENGTH,\n    WORK,\n"), encoding="utf-8")


def test_the_example_is_short() -> None:
    written = FILE.findall(PAGE.read_text(encoding="utf-8"))
    assert {Path(name).name for name, _ in written} >= {"task.py", "question.py", "statements.toml", "section.html.j2"}
    assert sum(bool(line.strip()) for _, text in written for line in text.splitlines()) <= 65


def test_the_question_of_the_page_is_asked_and_answered(
    package: Path, workspace: Path, first_report: subprocess.CompletedProcess[str], tmp_path: Path
) -> None:
    assert first_report.returncode == 0, first_report.stderr
    _named(package)
    store = tmp_path / "store"  # a copy: other tests share the first report's store, and know no such task
    shutil.copytree(workspace / "store", store)
    run = _report(package, workspace, store, "asked")
    assert run.returncode == 0, run.stderr
    assert re.search(r"\b1 tasks? computed", run.stdout), run.stdout
    summary = json.loads((workspace / "asked" / "summary.json").read_text(encoding="utf-8"))
    (check,) = [c for c in summary["checks"] if c["id"] == "work.smallest"]
    assert (check["status"], check["unit"], list(check["tasks"]), check["section"]) == ("pass", "J", ["work"], "work")
    page = (workspace / "asked" / "report.html").read_text(encoding="utf-8")
    assert re.search(r'<section id="work"><h2>Work</h2>\s*<p>0°: 0\.\d{3} J</p>', page)
    assert 'href="#work"' in page


def test_without_its_name_nobody_asks_it(workspace: Path, first_report: subprocess.CompletedProcess[str]) -> None:
    """Negative control."""
    summary = json.loads((workspace / "report" / "summary.json").read_text(encoding="utf-8"))
    assert first_report.returncode == 0
    assert not [c for c in summary["checks"] if c["id"].startswith("work.")]
