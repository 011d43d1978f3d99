"""The checkpoint file: whole or absent, tied to its problem, numbers back bit for bit."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from reference_fe.solver.checkpoint import Arrays, Checkpoint, below, packed, problem_key, unpacked
from reference_fe.verification.structured_hexahedra import block_mesh


class Notes:
    """A recorder of one number."""

    def __init__(self, value: float) -> None:
        self.value = value

    def recorded(self) -> Arrays:
        return {"value": packed([self.value])}

    def resume(self, arrays: Arrays) -> None:
        (self.value,) = unpacked(arrays["value"])


def test_what_is_written_comes_back(tmp_path: Path) -> None:
    state = {"displacement": np.array([0.1, -1e-300, 3.0]), "surface0/slip": np.arange(4.0).reshape(2, 2)}
    Checkpoint(path=tmp_path / "c.npz", key="k", recorder=Notes(1.0 / 3.0)).write(state)
    notes = Notes(0.0)
    found = Checkpoint(path=tmp_path / "c.npz", key="k", recorder=notes).read()
    assert found is not None
    assert found["displacement"].tobytes() == state["displacement"].tobytes()
    np.testing.assert_array_equal(below("surface0", found)["slip"], state["surface0/slip"])
    assert notes.value == 1.0 / 3.0
    assert [path.name for path in tmp_path.iterdir()] == ["c.npz"]


def test_a_file_of_another_problem_counts_as_absent(tmp_path: Path) -> None:
    Checkpoint(path=tmp_path / "c.npz", key="k").write({"displacement": np.zeros(3)})
    assert Checkpoint(path=tmp_path / "c.npz", key="other").read() is None


@pytest.mark.parametrize("damage", [lambda b: b[: len(b) // 2], lambda b: b"", lambda b: b.replace(b"\x3f", b"\x40")])
def test_a_damaged_file_counts_as_absent(tmp_path: Path, damage: Any) -> None:
    """Cut in half, empty, a byte of a number changed (the archive's checksum tells)."""
    checkpoint = Checkpoint(path=tmp_path / "c.npz", key="k")
    checkpoint.write({"displacement": np.linspace(0.1, 1.0, 50)})
    assert checkpoint.read() is not None
    checkpoint.path.write_bytes(damage(checkpoint.path.read_bytes()))
    assert checkpoint.read() is None


def test_a_discarded_file_is_gone(tmp_path: Path) -> None:
    checkpoint = Checkpoint(path=tmp_path / "c.npz", key="k")
    checkpoint.write({"displacement": np.zeros(3)})
    checkpoint.discard()
    checkpoint.discard()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("value", [[0.1, float("inf"), 1e-308], {"a": [1.0 / 3.0]}, []])
def test_packed_values_come_back(value: object) -> None:
    assert unpacked(packed(value)) == value


def test_the_key_tells_problems_apart() -> None:
    mesh = block_mesh((1, 1, 1), lambda x: x, order=1)
    moved = replace(mesh, points=mesh.points + np.array([1e-12, 0.0, 0.0]))
    renamed = replace(mesh, parts={"other": 1})
    keys = [problem_key(mesh, 1.0), problem_key(mesh, 2.0), problem_key(moved, 1.0), problem_key(renamed, 1.0)]
    assert len(set(keys)) == 4
    assert problem_key(mesh, 1.0) == keys[0]
