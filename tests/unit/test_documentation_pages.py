"""The manual's promises about itself: sections, thesis equations, modules and pages that are named exist.

Negative controls: a section, an equation and a module that are nowhere are missed.
"""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

from rich.emoji import Emoji
from typer.main import get_command

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PACKAGES = ("contracts", "geometry", "soil", "reference_fe", "ancf_reduced", "rover_dynamics", "workbench")
SOURCES = (*PACKAGES, "studies", "benchmarks", "tests")
NUMBERED = re.compile(r"\b(\d{1,2}(?:\.\d)?)\b")


def sections() -> dict[str, Path]:
    """Section of the manual -> its chapter, from the list in docs/theory.md."""
    rows = re.findall(
        r"^\| ([\d., ]+) \| \[[^\]]+\]\(([^)]+)\)", (DOCS / "theory.md").read_text(encoding="utf-8"), re.M
    )
    return {number: DOCS / page for numbers, page in rows for number in numbers.split(", ")}


def cited_sections() -> Iterator[tuple[str, str]]:
    """Each section that sources, studies and tests name after ``docs/theory.md``, with the file."""
    for folder in SOURCES:
        for path in (ROOT / folder).rglob("*.*"):
            if path.suffix in (".py", ".toml", ".j2", ".md"):
                text = re.sub(r"\s+#? ?", " ", path.read_text(encoding="utf-8"))
                for found in re.findall(r"docs/theory\.md`?,?(?: sections?)? ([\d.]+\d|\d)", text):
                    yield found, str(path.relative_to(ROOT))


def test_every_section_named_in_the_sources_has_its_chapter() -> None:
    known = sections()
    cited = list(cited_sections())
    assert len(cited) > 10
    assert [(number, path) for number, path in cited if number not in known] == []
    assert "2.19" not in known


def test_every_chapter_is_listed_and_holds_its_sections() -> None:
    known = sections()
    assert set(known.values()) == set((DOCS / "theory").glob("*.md")) - {DOCS / "theory" / "equations.md"} | {
        known["7"]
    }
    for number, page in known.items():
        headings = re.findall(r"^##? (\d[\d.]*?)\.? ", page.read_text(encoding="utf-8"), re.M)
        assert number in headings or number.split(".")[0] in headings, f"{page.name} has no section {number}"


def test_every_thesis_equation_is_found_with_its_module() -> None:
    text = (DOCS / "theory" / "equations.md").read_text(encoding="utf-8")
    rows = [row.split(" | ") for row in re.findall(r"^\| (.+) \|$", text, re.M)]
    equations = {number for row in rows for number in re.findall(r"\b2\.\d+\b(?!\.)", row[0])}
    assert equations >= {f"2.{i}" for i in range(1, 27)}
    for row in rows[2:]:
        folder = ""
        for module in re.findall(r"`([^`]+)`", row[-1]):
            folder = str(Path(module).parent) if "/" in module else folder
            assert (ROOT / folder / Path(module).name).exists(), f"{module} is nowhere"


def test_modules_and_tests_named_in_the_manual_exist() -> None:
    missing = []
    for page in sorted(DOCS.rglob("*.md")):
        for name in re.findall(rf"`((?:{'|'.join(SOURCES)})/[\w/*.]+)`", page.read_text(encoding="utf-8")):
            if not any(ROOT.glob(name)):
                missing.append((page.name, name))
    assert missing == []


def test_files_and_functions_named_in_the_manual_exist() -> None:
    """Names of files alone, ``lines.py``, and dotted names of our packages, ``geometry.build.build_wheel``."""
    files = {path.name for name in (*SOURCES, "docs") for path in (ROOT / name).rglob("*.py")}
    dotted = re.compile(rf"`((?:{'|'.join(SOURCES)})(?:\.\w+)+)[(`]")
    checks, missing = (ROOT / "tests" / "data" / "shipped_checks.csv").read_text(encoding="utf-8"), []
    for page in (*sorted(DOCS.rglob("*.md")), ROOT / "README.md", ROOT / "CONTRIBUTING.md"):
        text = page.read_text(encoding="utf-8")
        missing += [(page.name, name) for name in re.findall(r"`(\w+\.py)`", text) if name not in files]
        missing += [(page.name, name) for name in dotted.findall(text) if not (_is_known(name) or f"{name}," in checks)]
    assert missing == []
    assert not _is_known("geometry.read_surfaces_step")
    assert not _is_known("geometry.nowhere.name")


