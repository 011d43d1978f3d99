"""B-spline surfaces in STEP files: written, read back by gmsh, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.errors import InputError
from geometry.spline_surface import SplineSurface, bezier_surface
from geometry.surface_step import step_points, write_surfaces_step

RNG = np.random.default_rng(5)
UV = RNG.uniform(size=(12, 2))
KNOTS = np.array([0.0, 0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 1.0]), np.array([0.0, 0.0, 0.7, 1.0, 1.0])


def _patch(name: str) -> SplineSurface:
    return bezier_surface(name, 0.1 * RNG.normal(size=(4, 4, 3)))


def _knotted(name: str) -> SplineSurface:
    return SplineSurface(name=name, control_points=0.1 * RNG.normal(size=(5, 3, 3)), degrees=(3, 1), knots=KNOTS)


def test_surfaces_come_back_under_their_names(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """Several knots, several surfaces, metres in and out; nothing on standard output."""
    surfaces = [_patch("rim 0 upper"), _knotted("rim 1 upper"), _patch("spoke")]
    path = tmp_path / "new" / "surfaces.step"
    write_surfaces_step(surfaces, path)
    found = step_points(path, UV)
    assert list(found) == [surface.name for surface in surfaces]
    for surface in surfaces:
        np.testing.assert_allclose(found[surface.name], surface.value(UV), atol=1e-12)
    text = path.read_text(encoding="utf-8")
    assert text.count("= B_SPLINE_SURFACE_WITH_KNOTS") == 3
    assert "SI_UNIT(.MILLI.,.METRE.)" in text
    assert capfd.readouterr().out == ""


def test_one_surface_has_its_name_too(tmp_path: Path) -> None:
    write_surfaces_step([_patch("alone")], tmp_path / "one.step")
    assert list(step_points(tmp_path / "one.step", UV)) == ["alone"]


def test_negative_control_a_control_point_moved_by_a_micrometre(tmp_path: Path) -> None:
    surface = _patch("moved")
    write_surfaces_step([surface], tmp_path / "moved.step")
    surface.control_points[1, 2] += 1e-6
    assert np.abs(step_points(tmp_path / "moved.step", UV)["moved"] - surface.value(UV)).max() > 1e-7


def test_bad_names_and_knots_are_refused(tmp_path: Path) -> None:
    uniform = np.arange(8.0)
    free = SplineSurface(name="free", control_points=np.zeros((4, 4, 3)), degrees=(3, 3), knots=(uniform, uniform))
    for surfaces, text in (
        ([], "one or more"),
        ([_patch("a"), _patch("a")], "different"),
        ([_patch("it's")], "ASCII"),
        ([_patch("Ma\u00df")], "ASCII"),
        ([free], "clamped"),
    ):
        with pytest.raises(InputError, match=text):
            write_surfaces_step(surfaces, tmp_path / "bad.step")
    assert not (tmp_path / "bad.step").exists()


def test_a_file_that_is_none_is_refused(tmp_path: Path) -> None:
    (tmp_path / "text.step").write_text("not a STEP file\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"text\.step"):
        step_points(tmp_path / "text.step", UV)
