"""Points of a parameter study: the design, units, and each point a whole valid study or one message that names it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
from pydantic import BaseModel

from contracts.errors import StudyError
from workbench.study.contact import PlaneSection
from workbench.study.key_units import is_whole_number, parts_of, unit_of
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study_table
from workbench.study.section import Section
from workbench.study.sweep import SweepSection
from workbench.study.sweep_points import Point, design_points, place_of, sweep_points

PATH = built_in_study().parent / "exomars_hoops.toml"
TABLE = read_study_table(PATH)


def _points(**sweep: Any) -> list[Point]:
    return sweep_points(PATH, TABLE | {"sweep": sweep})


def _design(**sweep: Any) -> list[dict[str, Any]]:
    return design_points(SweepSection.model_validate(sweep))


def test_a_grid_has_every_combination_once() -> None:
    found = _design(strip_thickness=["0.5 mm", "0.6 mm"], orientation=["0 deg", "15 deg", "30 deg"])
    assert len(found) == 6
    assert {tuple(values.values()) for values in found} == {
        (t, o) for t in ("0.5 mm", "0.6 mm") for o in ("0 deg", "15 deg", "30 deg")
    }
    assert found[0] == {"strip_thickness": "0.5 mm", "orientation": "0 deg"}


def test_a_latin_hypercube_has_one_point_in_each_piece_of_each_range() -> None:
    """Claim: projected on any parameter, n points lie one in each of n equal pieces (McKay et al. 1979)."""
    ranges = {"strip_thickness": {"low": "0.5 mm", "high": "0.8 mm"}, "fe.friction": {"low": 0, "high": 1}}
    found = _design(**ranges, design="latin-hypercube", samples=40, seed=3)
    thickness = np.array([float(values["strip_thickness"].removesuffix(" mm")) for values in found])
    friction = np.array([values["fe.friction"] for values in found])
    assert sorted(np.floor((thickness - 0.5) / 0.3 * 40).astype(int)) == list(range(40))
    assert sorted(np.floor(friction * 40).astype(int)) == list(range(40))
    assert abs(np.corrcoef(thickness, friction)[0, 1]) < 0.5
    assert found == _design(**ranges, design="latin-hypercube", samples=40, seed=3)
    assert found != _design(**ranges, design="latin-hypercube", samples=40, seed=4)


def test_negative_control_a_grid_of_equal_values_is_no_latin_hypercube() -> None:
    assert sorted(np.floor(np.full(40, 0.3) * 40).astype(int)) != list(range(40))


def test_whole_numbers_stay_whole_and_lists_are_drawn_equally_often() -> None:
    found = _design(
        **{"wheel.grousers.count": {"low": 4, "high": 8}, "fe.hub": ["rigid", "elastic"]},
        design="latin-hypercube",
        samples=10,
    )
    assert sorted(values["wheel.grousers.count"] for values in found) == [4, 4, 5, 5, 6, 6, 7, 7, 8, 8]
    assert all(isinstance(values["wheel.grousers.count"], int) for values in found)
    assert sorted(values["fe.hub"] for values in found) == ["elastic"] * 5 + ["rigid"] * 5


@pytest.mark.parametrize(
    ("key", "unit", "whole"),
    [
        ("fe.friction", "", False),
        ("fe.max_deflection", "m", False),
        ("wheel.springs[0].thickness", "m", False),
        ("wheel.springs[0].count", None, True),
        ("materials.Ti-6Al-4V.young_modulus", "Pa", False),
        ("fe.contact_stiffness", "N/m**3", False),
        ("fe.camber", "rad", False),
        ("fe.contact_method", None, False),
        ("fe.obstacle.height", "m", False),
        ("penalty_study.deflection", "m", False),
        ("fe.nothing", None, False),
    ],
)
def test_the_study_knows_the_unit_of_each_key(key: str, unit: str | None, whole: bool) -> None:
    assert (unit_of(key), is_whole_number(key)) == (unit, whole)


def test_every_section_of_a_study_is_one_that_its_keys_can_be_asked_of() -> None:
    """What is no ``Section`` hides its keys from ``unit_of``, so that a sweep and [inferred] do not know them."""
    found, new = set[type[BaseModel]](), {Study}
    while new := {kind for one in new for kind in _models_in(one)} - found:
        found |= new
    assert PlaneSection in found
    assert [kind for kind in found if not issubclass(kind, Section)] == []


def _models_in(kind: type[BaseModel]) -> Iterator[type[BaseModel]]:
    waiting: list[Any] = [field.annotation for field in kind.model_fields.values()]
    while waiting:
        one = waiting.pop()
        waiting += get_args(getattr(one, "__value__", one))
        if isinstance(one, type) and issubclass(one, BaseModel):
            yield one


def test_each_point_is_a_whole_study_with_its_values_and_the_first_is_the_study_as_it_is() -> None:
    base, first, last = _points(strip_thickness=["0.5 mm", "0.7 mm"], **{"fe.friction": [0.2]})
    assert (base.number, base.values, base.study.wheel.tire.thickness) == (0, {}, 0.6173e-3)
    assert first.study.wheel.tire.thickness == 0.5e-3
    assert {springs.thickness for springs in last.study.wheel.springs} == {0.7e-3}
    assert last.study.fe.friction == 0.2
    assert last.study.sweep is None
    assert TABLE["wheel"]["tire"]["thickness"] == "0.6173 mm"


def test_orientation_is_set_wherever_the_study_names_one() -> None:
    (point,) = _points(orientation=["22.5 deg"], base=False)
    wanted = (math.radians(22.5),)
    assert point.study.fe.orientations == point.study.ancf.orientations == wanted
    assert point.study.mesh_study.orientations == wanted


def test_plates_keep_the_contact_stiffness_of_the_whole_rim() -> None:
    (point,) = _points(plates=[8], base=False, models=["ancf"])
    assert point.study.ancf.circumferential_plates == 8
    assert point.study.ancf.contact_stiffness == 500.0


def test_keys_may_be_tied_and_items_of_lists_varied() -> None:
    """Two bands that stay mirror images of each other."""
    key = "wheel.springs[0].bands[1][0] = -wheel.springs[0].bands[0][1]"
    *_, point = _points(**{key: ["38 mm", "42 mm"]})
    assert point.study.wheel.springs[0].bands == ((-0.060, -0.042), (0.042, 0.060))


def test_a_search_begins_at_the_study() -> None:
    """0.6173 mm between 0.5 and 0.7 mm; the third of three counts; -40 mm between -50 and -30 mm; else the middle."""
    section = SweepSection.model_validate(
        {
            "design": "search",
            "samples": 4,
            "aims": {"load_at_10mm_N": {"at_least": 1.0}},
            "strip_thickness": {"low": "0.5 mm", "high": "0.7 mm"},
            "wheel.grousers.count": [4, 6, 12],
            "wheel.springs[0].bands[0][1] = -wheel.springs[0].bands[1][0]": {"low": "-50 mm", "high": "-30 mm"},
            "wheel.outer_hub.outer_radius": {"low": "10 mm", "high": "20 mm"},
            "fe.friction": {"low": 0, "high": 1},
            "wheel.grousers.material": ["a", "b"],
        }
    )
    assert place_of(section, TABLE) == pytest.approx([0.5865, 2.5 / 3.0, 0.5, 0.5, 0.0, 0.5])


def test_a_scale_acts_on_every_strip_after_their_own_values() -> None:
    *_, point = _points(**{"strip_scale": [0.5, 1.5], "wheel.tire.thickness": ["0.8 mm"]})
    assert point.study.wheel.tire.thickness == pytest.approx(1.2e-3)
    assert [springs.thickness for springs in point.study.wheel.springs] == pytest.approx([1.5 * 0.6173e-3] * 2)


def test_an_orientation_step_goes_once_around() -> None:
    *_, point = _points(orientation_step=["30 deg"])
    assert point.study.fe.orientations == pytest.approx(np.deg2rad([0.0, 30.0, 60.0, 90.0]))


def test_the_ground_is_varied_in_a_few_words_and_its_place_beside_it() -> None:
    place = {"fe.obstacle.position": ["5 mm", "-5 mm"]}
    points = _points(**place, obstacle=["step 20 mm", "cleat 20 mm x 12 mm"], base=False)
    found = [point.study.fe.obstacle.model_dump() for point in points]
    assert [one["shape"] for one in found] == ["step", "cleat", "step", "cleat"]
    assert [one["position"] for one in found] == [0.005, 0.005, -0.005, -0.005]
    assert (found[1]["height"], found[1]["width"], found[1]["edge_radius"]) == (0.02, 0.012, 0.005)
    (plane,) = _points(obstacle=["plane"], base=False)
    assert plane.study.fe.obstacle == PlaneSection()


def test_temperature_is_one_of_the_whole_wheel() -> None:
    cold, warm = _points(temperature=["-40 degC", "30 degC"], models=["fe"], base=False)
    assert (cold.temperature, warm.temperature) == (pytest.approx(233.15), pytest.approx(303.15))


def test_a_name_within_a_key_may_have_quotes_as_in_toml() -> None:
    quoted = 'materials."Ti-6Al-4V".young_modulus'
    assert (
        parts_of(quoted) == parts_of("materials.Ti-6Al-4V.young_modulus") == ["materials", "Ti-6Al-4V", "young_modulus"]
    )
    assert parts_of('materials."steel 1.4310".density')[1] == "steel 1.4310"
    assert unit_of(quoted) == "Pa"


def test_keys_may_be_written_without_quotes() -> None:
    assert _design(fe={"friction": [0.0, 0.3]}) == _design(**{"fe.friction": [0.0, 0.3]})


@pytest.mark.parametrize(
    ("sweep", "message"),
    [
        (
            {"strip_thickness": ["0.5 mm", "-1 mm"]},
            r"\[sweep\] point 2 \(strip_thickness = '-1 mm'\): wheel.tire.thick",
        ),
        ({"fe.frictoin": [0.1]}, r"point 1 \(fe.frictoin = 0.1\): fe.frictoin = 0.1: is not a known key"),
        ({"fe.orientations": ["0 deg"]}, r"fe.orientations = 0 deg: is a table or a list, not one value"),
        ({"fe.friction": [10**400]}, r"point 1 \(fe.friction = 10{400}\): fe.friction = .*: is too large"),
        ({"plates": [10**400]}, r"point 1 \(plates = 10{400}\): ancf.circumferential_plates = "),
        ({f"wheel.springs[{'9' * 5000}].count": [1]}, r"names no key of the study"),
        ({"fe.points": {"low": -1e308, "high": 1e308}}, r"must have finite ends"),
        ({f"k{i}": [1] for i in range(101)}, r"sweep.k0: is one of 101 keys, more than 100"),
        ({"": [1]}, r"point 1 \( = 1\): .*names no key of the study"),
        ({"name.deeper": [1]}, r"names no key of the study"),
        ({"wheel.springs[7].count": [1]}, r"names no key of the study"),
        ({"orientation": [15]}, r"point 1 \(orientation = 15\): .*an angle needs its unit"),
        ({"plates": [4, 6]}, r"point 2 \(plates = 6\): ancf.circumferential_plates = .*multiple of the spokes"),
        ({"temperature": ["-40 degC", "900 degC"], "models": ["fe"]}, r"point 2 .*temperature = 900 degC: .* data"),
        ({"temperature": ["-40 degC"]}, r"sweep.temperature = -40 degC: acts on the solid model only"),
        ({"fe.hub": ["rigid", "soft"]}, r"point 2 \(fe.hub = 'soft'\): fe.hub = 'soft': must be 'rigid' or"),
        (
            {"obstacle": ["plane", "wall 9 mm"]},
            r"point 2 \(obstacle = 'wall 9 mm'\): obstacle = .*is not known; give step",
        ),
        ({"obstacle": ["step 3 mm"]}, r"point 1 .*fe.obstacle.edge_radius = .*must not exceed the height"),
        (
            {"obstacle": ["step 9 mm"], "models": ["brush"]},
            r"sweep.obstacle = step 9 mm: acts on ancf_wheel, fe, section",
        ),
        ({}, r"sweep.strip_thickness: must be given, or another key to vary"),
        ({"strip_thickness": []}, r"sweep.strip_thickness = \[\]: must be a list of values or a range"),
        ({"strip_thickness": "0.5 mm"}, r"must be a list of values or a range"),
        ({"strip_thickness": [["0.5 mm"]]}, r"sweep.strip_thickness = a list: must hold plain values"),
        ({"strip_thickness": ["1 mm", "0.1 cm"]}, r"mixes units; write all values in one unit"),
        ({"strip_thickness": ["1 mm", "1 mm"]}, r"holds a value twice"),
        ({"fe.points": [9], "fe.friction = fe.points": [8]}, r"= 8: is varied twice, by 'fe.points' too"),
        ({"strip_thickness": {"low": "0.5 mm", "high": "0.6 mm"}}, r"a range: has no grid"),
        ({"strip_thickness": {"low": "0.5 mm", "high": "1 cm"}}, r"has two units"),
        ({"strip_thickness": {"low": "0.5 mm"}}, r"must have low and high"),
        ({"strip_thickness": {"low": "2 mm", "high": "1 mm"}}, r"low less than high"),
        ({"strip_thickness": ["1 mm"], "samples": 3}, r'sweep.samples = 3: belongs to design = "latin-hypercube"'),
        ({"strip_thickness": ["1 mm"], "design": "latin-hypercube"}, r"sweep.samples: must say how many"),
        ({"strip_thickness": ["1 mm"], "models": ["fem"]}, r"sweep.models\[0\] = 'fem': must be 'fe'"),
        ({"fe.friction": [i / 1000 for i in range(999)], "fe.points": [*range(2, 99)]}, r"makes 96903 combinations"),
    ],
)
def test_a_bad_sweep_is_one_message_that_names_point_and_key(sweep: dict[str, Any], message: str) -> None:
    with pytest.raises(StudyError, match=message):
        _points(**sweep)


def test_a_study_without_a_sweep_says_what_to_add() -> None:
    with pytest.raises(StudyError, match=r"sweep: is missing"):
        sweep_points(Path("study.toml"), TABLE)
