"""Task and choices of ``workbench roll``: what is refused, whose friction and sizes hold, a motion that stops."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from ancf_reduced.wheel_motion.travel import TravelSettings
from contracts.errors import InputError
from contracts.series import read_series
from workbench.commands.roll import RollChoices
from workbench.execution.result_files import FAILURE
from workbench.questions.ancf_wheel import motion_task as task_module
from workbench.questions.ancf_wheel.motion_graph import motion_task
from workbench.study.reading import built_in_study, read_study
from workbench.study.sections import GroundSection

STUDY = read_study(built_in_study())


def test_friction_and_sizes_are_the_studys_and_the_load_is_the_rovers() -> None:
    asked = RollChoices().asked()
    assert asked.load == pytest.approx(320.0 * 3.711 / 6.0)
    assert asked.speed == pytest.approx(70.0 / 3600.0)
    task = motion_task(STUDY, asked)
    assert STUDY.ancf_wheel is not None
    assert task.inputs["options"]["element_size"] == STUDY.ancf_wheel.element_size
    assert task.inputs["friction"] == 0.6
    icy = STUDY.model_copy(update={"ground": GroundSection(friction=0.2)})
    assert motion_task(icy, asked).inputs["friction"] == 0.2


@pytest.mark.parametrize(
    ("choices", "match"),
    [
        ({"case": "jump"}, "case"),
        ({"case": "drop", "speed": 70.0}, "speed"),
        ({"case": "rolling", "height": "5 mm"}, "height"),
        ({"case": "drop", "radius": "5 mm"}, "radius"),
        ({"case": "drop", "height": "5 s"}, "height"),
        ({"seconds": 0.0}, "seconds"),
        ({"seconds": float("nan")}, "seconds"),
        ({"speed": 1e5}, "speed"),
        ({"load": -1.0}, "load"),
    ],
)
def test_what_is_no_motion_is_refused(choices: dict[str, object], match: str) -> None:
    with pytest.raises(InputError, match=match):
        RollChoices(**choices).asked()  # type: ignore[arg-type]


def test_a_study_with_what_the_model_has_not_is_refused() -> None:
    neo = STUDY.model_copy(update={"fe": STUDY.fe.model_copy(update={"material_law": "neo_hookean"})})
    with pytest.raises(InputError, match=r"fe\.material_law"):
        motion_task(neo, RollChoices().asked())


def test_a_motion_that_stops_keeps_what_it_has(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its smallest step is longer than landing allows."""
    inputs = dict(motion_task(STUDY, replace(RollChoices(case="drop", height="0.1 mm").asked(), seconds=0.1)).inputs)
    inputs["options"] = {"element_size": 40e-3, "axial_size": 60e-3}
    monkeypatch.setattr(
        task_module, "TravelSettings", lambda **_: TravelSettings(tolerance=1e-9, first_step=2e-3, smallest_step=1e-3)
    )
    unknowns = task_module.move(inputs, {}, tmp_path, lambda _: None)
    found = json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))
    series = read_series(tmp_path / task_module.SERIES, "drop", "ancf_wheel")
    assert found["dofs"] == unknowns
    assert "stopped at" in found[FAILURE]
    assert series.partial
    assert series.time[-1] < 0.1


def test_a_wheel_heavier_than_its_load_is_refused(tmp_path: Path) -> None:
    inputs = dict(motion_task(STUDY, RollChoices(case="drop", load=1.0).asked()).inputs)
    inputs["options"] = {"element_size": 40e-3, "axial_size": 60e-3}
    with pytest.raises(InputError, match="own weight"):
        task_module.move(inputs, {}, tmp_path, lambda _: None)
