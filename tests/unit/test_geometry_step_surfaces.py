"""B-spline surfaces read from STEP files; what cannot be kept is refused."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contracts.errors import InputError
from geometry.gmsh_session import gmsh_session
from geometry.spline_surface import SplineSurface, bezier_surface
from geometry.step import write_named
from geometry.step_surfaces import read_surfaces_step
from geometry.surface_step import write_surfaces_step

RNG = np.random.default_rng(11)
KNOTS = np.array([0.0, 0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 1.0]), np.array([0.0, 0.0, 0.7, 1.0, 1.0])


def _net(rows: int, columns: int) -> np.ndarray:
    """A rectangle of 0.3 x 0.2 m, disturbed."""
    x, y = np.meshgrid(np.linspace(0.0, 0.3, rows), np.linspace(0.0, 0.2, columns), indexing="ij")
    return np.stack([x, y, np.zeros_like(x)], axis=-1) + 0.01 * RNG.normal(size=(rows, columns, 3))


def _surfaces() -> list[SplineSurface]:
    knotted = SplineSurface(name="rim 1", control_points=_net(5, 3), degrees=(3, 1), knots=KNOTS)
    return [bezier_surface("rim 0", _net(4, 4)), knotted]


def test_what_is_written_is_read(tmp_path: Path) -> None:
    """Names, degrees and knots as they were; control points to 13 digits."""
    written = _surfaces()
    write_surfaces_step(written, tmp_path / "two.step")
    found = read_surfaces_step(tmp_path / "two.step")
    assert [s.name for s in found] == ["rim 0", "rim 1"]
    for one, two in zip(written, found, strict=True):
        assert one.degrees == two.degrees
        np.testing.assert_allclose(two.control_points, one.control_points, rtol=0, atol=1e-13)
        for own, other in zip(one.knots, two.knots, strict=True):
            np.testing.assert_array_equal(own, other)


def test_a_closed_ring_is_whole(tmp_path: Path) -> None:
    """Its seam has two vertices, its surface four corners: nothing is trimmed."""
    turn = np.linspace(0.0, 2.0 * np.pi, 9)
    line = 0.13 * np.column_stack([np.sin(turn), np.zeros(9), np.cos(turn)])
    points = np.stack([line, line + np.array([0.0, 0.12, 0.0])], axis=1)
    knots = np.concatenate([[0.0], np.arange(9.0), [8.0]]), np.array([0.0, 0.0, 1.0, 1.0])
    write_surfaces_step(
        [SplineSurface(name="ring", control_points=points, degrees=(1, 1), knots=knots)], tmp_path / "ring.step"
    )
    (found,) = read_surfaces_step(tmp_path / "ring.step")
    assert (found.name, found.control_points.shape) == ("ring", (9, 2, 3))


def test_metres_and_comments(tmp_path: Path) -> None:
    path = tmp_path / "metres.step"
    write_surfaces_step(_surfaces()[:1], path)
    length = read_surfaces_step(path)[0].control_points
    text = path.read_text(encoding="utf-8").replace("SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT( $ ,\n.METRE.) /* #1 = ; */")
    path.write_text(text, encoding="utf-8")
    np.testing.assert_allclose(read_surfaces_step(path)[0].control_points, 1e3 * length)


def test_faces_of_one_product_are_numbered(tmp_path: Path) -> None:
    """A block of six bilinear faces, sewn to one solid."""
    corners = np.stack(np.meshgrid(*3 * [[0.0, 0.2]], indexing="ij"), axis=-1) + 0.02 * RNG.normal(size=(2, 2, 2, 3))
    with gmsh_session("block") as gmsh:
        occ = gmsh.model.occ
        faces = []
        for axis in range(3):
            for net in np.moveaxis(corners, axis, 0):
                tags = [occ.addPoint(*point) for point in np.swapaxes(net, 0, 1).reshape(-1, 3)]
                faces.append(occ.addBSplineSurface(tags, 2, degreeU=1, degreeV=1))
        occ.addVolume([occ.addSurfaceLoop(faces, sewing=True)])
        occ.remove([entity for dim in (2, 1, 0) for entity in occ.getEntities(dim)])
        occ.synchronize()
        write_named(gmsh, tmp_path / "block.step", ["block"])
    assert [s.name for s in read_surfaces_step(tmp_path / "block.step")] == [f"block {k}" for k in range(6)]


def _rational(occ: Any) -> None:
    tags = [occ.addPoint(*point) for point in np.swapaxes(_net(4, 4), 0, 1).reshape(-1, 3)]
    occ.addBSplineSurface(tags, 4, weights=[1.0, 2.0, *[1.0] * 14])


def _plane(occ: Any) -> None:
    occ.addRectangle(0.0, 0.0, 0.0, 1.0, 1.0)


def _trimmed(occ: Any) -> None:
    tags = [occ.addPoint(*point) for point in np.swapaxes(_net(4, 4), 0, 1).reshape(-1, 3)]
    surface = occ.addBSplineSurface(tags, 4)
    occ.cut([(2, surface)], [(3, occ.addBox(-1.0, -1.0, -1.0, 1.1, 2.0, 2.0))])


def _line(occ: Any) -> None:
    occ.addLine(occ.addPoint(0.0, 0.0, 0.0), occ.addPoint(1.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("draw", "text"),
    [(_rational, "rational"), (_plane, "PLANE"), (_trimmed, "trimmed"), (_line, "no face")],
)
def test_what_cannot_be_kept_is_refused(draw: Callable[[Any], None], text: str, tmp_path: Path) -> None:
    with gmsh_session("other") as gmsh:
        draw(gmsh.model.occ)
        gmsh.model.occ.remove(gmsh.model.occ.getEntities(0))
        gmsh.model.occ.synchronize()
        write_named(gmsh, tmp_path / "other.step", ["other"])
    with pytest.raises(InputError, match=text):
        read_surfaces_step(tmp_path / "other.step")


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("ISO-10303-21", "SOLID", "ISO-10303-21"),
        ("SI_UNIT(.MILLI.,.METRE.)", "CONVERSION_BASED_UNIT('INCH',#1)", "unit of length"),
        ("#16 = CARTESIAN_POINT('',(0.,0.,0.))", "#16 = CARTESIAN_POINT('',(0.,0.,5.))", "moves a part"),
    ],
)
def test_files_changed_by_hand_are_refused(old: str, new: str, text: str, tmp_path: Path) -> None:
    path = tmp_path / "changed.step"
    write_surfaces_step(_surfaces(), path)
    before = path.read_text(encoding="utf-8")
    assert old in before
    path.write_text(before.replace(old, new), encoding="utf-8")
    with pytest.raises(InputError, match=text):
        read_surfaces_step(path)
