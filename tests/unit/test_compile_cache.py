"""Compiled functions are those of the present sources, whatever file changed."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

import contracts.compile_cache as contracts_cache
from contracts.compile_cache import compile_cache, kept_by_sources

ROOT = Path(__file__).parents[2]
COMPILED = ROOT / "rover_dynamics" / "multibody" / "compiled.py"
"""The decorator under test, copied into a package of its own."""
INNER = "from multi.inner.compiled import compiled\n\n\n@compiled\ndef inner(x):\n    return {} * x\n"
OUTER = (
    "from multi.inner.compiled import compiled\nfrom multi.number import inner\n\n\n"
    "@compiled\ndef outer(x):\n    return inner(x) + 1.0\n"
)


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A package ``multi`` whose function takes in one from another file."""
    folder = tmp_path / "multi"
    (folder / "inner").mkdir(parents=True)
    (folder / "inner" / "compiled.py").write_text(COMPILED.read_text(encoding="utf-8"), encoding="utf-8")
    (folder / "number.py").write_text(INNER.format(2.0), encoding="utf-8")
    (folder / "use.py").write_text(OUTER, encoding="utf-8")
    return folder


def outer_of_three(package: Path, users: str = "") -> float:
    """What a fresh process computes, with the folder for compiled functions that the user chose."""
    paths = os.pathsep.join([str(package.parent), str(ROOT)])
    environment = {**os.environ, "PYTHONPATH": paths, "NUMBA_CACHE_DIR": users}
    command = [sys.executable, "-c", "from multi.use import outer; print(outer(3.0))"]
    found = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return float(found.stdout)


def test_a_change_in_another_file_is_seen(package: Path) -> None:
    """Without the folder for each state of the sources the second process answers 7 again."""
    assert outer_of_three(package) == 7.0
    first = list((package / "__pycache__").glob("compiled-*"))
    assert len(first) == 1
    assert list(first[0].rglob("*.nbi"))
    (package / "number.py").write_text(
        INNER.format(12.25), encoding="utf-8"
    )  # longer: Python's own cache goes by size and second
    assert outer_of_three(package) == 37.75
    assert first[0] not in list((package / "__pycache__").glob("compiled-*"))


def test_a_change_is_seen_in_the_users_folder(package: Path, tmp_path: Path) -> None:
    users = tmp_path / "users"
    assert outer_of_three(package, str(users)) == 7.0
    assert list(users.glob("multi-compiled-*/**/*.nbi"))
    (package / "number.py").write_text(INNER.format(12.25), encoding="utf-8")
    assert outer_of_three(package, str(users)) == 37.75


def test_the_folder_depends_on_every_source_whose_constants_may_be_taken_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package, contracts = tmp_path / "package", tmp_path / "contracts"
    for source in (package / "deep" / "kernel.py", package / "plain.py", contracts / "terrain.py"):
        source.parent.mkdir(parents=True, exist_ok=True)
        source.write_text("a = 1", encoding="utf-8")
    monkeypatch.setattr(contracts_cache, "__file__", str(contracts / "compile_cache.py"))
    states = []
    for source in (package / "deep" / "kernel.py", package / "plain.py", contracts / "terrain.py"):
        compile_cache.cache_clear()
        states.append(compile_cache(package))
        source.write_text("a = 2", encoding="utf-8")
    compile_cache.cache_clear()
    states.append(compile_cache(package))
    compile_cache.cache_clear()
    assert len(set(states)) == 4


@pytest.mark.parametrize("users", ["", "elsewhere"])
def test_the_users_folder_goes_first_and_stays_set(users: str, tmp_path: Path) -> None:
    config, seen = SimpleNamespace(CACHE_DIR=users), list[str]()

    def fail() -> None:
        with kept_by_sources(config, tmp_path):
            seen.append(config.CACHE_DIR)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    own = compile_cache(tmp_path)
    assert seen == [str(Path(users) / f"{tmp_path.name}-{own.name}" if users else own)]
    assert users == config.CACHE_DIR
