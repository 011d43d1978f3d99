"""Numbers that no wheel has are refused before anything is built, unusual ones are told; every key has its row.

Source of the cases: issue "nothing absurd is believed"; each of them passed silently before there was a table.
"""

from __future__ import annotations

import copy
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from annotated_types import Ge, Le
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from contracts.errors import InputError, StudyError
from contracts.ranges import Key, range_table
from rover_dynamics.rover.rover_file import EXOMARS_ROVER, read_rover
from tests.end_to_end.small_study import small_study_text
from workbench.report.opening import verdict
from workbench.study.key_units import is_whole_number, parts_of
from workbench.study.magnitudes import (
    GATES,
    loosened,
    numbers_of,
    require_possible,
    study_ranges,
    unusual,
    unusual_curve,
    warnings_of,
)
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study, study_of
from workbench.study.sections import ToleranceSection
from workbench.verdict.statements import families

SHIPPED = sorted(built_in_study().parent.glob("*.toml"))
TABLE = tomllib.loads(built_in_study().read_text(encoding="utf-8"))
TITANIUM = "materials.Ti-6Al-4V"
_AIM = "in the unit of whatever column of the table it is for"
FREE = {
    **dict.fromkeys(
        ("sweep.seed", "input_uncertainty.seed", "optimise.seed"), "any whole number draws points as well as any other"
    ),
    **{f"sweep.aims.*.{kind}": _AIM for kind in ("target", "at_most", "at_least")},
    **{f"sweep.one_of.*.*.*.{kind}": _AIM for kind in ("target", "at_most", "at_least")},
    "sweep.aims.*.within": "a relative difference, more than 0 and at most 1",
    "sweep.one_of.*.*.*.within": "a relative difference, more than 0 and at most 1",
    **dict.fromkeys(("sweep.first_step", "optimise.first_step"), "a part of a range, more than 0 and at most 1"),
}
"""Numbers without a limit, and why."""
DRAWN = (("sweep", "parameters"), ("input_uncertainty", "inputs"), ("optimise", "variables"))
"""Values of other keys, whose limits hold where they are put."""

ABSURD: dict[str, tuple[str, Any]] = {
    "density in g/cm^3": ("density", 4.43),
    "density of a star": ("density", 1e9),
    "strength of nothing": ("yield_strength", "1e-9 Pa"),
    "modulus in kPa": ("young_modulus", "113.8 kPa"),
    "width in m": ("wheel.tire.width", "120 m"),
    "radius in m": ("wheel.tire.outer_radius", "142.5 m"),
    "grouser in m": ("wheel.grousers.height", "3 m"),
    "spring as thick as a thumb": ("wheel.springs[0].thickness", "20 mm"),
    "friction": ("fe.friction", 1e6),
    "contact that is none": ("fe.contact_stiffness", 1e-297),
    "contact beyond numbers": ("fe.contact_stiffness", 1e300),
    "plates' contact that is none": ("ancf.contact_stiffness", 1e-297),
    "plates' contact beyond numbers": ("ancf.contact_stiffness", 1e300),
    "brush that is none": ("brush.radial_stiffness", 1e-297),
    "gate of 1e9": ("tolerances.mesh_uncertainty", 1e9),
    "gate of 100 %": ("tolerances.fe_energy", 1.0),
    "phase in percent": ("wheel.springs[1].phase", "60 %"),
    "phase in counts": ("wheel.springs[1].phase", "60 count"),
    "orientation in ppm": ("mesh_study.orientation", "15 ppm"),
    "friction in degrees": ("fe.friction", "30 deg"),
    "plates of titanium": ("ancf.young_modulus", "113.8 GPa"),
    "elements as large as the wheel": ("mesh.element_size", "140 mm"),
    "ground on its side": ("fe.camber", "80 deg"),
    "a slip of sign": ("poisson_ratio", -0.3),
    "steps without end": ("full.orientation_step", "1e-12 deg"),
}


def changed(key: str, value: object, base: dict[str, Any] = TABLE) -> dict[str, Any]:
    """The study's content with another value at a dotted key."""
    table = copy.deepcopy(base)
    if key in ("density", "yield_strength", "young_modulus", "poisson_ratio"):
        table["materials"]["Ti-6Al-4V"][key] = value
        return table
    *parents, last = parts_of(key)
    at: Any = table
    for part in parents:
        at = at[part]
    at[last] = value
    return table


@pytest.mark.parametrize("case", ABSURD)
def test_what_is_absurd_is_refused_or_told(case: str) -> None:
    key, value = ABSURD[case]
    name = f"{TITANIUM}.{key}" if "." not in key else key
    try:
        told = warnings_of(study_of(Path("s.toml"), changed(key, value)))
    except StudyError as error:
        told = (str(error),)
    assert any(name in line for line in told), told


