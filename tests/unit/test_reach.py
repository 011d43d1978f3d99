"""What decides a result: the modules that its function reaches, found from imports; a changed line changes those keys.

Source: Python's import statements; the package below has each kind of them. That nothing is missed is held against what
workers load, in tests/end_to_end/test_reached.py.
"""

from __future__ import annotations

import ast
import importlib.metadata
import json
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from workbench.execution import reach
from workbench.execution.reach import PACKAGES, reached, reached_libraries
from workbench.questions.rover_mission.graph import mission_tasks
from workbench.questions.study_graph import report_tasks
from workbench.questions.traverse.graph import Asked, traverse_tasks
from workbench.study.reading import built_in_study, read_study

ROOT = Path(__file__).parents[2]
FILES = [path.relative_to(ROOT).with_suffix("") for name in PACKAGES for path in (ROOT / name).rglob("*.py")]
MODULES = sorted(".".join(path.parts[:-1] if path.name == "__init__" else path.parts) for path in FILES)
TREE = {
    "geometry/__init__.py": "from geometry.all import everything\n",
    "geometry/all.py": "everything = 1\n",
    "geometry/task.py": (
        "from typing import TYPE_CHECKING\nimport json\nimport geometry.plain\n"
        "from geometry import (\n    part as p,  # (the) part\n)\n"
        "from geometry.deep.names import value\n"
        "if TYPE_CHECKING:\n    from geometry.types_only import T\nelse:\n    import geometry.otherwise\n"
        "def f():\n    from geometry.lazy import g\n    return open('table.csv'), 'note', 'words.toml'\n"
    ),
    "geometry/plain.py": "import numpy.linalg as la, geometry.task  # import scipy\n",
    "geometry/part.py": "",
    "geometry/lazy.py": "try:\n    from geometry.second import h\nexcept ImportError:\n    pass\n",
    "geometry/second.py": "from PIL import Image\n",
    "geometry/otherwise.py": "",
    "geometry/types_only.py": "",
    "geometry/unrelated.py": "import scipy\nname = 'secret.csv'\n",
    "geometry/deep/__init__.py": "import geometry.unrelated\n",
    "geometry/deep/names.py": "value = 1\n",
    "geometry/whole.py": "from geometry import everything\n",
    "geometry/data/table.csv": "1\n",
    "geometry/secret.csv": "2\n",
    "geometry/note.csv": "3\n",
    "workbench/__init__.py": "",
    "workbench/words.toml": "a = 1\n",
}


@pytest.fixture
def tree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Packages of our names with each kind of import."""
    for name, text in TREE.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    monkeypatch.setattr(reach, "PACKAGES", ("geometry", "workbench"))
    monkeypatch.setattr(reach, "_root", _Roots(tmp_path))
    _clear = (
        reach.reached,
        reach.reached_libraries,
        reach.source_hash,
        reach._named,
        reach._data_files,
        reach._is_module,
    )
    for one in _clear:
        one.cache_clear()
    yield tmp_path
    for one in _clear:
        one.cache_clear()


class _Roots:
    """Packages in a folder of the test's."""

    def __init__(self, root: Path) -> None:
        self.root = root

    def __call__(self, package: str) -> Path:
        if not (self.root / package).is_dir():
            raise ModuleNotFoundError(package)
        return self.root / package


def _parsed(module: str) -> tuple[set[str], set[str]]:
    """Names that a module imports and words in its quotes, by Python's own parser; without ``if TYPE_CHECKING``."""
    imported, words, waiting = set[str](), set[str](), [ast.parse(reach._file(module).read_text(encoding="utf-8"))]
    while waiting:
        node: ast.AST = waiting.pop()
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            words.add(node.value)
        elif isinstance(node, ast.Import):
            imported |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            assert node.level == 0
            imported |= reach._from(node.module, [alias.name for alias in node.names])
        only_types = isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
        waiting += node.orelse if only_types else ast.iter_child_nodes(node)  # type: ignore[attr-defined,arg-type]
    return imported, words


def test_of_every_module_nothing_is_missed_that_the_parser_finds() -> None:
    """More is found only where a program is kept as text, or a file is named in a docstring."""
    more, data = set[str](), set(reach._data_files())
    data |= {name.removesuffix(".csv") for name in data}
    for module in MODULES:
        imported, words = _parsed(module)
        found = reach._named(module)
        assert {name for name in imported if name.partition(".")[0] in PACKAGES} <= found.modules, module
        tops = {name.partition(".")[0] for name in imported}
        assert tops - sys.stdlib_module_names - set(PACKAGES) <= found.libraries, module
        assert words & data <= found.words, module
        if found.modules - imported or found.words & data - words:
            more.add(module)
    assert more <= {"workbench.execution.load_checks", "contracts.published"}
    assert len(MODULES) > 500


