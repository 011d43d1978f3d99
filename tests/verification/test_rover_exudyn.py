"""Claim: the rover rests, drops, drives and pulls as the same rover does in another code, EXUDYN.

Source: EXUDYN 1.13 on a model written from the rover's file and the manual's tire formulas
(`benchmarks/peer_codes/rover_of_file.py`, `plain_tire.py`): other reading of the file, other coordinates, other
constraints, other integrator, other tire code. Limits are what an earlier model in EXUDYN, written apart from this one
too, differed by: 0.001 N for wheel loads at rest, 0.016 N on the way, 4.5e-6 m in a drop from 10 mm. Reached: 0.0004 N
at rest, 0.0001 N on the straight path, 0.006 N of load and 0.011 N of tractive force on 25 degrees, 3e-7 m in the
level drop and 1.4e-6 m in drops on a slope, which turn the body (steps of both). Negative controls: a principal body
0.1 kg heavier or with half as much inertia again, a bogie's pivot 0.1 mm further ahead, arms whose centre of mass is
20 mm higher, and the tractive force's lever taken as the loaded radius are all seen.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from benchmarks.peer_codes.rover_cases import CASES, our_run, peer_run, rows
from benchmarks.peer_codes.rover_of_file import rover_content

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("name", CASES)
def test_the_rover_does_the_same_in_exudyn(name: str) -> None:
    case = CASES[name]
    for row in rows(case, our_run(case), peer_run(case)):
        assert row["difference"] < row["limit"], row


def test_it_does_the_same_with_the_loaded_radius_as_lever() -> None:
    case = CASES["drive_up"]
    tire = replace(case.scenario.tire, lever="loaded")
    loaded = replace(case, scenario=replace(case.scenario, tire=tire))
    for row in rows(loaded, our_run(loaded), peer_run(loaded, tire={"loaded": True})):
        assert row["difference"] < row["limit"], row


def _heavier(file: dict[str, Any]) -> None:
    file["bodies"][0]["mass"] += 0.1


def _pivot_ahead(file: dict[str, Any]) -> None:
    file["pivots"][0]["position"][0] += 1e-4


def _arms_higher(file: dict[str, Any]) -> None:
    file["leg_bodies"]["arm"]["above_axle"] += 0.02


def _other_inertia(file: dict[str, Any]) -> None:
    """A level drop does not turn the body, one on a slope does."""
    file["bodies"][0]["inertia"] = [1.5 * one for one in file["bodies"][0]["inertia"]]


@pytest.mark.parametrize(
    ("damage", "name"),
    [
        (_heavier, "level"),
        (_pivot_ahead, "level"),
        (_arms_higher, "rest_up"),
        (_other_inertia, "drop_up"),
        (_other_inertia, "drop_across"),
    ],
)
def test_negative_control_a_damaged_file_is_seen(damage: Callable[[dict[str, Any]], None], name: str) -> None:
    file, case = copy.deepcopy(rover_content()), CASES[name]
    damage(file)
    (row,) = rows(case, our_run(case), peer_run(case, file))
    assert row["difference"] > 10.0 * row["limit"], row


def test_negative_control_another_lever_is_seen() -> None:
    case = CASES["rest_up"]
    (row,) = rows(case, our_run(case), peer_run(case, tire={"loaded": True}))
    assert row["difference"] > 1.0, row