def test_magnitudes_are_judged_before_anything_is_built(monkeypatch: pytest.MonkeyPatch) -> None:
    def built(*_: object) -> None:
        raise AssertionError

    monkeypatch.setattr("workbench.study.reading.materials_by_part", built)
    with pytest.raises(StudyError, match=r"wheel\.tire\.outer_radius = '142\.5 m': must lie between 5 mm and 5000 mm"):
        study_of(Path("s.toml"), changed("wheel.tire.outer_radius", "142.5 m"))


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_shipped_studies_are_usual(path: Path) -> None:
    """But for the shape of tetrahedra, which a mesh without structure does not bring to the gate of hexahedra."""
    told = warnings_of(read_study(path))
    assert [line.partition(" ")[0] for line in told] == ["tolerances.min_scaled_jacobian"] * (path.stem == "spoked")


def test_the_shipped_rover_is_usual_and_absurd_ones_are_not(tmp_path: Path) -> None:
    assert read_rover().warnings == ()
    text = EXOMARS_ROVER.read_text(encoding="utf-8")
    for old, new, words in (
        ("mass = 246.39796", "mass = 1e-298", "must lie between 0.0001 kg and 1e6 kg"),
        ("[51.0, 65.0, 98.0]", "[51e12, 65e12, 98e12]", "must lie between"),
        ("gravity = 3.711 ", "gravity = 3.711e12 ", "must lie between"),
        ("[0.32, 0.4705, 0.216]", "[320, 470.5, 216]", "must not exceed 20 m"),
    ):
        assert old in text
        (tmp_path / "r.toml").write_text(text.replace(old, new), encoding="utf-8")
        with pytest.raises(InputError, match=words):
            read_rover(tmp_path / "r.toml")
    (tmp_path / "r.toml").write_text(text.replace("mass = 246.39796", "mass = 24639.796"), encoding="utf-8")
    assert [line.partition(";")[0] for line in read_rover(tmp_path / "r.toml").warnings] == [
        "bodies[0].mass = 24639.8 kg is unusual for a body's mass (0.01 kg to 5000 kg)"
    ]


def _fields(kind: type[BaseModel], key: Key) -> list[tuple[Key, FieldInfo]]:
    """Every field that holds numbers, below a section; ``*`` for places in lists and names of tables."""
    found: list[tuple[Key, FieldInfo]] = []
    for name, field in kind.model_fields.items():
        found += _below(field.annotation, (*key, name), field)
    return found


def _below(annotation: Any, key: Key, field: FieldInfo) -> list[tuple[Key, FieldInfo]]:
    annotation = getattr(annotation, "__value__", annotation)
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return _fields(annotation, key)
    if annotation in (int, float):
        return [(key, field)]
    origin = getattr(annotation, "__origin__", None)
    inner = [one for one in getattr(annotation, "__args__", ()) if isinstance(one, type) or hasattr(one, "__args__")]
    if origin is tuple and Ellipsis not in annotation.__args__:
        return [one for k, part in enumerate(inner) for one in _below(part, (*key, k), field)]
    if origin in (tuple, dict):
        return [one for part in inner for one in _below(part, (*key, "*"), field)]
    return [one for part in inner for one in _below(part, key, field)]


def test_every_number_of_a_study_has_its_row_or_its_limits() -> None:
    """Whole numbers have theirs where their type stands. A key without either would be believed whatever it says."""
    found = _fields(Study, ())
    assert len(found) > 100
    for key, field in found:
        name = ".".join(map(str, key))
        if name in FREE or key[:2] in DRAWN:
            continue
        shown = name.replace(".*", "[0]")
        bounds = {type(one) for one in field.metadata} | {type(m) for m in _metadata(field.annotation)}
        whole = is_whole_number(shown) or int in _kinds(field.annotation)
        limited = whole and {Ge, Le} <= bounds
        assert limited or study_ranges().row(key) is not None or "Literal" in str(field.annotation), name


def _metadata(annotation: Any) -> list[Any]:
    annotation = getattr(annotation, "__value__", annotation)
    own = [m for one in getattr(annotation, "__metadata__", ()) for m in getattr(one, "metadata", [one])]
    return own + [m for part in getattr(annotation, "__args__", ()) for m in _metadata(part)]


def _kinds(annotation: Any) -> list[Any]:
    annotation = getattr(annotation, "__value__", annotation)
    return [annotation, *(kind for part in getattr(annotation, "__args__", ()) for kind in _kinds(part))]


def test_rows_are_sound_and_name_keys_that_are() -> None:
    keys = {key for key, _ in _fields(Study, ())}
    for row in study_ranges().ranges:
        assert row.possible[0] <= row.usual[0] < row.usual[1] <= row.possible[1], row
        for name in row.keys:
            assert name.startswith("curve.") or any(_same(name, key) for key in keys), name
    for ratio in study_ranges().ratios:
        assert ratio.possible[0] <= ratio.usual[0] < ratio.usual[1] <= ratio.possible[1], ratio
        assert all(any(_same(name, key) for key in keys) for name in (ratio.key, ratio.beside)), ratio
    rover = range_table(EXOMARS_ROVER.with_name("ranges.toml"))
    assert all(row.possible[0] <= row.usual[0] < row.usual[1] <= row.possible[1] for row in rover.ranges)


