"""The preset refuses numbers out of range and says what to do."""

from __future__ import annotations

from dataclasses import fields, replace

import pytest

from ancf_reduced.tire.preset import TirePreset, refined_preset, thesis_preset
from contracts.errors import InputError


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"outer_radius": 0.0}, "outer radius"),
        ({"width": float("nan")}, "width"),
        ({"contact_stiffness": -1.0}, "contact stiffness = -1 N/m"),
        ({"hub_radius": 0.118}, "hub radius = 118 mm"),
        ({"datum_radius": 0.04}, "datum radius = 40 mm"),
        ({"phase": float("nan")}, "phase"),
        ({"circumferential_plates": 6}, "multiple of the spokes"),
        ({"plates_per_spoke": 0}, "plates per spoke"),
        ({"contact_points": (1, 10)}, "contact points"),
        ({"contact_layout": "random"}, "contact layout"),
        ({"contact_damping": "critical"}, "contact damping = critical: must be one of as_printed, hunt_crossley, none"),
    ],
)
def test_bad_numbers_are_refused(change: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        replace(thesis_preset(), **change)


def test_only_the_thesis_tire_is_damped_as_printed() -> None:
    named = {one.name: getattr(thesis_preset(), one.name) for one in fields(TirePreset)}
    assert named.pop("contact_damping") == "as_printed"
    assert TirePreset(**named).contact_damping == "hunt_crossley"


def test_refinement_keeps_the_contact_stiffness_per_area() -> None:
    fine = refined_preset(thesis_preset(), 16, 2)
    assert (fine.circumferential_plates, fine.plates_per_spoke) == (16, 2)
    assert fine.contact_stiffness * 16 == pytest.approx(4 * thesis_preset().contact_stiffness)


def test_refinement_to_nothing_is_refused() -> None:
    with pytest.raises(InputError, match="circumferential plates"):
        refined_preset(thesis_preset(), 0)
