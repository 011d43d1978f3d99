"""Modes in the workbench: kinds of known shapes, pairs of shapes, the kept file, tasks and choices."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.modes import Modes
from workbench.commands.modes import ModeChoices, doubts_of
from workbench.questions.modes.compare_task import assurance, paired
from workbench.questions.modes.graph import AskedModes, modes_tasks
from workbench.questions.modes.kinds import mode_kinds
from workbench.questions.modes.mode_file import KeptModes, read_modes, write_modes
from workbench.study.reading import built_in_study, read_study

ANGLE = 2.0 * np.pi * np.arange(48) / 48
OUT = np.stack([np.sin(ANGLE), 0.0 * ANGLE, -np.cos(ANGLE)], axis=1)
AROUND = np.stack([np.cos(ANGLE), 0.0 * ANGLE, np.sin(ANGLE)], axis=1)
AXLE = np.tile([0.0, 1.0, 0.0], (48, 1))


def ring(*shapes: np.ndarray, eigenvalue: float = 100.0) -> KeptModes:
    """Two circles of 48 points of a rim and one of springs; the shapes are those of a circle of the rim, or of all."""
    count = len(shapes)
    points = np.concatenate([0.14 * OUT + [0.0, y, 0.0] for y in (-0.06, 0.06)] + [0.1 * OUT])
    every = np.array([s if len(s) == 144 else np.concatenate([s, s, 0.1 * s]) for s in shapes])
    modes = Modes(
        eigenvalue=np.full(count, eigenvalue),
        shape=every,
        points=points,
        weight=np.ones(144),
        participation=np.zeros((count, 6)),
        moving=np.ones(6),
        whole=np.ones(6),
        rigid=np.zeros(count, dtype=bool),
        parity=np.zeros(count, dtype=np.int64),
    )
    return KeptModes(modes=modes, parts=("tire", "springs"), part=np.repeat([0, 1], [96, 48]), half=False)


def test_kinds() -> None:
    oval = np.cos(2.0 * ANGLE)[:, None] * OUT - 0.5 * np.sin(2.0 * ANGLE)[:, None] * AROUND
    ahead = np.tile([1.0, 0.0, 0.0], (48, 1))
    in_springs = np.concatenate([0.0 * OUT, 0.0 * OUT, np.cos(5.0 * ANGLE)[:, None] * OUT])
    shapes = (AROUND, ahead, oval, AXLE, np.cos(ANGLE)[:, None] * AXLE, np.cos(3.0 * ANGLE)[:, None] * AXLE, in_springs)
    words = [kind.words for kind in mode_kinds(ring(*shapes))]
    assert words == ["torsional", "shift", "radial n=2", "lateral", "tilting", "warping n=3", "springs n=5"]
    kinds = mode_kinds(ring(*shapes))
    assert kinds[-1].part == "springs"
    assert kinds[0].part == "tire"


def test_pairs_of_turned_shapes() -> None:
    """Two modes of one frequency, turned by half a right angle by the other model, are the same pair."""
    one = np.random.default_rng(0).normal(size=(4, 30))
    c = np.sqrt(0.5)
    other = np.stack([one[3], c * one[1] + c * one[2], c * one[1] - c * one[2], one[0]])
    alone, together = (assurance(one, other, g) for g in ([[0], [1], [2], [3]], [[0], [1, 2], [3]]))
    assert alone[1, 1] < 0.9 < together[1, 1]
    pairs = paired(together, np.arange(4), np.arange(4))
    assert {pairs[0], pairs[3]} == {(0, 3), (3, 0)}
    assert min(together[i, j] for i, j in pairs) > 1.0 - 1e-12
    assert assurance(one, np.random.default_rng(1).normal(size=(4, 30)), [[0], [1, 2], [3]]).max() < 0.5


def test_modes_come_back_from_their_file(tmp_path: Path) -> None:
    kept = ring(OUT, AXLE)
    write_modes(kept, tmp_path / "modes.npz")
    again = read_modes(tmp_path / "modes.npz")
    assert (again.parts, again.half) == (kept.parts, kept.half)
    np.testing.assert_allclose(again.modes.shape, kept.modes.shape, atol=1e-7)
    np.savez(tmp_path / "other.npz", shape=np.zeros(3))
    with pytest.raises(InputError, match="compute them again"):
        read_modes(tmp_path / "other.npz")


def test_an_unstable_state_is_told() -> None:
    assert doubts_of("fe", ring(OUT)) == []
    (told,) = doubts_of("fe", ring(OUT, AXLE, eigenvalue=-400.0))
    assert "does not stand" in told
    assert "2 modes grow" in told
    assert "50 ms" in told


def test_tasks() -> None:
    study = read_study(built_in_study())
    stands = ModeChoices(model="both", state="standing", load=150.0, orientation=15.0).asked(study)
    tasks = {task.name: task for task in modes_tasks(study, ("fe", "ancf_wheel"), stands)}
    assert list(tasks) == ["mesh", "modes_fe_standing", "modes_ancf_wheel_standing", "modes_compared"]
    assert tasks["modes_fe_standing"].inputs["modes"] == {
        "state": "standing",
        "load": 150.0,
        "count": 10,
        "grip": False,
    }
    assert tasks["modes_fe_standing"].memory > 1e8
    assert tasks["modes_ancf_wheel_standing"].inputs["options"]["half_width"] is False
    free = [task.name for task in modes_tasks(study, ("ancf_wheel",), replace(stands, state="free"))]
    assert free == ["mesh_whole", "modes_ancf_wheel_free"]


def test_files_of_a_wheel_that_stands_are_told_apart() -> None:
    study = read_study(built_in_study())
    first = ModeChoices(state="standing", load=100.0, orientation=15.0).asked(study)
    others = [replace(first, load=150.0), replace(first, orientation_deg=0.0), replace(first, grip=True)]
    names = [one.name for one in (first, *others)]
    assert names == [
        "standing_phi015_100N",
        "standing_phi015_150N",
        "standing_phi000_100N",
        "standing_phi015_100N_grip",
    ]
    assert [ModeChoices(state=state).asked(study).name for state in ("held", "free")] == ["held", "free"]


@pytest.mark.parametrize(
    ("choices", "text"),
    [
        ({"state": "flying"}, "give free, held, standing"),
        ({"load": 100.0}, "is of no use to --state held"),
        ({"orientation": 10.0, "state": "free"}, "is of no use to --state free"),
        ({"state": "standing", "load": -1.0}, "must lie between"),
        ({"state": "standing", "orientation": 400.0}, "orientation"),
        ({"count": 0}, "count"),
        ({"grip": True}, "is of no use to --state held"),
    ],
)
def test_choices_that_cannot_be_used_are_refused(choices: dict[str, float], text: str) -> None:
    with pytest.raises(InputError, match=text):
        ModeChoices(**choices).asked(read_study(built_in_study()))


def test_other_models_have_no_modes() -> None:
    asked = AskedModes(state="held", load=0.0, orientation_deg=0.0, count=4)
    with pytest.raises(InputError, match="give fe, ancf_wheel or both"):
        modes_tasks(read_study(built_in_study()), ("brush",), asked)