def _same(pattern: str, key: Key) -> bool:
    parts = pattern.split(".")
    alike = (one == str(other) or "*" in (one, other) for one, other in zip(parts, key, strict=False))
    return len(parts) == len(key) and all(alike)


@pytest.mark.parametrize("factor", [1e12, 1e-12])
def test_no_number_of_the_shipped_study_may_be_a_million_millions_larger_or_smaller(factor: float) -> None:
    study = read_study(built_in_study())
    for key, number in numbers_of(study).items():
        row = study_ranges().row(key)
        if row is not None and number:
            assert not row.usual[0] <= abs(number) * factor <= row.usual[1], key


def test_loosened_gates_are_told_in_the_verdict(tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text(small_study_text(), encoding="utf-8")
    study = read_study(tmp_path / "s.toml")
    assert loosened(study) == (
        "tolerances.reach_deflection = 0.006 is looser than the project's own 0.03",
        "tolerances.fe_energy = 0.1 is looser than the project's own 0.01",
        "tolerances.mesh_uncertainty = 0.5 is looser than the project's own 0.05",
        "tolerances.ancf_wheel_mean = 0.02 is looser than the project's own 0.01",
    )
    assert "4 tolerances are the study's own: tolerances.reach_deflection = 0.006" in verdict([], loosened(study))
    assert set(loosened(study)) <= set(warnings_of(study))
    other = study.model_copy(update={"reference": None})
    assert len(loosened(other)) == 3  # reach is not asked of another wheel
    stricter = ToleranceSection(min_scaled_jacobian=0.3, fe_energy=1e-3, reach_load="400 N")
    assert loosened(study.model_copy(update={"tolerances": stricter})) == ()
    easier = ToleranceSection(min_scaled_jacobian=0.1)
    assert len(loosened(study.model_copy(update={"tolerances": easier}))) == 1


def test_gates_are_tolerances_that_checks_are_moved_by() -> None:
    settings = {family.statement.setting for family in families()}
    assert GATES.keys() - {"reach_load", "reach_deflection"} <= settings
    assert GATES.keys() <= ToleranceSection.model_fields.keys()


@pytest.mark.parametrize(
    ("obstacle", "beyond"),
    [
        ({"shape": "cleat", "height": 0.02, "width": 0.02, "edge_radius": 0.005, "position": 0.25}, True),
        ({"shape": "cleat", "height": 0.02, "width": 0.30, "edge_radius": 0.005, "position": 0.25}, False),
        ({"shape": "step", "height": 0.02, "edge_radius": 0.005, "position": -0.15}, True),
        ({"shape": "step", "height": 0.02, "edge_radius": 0.005, "position": 0.14}, False),
        ({"shape": "half_round_rock", "radius": 0.1, "position": 0.24}, False),
    ],
)
def test_an_obstacle_that_misses_the_wheel_is_told(obstacle: dict[str, Any], beyond: bool) -> None:
    """The built-in wheel's grousers reach 145.5 mm."""
    path = built_in_study()
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    table["fe"]["obstacle"] = obstacle
    told = [line for line in warnings_of(study_of(path, table)) if "lies beyond the wheel, which reaches 145.5" in line]
    assert len(told) == beyond


def test_numbers_of_the_command_line_have_the_same_limits() -> None:
    require_possible("target", 8250.0, "reference.slope.value")
    with pytest.raises(InputError, match=r"target = 1e300 N/m: must lie between 1 N/m and 1e9 N/m"):
        require_possible("target", 1e300, "reference.slope.value")


@pytest.mark.parametrize(("modulus", "strength"), [("2 MPa", "8 MPa"), ("1.5 MPa", "25 MPa"), ("25 MPa", "40 MPa")])
def test_rubbers_are_told_of_and_used(modulus: str, strength: str, tmp_path: Path) -> None:
    """They break at many times their modulus."""
    changed = {"113.8 GPa": modulus, "880 MPa": strength}
    text = (built_in_study().parent / "first.toml").read_text(encoding="utf-8")
    for old, new in changed.items():
        assert old in text
        text = text.replace(old, new)
    (tmp_path / "rubber.toml").write_text(text, encoding="utf-8")
    assert any("yield_strength" in line for line in unusual(read_study(tmp_path / "rubber.toml")))


@pytest.mark.parametrize(
    ("deflection", "load", "words"),
    [
        ([0.0, 0.036], [0.0, 290.0], ()),
        ([0.0, 8.0], [0.0, 290.0], ("largest deflection = 8000 mm is unusual for a curve's deflection",)),
        ([0.0, 0.036], [0.0, 2.9e7], ("largest load = 2.9e7 N is unusual",)),
        ([0.0, 0.036], [0.0, -290.0], ("smallest load = -290 N pulls",)),
        ([0.0, 0.036], [-1e-9, 290.0], ()),
        ([0.0, 0.036], [0.0, 0.0], ()),
    ],
)
def test_what_is_unusual_in_a_curve_is_told(deflection: list[float], load: list[float], words: tuple[str, ...]) -> None:
    told = unusual_curve(np.array(deflection), np.array(load))
    assert len(told) == len(words)
    assert all(word in line for word, line in zip(words, told, strict=True)), told