@pytest.mark.usefixtures("tree")
def test_imports_of_any_kind_are_followed_and_nothing_else() -> None:
    names = ("deep.names", "lazy", "otherwise", "part", "plain", "second", "task")
    assert set(reached("geometry.task")) == {"geometry/data/table.csv", *(f"geometry.{name}" for name in names)}
    assert reached_libraries("geometry.task") == ("numpy", "pillow")
    assert list(reached("geometry.whole")) == ["geometry", "geometry.all", "geometry.whole"]
    assert list(reached("geometry.unrelated")) == ["geometry.unrelated", "geometry/secret.csv"]
    with pytest.raises(ModuleNotFoundError):
        reached("geometry.nowhere")


def test_a_changed_byte_of_what_is_reached_changes_the_hashes(tree: Path) -> None:
    before = reached("geometry.task")
    for name in TREE:
        path = tree / name
        path.write_text(TREE[name] + " ", encoding="utf-8")
        reach.reached.cache_clear()
        reach.source_hash.cache_clear()
        named = name if not name.endswith(".py") else name.removesuffix(".py").replace("/", ".")
        assert (reached("geometry.task") != before) is (named in before), name
        path.write_text(TREE[name], encoding="utf-8")


SCRIPT = """
import json, sys
from pathlib import Path
from workbench.execution import reach
from workbench.execution.task import task_keys
from workbench.questions.rover_mission.graph import mission_tasks
from workbench.questions.study_graph import report_tasks
from workbench.questions.traverse.graph import Asked, traverse_tasks
from workbench.study.reading import built_in_study, read_study
root = Path(sys.argv[1])
tasks = report_tasks(read_study(built_in_study()))
before, found = task_keys(tasks), {}
for name in json.loads(sys.argv[2]):
    path = root / name
    text = path.read_bytes()
    path.write_bytes(text + b"\\n# changed\\n")
    reach.reached.cache_clear(), reach.source_hash.cache_clear()
    after = task_keys(tasks)
    found[name] = sorted(task for task in before if after[task] != before[task])
    path.write_bytes(text)
print(json.dumps(found))
"""
DECIDES = {
    "workbench/questions/fe/ground.py": {"fe_phi000", "fe_phi060", "fe_x2_phi015"},
    "workbench/study/quantities.py": {"mesh", "mesh_whole", "fe_phi000", "section_phi000"},
    "workbench/study/wheel.py": {"mesh", "mesh_whole", "fe_phi000", "section_phi000"},
    "workbench/study/ancf_tire.py": {"ancf_phi000", "ancf_phi045"},
    "reference_fe/contact/law.py": {"fe_phi000"},
    "rover_dynamics/rover/exomars_rover.toml": {"rover_straight", "rover_ancf_straight"},
    "contracts/published/hertz_line.csv": {"verify_hertz"},
}
"""File -> some of the tasks whose keys it must change; the first four are what lists kept by hand had missed."""
DECIDES_NOTHING = ("workbench/report/page.py", "workbench/charts/interactive.py", "workbench/questions/fe/checks.py")
DECIDES_NOTHING += ("workbench/data/ranges.toml", "workbench/study/reading.py")
DECIDES_NOTHING += ("workbench/questions/mesh_study/grid_convergence.py",)


def _closure(module: str, parsed: dict[str, set[str]]) -> set[str]:
    found, waiting = {module}, [module]
    while waiting:
        name = waiting.pop()
        if name not in parsed:
            parsed[name] = {one for one in _parsed(name)[0] if one.partition(".")[0] in PACKAGES}
        waiting += parsed[name] - found
        found |= parsed[name]
    return found


def test_a_changed_line_of_any_module_changes_exactly_the_keys_of_what_can_reach_it(tmp_path: Path) -> None:
    """Which tasks can reach it is found anew, by Python's parser; a task that needs a changed one changes too.

    What keys are made of is held against that for every module; every ninth is changed, to see its keys change.
    """
    modules = {reach._file(name).relative_to(ROOT).as_posix(): name for name in MODULES}
    inside, covered, parsed = dict[str, set[str]](), dict[str, set[str]](), dict[str, set[str]]()
    for task in report_tasks(read_study(built_in_study())):
        module = task.function.partition(":")[0]
        inside[task.name] = _closure(module, parsed).union(*(inside[n] for n in task.needs))
        covered[task.name] = {n for n in reached(module) if "/" not in n}.union(*(covered[n] for n in task.needs))
    assert covered == inside
    found = _changed_keys(tmp_path, sorted({*list(modules)[::9], *DECIDES, *DECIDES_NOTHING}))
    for name in found.keys() & modules.keys():
        assert found[name] == {task for task, reachable in inside.items() if modules[name] in reachable}, name
    for name, some in DECIDES.items():
        assert some <= found[name], (name, some - found[name])
    assert [name for name in DECIDES_NOTHING if found[name]] == []


