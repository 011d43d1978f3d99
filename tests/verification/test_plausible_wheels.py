"""The stored curves of the plausible set are what the section model gives today."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.curves import read_curve
from workbench.questions.section.graph import section_tasks
from workbench.questions.section.task import solve_orientation
from workbench.questions.words.plausible import plausible


@pytest.mark.parametrize(("place", "row"), [(0, 0), (0, 7), (-1, 12)])
def test_a_wheel_of_the_set_has_its_curve(place: int, row: int, tmp_path: Path) -> None:
    """One part in ten thousand; a wheel 0.1 % thicker is 0.3 % off."""
    found = plausible()
    wheel = found.wheels[place]
    study = found.point(wheel).study
    (task,) = section_tasks(study, [float(wheel.orientation_deg[row])])
    solve_orientation(task.inputs, {}, tmp_path, lambda fraction: None)
    curve = read_curve(tmp_path / "curve.csv")
    reached = wheel.deflection <= curve.deflection[-1]
    assert np.isfinite(wheel.load[row]).tolist() == reached.tolist()
    np.testing.assert_allclose(curve.load_at(wheel.deflection[reached]), wheel.load[row][reached], rtol=1e-4)
