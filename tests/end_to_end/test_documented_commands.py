"""Every command of README and docs runs as printed, or says why it is not run.

Claim: a reader who copies the commands of a page, in order, from a fresh clone gets the exit status and the lines that
the page shows. The pages share one result store. Negative controls: a wrong line, a wrong status, and a page with
an unmarked command are each found.
"""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

import pytest

from tests.documentation import Command, blocks_of, explain, run_command, unlike

ROOT = Path(__file__).parents[2]
PAGES = ["README.md", *sorted(str(path.relative_to(ROOT)) for path in (ROOT / "docs").rglob("*.md"))]
LONG = tuple(
    f"docs/{page}.md" for page in ("how_to/materials", "how_to/other_wheels", "how_to/own_mesh", "tutorials/own_wheel")
)
"""Pages that take half a minute or more."""
RUN = [page for page in PAGES if any(not b.reason for b in blocks_of((ROOT / page).read_text(encoding="utf-8")))]

SCRIPT = f"""#!{sys.executable}
from workbench.cli import main

if __name__ == "__main__":
    main()
"""
"""The command as an installer writes it."""


@pytest.fixture(scope="session")
def environment(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """A user's: ``workbench`` on the path, one store, a terminal of 100 columns."""
    folder = tmp_path_factory.mktemp("reader")
    command = folder / "bin" / "workbench"
    command.parent.mkdir()
    command.write_text(SCRIPT, encoding="utf-8")
    command.chmod(0o755)
    kept = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WORKBENCH_TRACEBACK")}
    return kept | {
        "PATH": f"{command.parent}{os.pathsep}{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": str(ROOT),
        "WORKBENCH_STORE": str(folder / "store"),
        "COLUMNS": "100",
        "NO_COLOR": "1",
    }


@pytest.mark.parametrize("page", [pytest.param(p, marks=pytest.mark.long if p in LONG else ()) for p in RUN])
def test_page(page: str, tmp_path: Path, environment: dict[str, str]) -> None:
    shutil.copytree(ROOT / "studies", tmp_path / "studies")
    for block in blocks_of((ROOT / page).read_text(encoding="utf-8")):
        if block.file:
            (tmp_path / block.file).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / block.file).write_text(block.text, encoding="utf-8")
        for command in () if block.reason else block.commands:
            run = run_command(command, tmp_path, environment)
            assert run.returncode == command.status, explain(command, run)
            missing = unlike(command, run.stdout)
            assert not missing, f"not printed: {missing}\n{explain(command, run)}"


def test_a_block_that_is_not_run_has_its_reason() -> None:
    reasons = {b.reason for page in PAGES for b in blocks_of((ROOT / page).read_text(encoding="utf-8"))} - {""}
    assert all(len(reason.split()) >= 4 for reason in reasons), reasons


def test_negative_control_a_wrong_line_and_a_wrong_status_are_found(tmp_path: Path) -> None:
    (block,) = blocks_of("```console\n$ echo load 12.5 N\n...\nload 99 N\nstress 3 MPa\n$ false\n```\n")
    echo, wrong = block.commands
    run = run_command(echo, tmp_path, os.environ)
    assert unlike(echo, run.stdout) == "stress 3 MPa"
    assert unlike(Command(line=echo.line, output=("load 99 N",)), run.stdout) == ""
    assert run_command(wrong, tmp_path, os.environ).returncode != wrong.status


def test_negative_control_a_mark_belongs_to_the_next_block_alone() -> None:
    page = "<!-- not run: takes an hour or two -->\n```bash\nmake report\n```\n\n```bash\nmake test\n```\n"
    assert [bool(block.reason) for block in blocks_of(page)] == [True, False]