def _is_known(dotted: str) -> bool:
    """Whether a module of that name stands in the sources, or one that speaks of what follows."""
    parts = dotted.split(".")
    for n in range(len(parts), 0, -1):
        path = ROOT.joinpath(*parts[:n])
        source = next((p for p in (path.with_suffix(".py"), path / "__init__.py") if p.is_file()), None)
        if source is not None:
            text = source.read_text(encoding="utf-8")
            return all(re.search(rf"\b{name}\b", text) for name in parts[n:])
    return False


def test_every_command_of_the_command_line_has_its_row() -> None:
    import workbench.cli

    listed = "".join(
        path.read_text(encoding="utf-8") for path in (ROOT / "README.md", DOCS / "reference" / "commands.md")
    )
    names = {command.name or command.callback.__name__ for command in workbench.cli.app.registered_commands}
    names |= {group.name for group in workbench.cli.app.registered_groups}
    assert len(names) > 5
    assert [name for name in sorted(names) if f"`workbench {name}" not in listed] == []
    make = set(re.findall(r"^([a-z]+):.*## ", (ROOT / "Makefile").read_text(encoding="utf-8"), re.M))
    assert {"report", "test", "docs", "bench"} <= make
    assert set(re.findall(r"`make (\w+)", listed)) <= make


def test_a_guide_outside_the_menu_comes_last_among_the_guides() -> None:
    spec = importlib.util.spec_from_file_location("site_hooks", DOCS / "hooks" / "site.py")
    assert spec is not None
    assert spec.loader is not None
    hooks = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(hooks)
    menu = [{"Home": "index.md"}, {"How to": [{"Calibrate": "how_to/calibrate.md"}]}, {"Reference": []}]
    completed = hooks.on_config(SimpleNamespace(nav=menu, docs_dir=str(DOCS))).nav
    first, *others = completed[1]["How to"]
    assert first == {"Calibrate": "how_to/calibrate.md"}
    assert "curves.md" in others
    assert not {"index.md", "how_to/calibrate.md", "theory/contact.md"} & set(others)
    assert {"workbench.study": "reference/api/workbench.study.md"} in completed[2]["Reference"][0]["API"]


def test_no_words_of_the_help_are_taken_for_markup() -> None:
    """Rich would swallow ``[sweep]`` in a help text: brackets stand behind a backslash there. ``:B:`` is a picture."""
    import workbench.cli

    commands, texts = [get_command(workbench.cli.app)], list[str]()
    while commands:
        command = commands.pop()
        commands += getattr(command, "commands", {}).values()
        texts += [command.help or "", *(getattr(option, "help", None) or "" for option in command.params)]
    assert sum(map(bool, texts)) > 50
    assert [text for text in texts if "[" in text.replace("\\[", "")] == []
    assert [text for text in texts if Emoji.replace(text) != text] == []


def test_help_answers_in_a_moment() -> None:
    """Not timed, which another process could spoil: ``--help`` loads one library besides the standard one, typer's."""
    code = "import sys; from workbench.cli import _run; s = _run(['--help']); print(s, *sys.modules, file=sys.stderr)"
    run = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    status, *modules = run.stderr.split()
    assert status == "0"
    assert "report" in run.stdout
    heavy = {*("numpy", "scipy", "pydantic", "pint", "jinja2", "plotly", "numba"), *("gmsh", "pyvista", "pyarrow")}
    assert heavy & {name.split(".")[0] for name in modules} == set()
    own = {name for name in modules if name.startswith("workbench.")}
    rooms = ("workbench.execution", "workbench.execution.interrupts", "workbench.execution.standard_streams")
    light = {"workbench.cli", *rooms}
    assert {name for name in own if not name.startswith("workbench.commands")} == light