def _changed_keys(folder: Path, files: list[str]) -> dict[str, set[str]]:
    """File -> tasks of the built-in study whose keys change with a line of it, in a copy of the packages."""
    for package in PACKAGES:
        shutil.copytree(ROOT / package, folder / package, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(ROOT / "studies", folder / "studies")
    command = [sys.executable, "-c", SCRIPT, str(folder), json.dumps(files)]
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    return {name: set(tasks) for name, tasks in json.loads(run.stdout).items()}


def test_every_library_has_its_distribution() -> None:
    """A version that reads "missing" would never change."""
    tasks = report_tasks(read_study(built_in_study()))
    names = {name for task in tasks for name in reached_libraries(task.function.partition(":")[0])}
    installed = {str(one.name).lower().replace("_", "-") for one in importlib.metadata.distributions()}
    assert names <= installed
    assert {"numpy", "numba", "gmsh", "dolfinx-solver-real", "fenics-ffcx", "vtk"} <= names


def test_no_task_reaches_what_plans_or_judges() -> None:
    """Else hours of kept results would be called stale for a word in a check's claim."""
    study = read_study(built_in_study())
    stretches = traverse_tasks(study, ("brush", "fe"), Asked(distance=20.0))
    functions = {task.function for task in (*report_tasks(study), *mission_tasks(study), *stretches)}
    plans = re.compile(r"workbench\.(study\.model|verdict|report|commands|questions\.(question$|.*graph))")
    found = {one: [name for name in reached(one.partition(":")[0]) if plans.match(name)] for one in functions}
    assert {one: names for one, names in found.items() if names} == {}


def test_debians_and_condas_libraries_stand_for_those_of_the_wheel(monkeypatch: pytest.MonkeyPatch) -> None:
    def distribution(name: str) -> None:
        if name == "dolfinx-solver-real":
            raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(importlib.metadata, "distribution", distribution)
    for function in (reached_libraries, reach._installed):
        function.cache_clear()
    names = set(reached_libraries("workbench.questions.fe.task"))
    for function in (reached_libraries, reach._installed):
        function.cache_clear()
    assert {"fenics-dolfinx", "petsc4py", "fenics-ffcx"} <= names
    assert "dolfinx-solver-real" not in names


def test_every_published_table_is_an_input_of_what_is_held_against_it() -> None:
    """A name put together at run time would hide: a changed reference would leave old verdicts standing."""
    tasks = report_tasks(read_study(built_in_study()))
    inputs = {name for task in tasks for name in reached(task.function.partition(":")[0])}
    tests = "".join(path.read_text("utf-8") for path in (ROOT / "tests").rglob("test_*.py"))
    tables = sorted((ROOT / "contracts" / "published").glob("*.csv"))
    assert len(tables) > 10
    hidden = [t.stem for t in tables if f"contracts/published/{t.name}" not in inputs and f'"{t.stem}"' not in tests]
    assert hidden == []
    matrices = reached("ancf_reduced.verification.plate_matrices")
    for name in ("mass", "gravity", "elastic_force"):
        assert f"contracts/published/ancf_plate_{name}.csv" in matrices


def test_packages_that_hold_no_code_are_words_alone() -> None:
    """An ``__init__`` runs whenever a module below it is imported, and no key covers it unless it is named."""
    for package in PACKAGES:
        for path in (ROOT / package).rglob("__init__.py"):
            if path.parent.name in ("workbench", "published"):  # the one is the Python interface, the other is named
                continue
            (words,) = ast.parse(path.read_text("utf-8")).body
            assert isinstance(words, ast.Expr), path
            assert isinstance(words.value, ast.Constant), path


def test_nothing_reached_imports_by_a_name_made_at_run_time() -> None:
    """No import of ours hides from the text."""
    tasks = report_tasks(read_study(built_in_study()))
    modules = {name for task in tasks for name in reached(task.function.partition(":")[0]) if "/" not in name}
    for module in modules:
        calls = [n for n in ast.walk(ast.parse(reach._file(module).read_text("utf-8"))) if isinstance(n, ast.Call)]
        hidden = [
            ast.unparse(n) for n in calls if ast.unparse(n.func).rpartition(".")[2] in ("import_module", "__import__")
        ]
        assert hidden == [], module
