"""Files of ``workbench stiffness --travel``: one way after the other into one folder."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from contracts.hub_travel import Way
from contracts.travel_curve import WRENCH, TravelCurve
from workbench.commands import travel


def curve(way: Way, orientation: float) -> TravelCurve:
    at = np.array([0.0, 0.001])
    columns = {name: np.array([200.0, 200.0]) for name in WRENCH}
    return TravelCurve(
        model="fe", way=way, orientation_deg=orientation, deflection=0.02, travel=at, columns=columns, source="made up"
    )


def test_a_second_way_into_one_folder_leaves_the_first_and_replaces_its_own(tmp_path: Path) -> None:
    forwards, sideways = [curve(Way.FORE_AFT, 0.0), curve(Way.FORE_AFT, 15.0)], [curve(Way.LATERAL, 0.0)]
    for ways, curves in (
        ((Way.FORE_AFT,), forwards),
        ((Way.LATERAL,), sideways),
        ((Way.FORE_AFT,), forwards[1:]),
    ):
        assert travel._published(tmp_path, "fe", ways, curves) == []
    names = sorted(path.name for path in (tmp_path / "travels").iterdir())
    assert names == ["fe_fore_aft_phi015.csv", "fe_lateral_phi000.csv"]
