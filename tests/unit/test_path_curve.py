"""Curves along a path: work of forces and moments that are known, the file and back, what is refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from contracts.errors import InputError
from contracts.hub_travel import HubPlace
from contracts.path_curve import PathCurve, _turns, read_path, write_path
from contracts.travel_curve import WRENCH

ROUND = [HubPlace(radial=0.01), HubPlace(radial=0.01, lateral=0.005), HubPlace(radial=0.008, lateral=0.005)]


def curve(places: list[HubPlace], **columns: float) -> PathCurve:
    n = len(places)
    known = {name: np.full(n, columns.get(name, 0.0)) for name in (*WRENCH, *columns)}
    return PathCurve(
        model="fe", orientation_deg=15.0, places=np.array(places), columns=known, source="made up", partial=True
    )


def test_a_force_that_holds_the_hub_back_takes_work() -> None:
    """To the left against -40 N, then up with the load of 200 N: 0.2 J and -0.4 J."""
    np.testing.assert_allclose(curve(ROUND, load_N=200.0, force_left_N=-40.0).work, [0.0, 0.2, -0.2], atol=1e-15)


def test_a_moment_takes_work_in_a_turn_though_others_came_first() -> None:
    """Each way by 0.1 against -3 N m; leant by 0.2 against -2 where it was wound up: about axes that turned along."""
    for turned, moment in (("leaning", "forward"), ("wind_up", "left"), ("turning", "up")):
        turns = [HubPlace(radial=0.01), HubPlace(radial=0.01)._replace(**{turned: 0.1})]
        assert curve(turns, **{f"moment_{moment}_Nm": -3.0}).work[-1] == pytest.approx(0.3, rel=1e-12)
    steps = np.linspace(0.0, 0.2, 201)
    both = [HubPlace(radial=0.01, wind_up=0.001, leaning=float(one)) for one in steps]
    assert curve(both, moment_forward_Nm=-2.0).work[-1] == pytest.approx(0.4, rel=1e-5)


def test_the_turns_between_rotation_vectors_are_those_of_the_rotations() -> None:
    """About axes that turn along: scipy's R_1^T R_2, to the second order of the steps."""
    vectors = np.outer(np.linspace(0.0, 1.0, 101), [0.3, -0.8, 0.5]) + 0.2 * np.sin(np.linspace(0.0, 3.0, 101))[:, None]
    turned = Rotation.from_rotvec(vectors)
    np.testing.assert_allclose(_turns(vectors), (turned[:-1].inv() * turned[1:]).as_rotvec(), atol=1e-6)
    assert np.abs(_turns(vectors) - np.diff(vectors, axis=0)).max() > 1e-3


def test_what_is_stored_and_lost_are_sums_of_what_there_is() -> None:
    one = curve(ROUND, stored_energy_J=3.0, slip_energy_J=1.0, friction_dissipation_J=2.0)
    assert (one.stored[-1], one.lost[-1], curve(ROUND).lost[-1]) == (4.0, 2.0, 0.0)


def test_the_file_holds_everything(tmp_path: Path) -> None:
    one = curve(ROUND, load_N=200.0, stored_energy_J=3.0)
    write_path(one, tmp_path / "paths" / "fe.csv")
    found = read_path(tmp_path / "paths" / "fe.csv", "fe", 15.0)
    np.testing.assert_array_equal(found.places, one.places)
    assert found.columns.keys() == one.columns.keys()
    assert (found.source, found.partial) == ("made up", True)
    head = (tmp_path / "paths" / "fe.csv").read_text().splitlines()[2].split(",")
    assert head[:6] == ["fore_aft_m", "lateral_m", "radial_m", "leaning_rad", "wind_up_rad", "turning_rad"]
    assert "work_J" in head


def test_a_path_without_its_wrench_or_of_one_row_is_refused() -> None:
    one = curve(ROUND)
    with pytest.raises(InputError, match="are missing"):
        replace(one, columns={})
    with pytest.raises(InputError, match="two rows"):
        replace(one, places=one.places[:1])
    with pytest.raises(InputError, match="finite"):
        replace(one, places=np.full((3, 6), np.nan))
