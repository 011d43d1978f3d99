"""Wheels with a lattice or a tread: solid meshes have their volumes and joints, hang together, and have upright cells.

Claim: volumes agree with the closed form to 1e-6 and joint areas to 1e-6 at an element size of 8 mm, order 2, whatever
the number of elements through a thickness; the smallest scaled Jacobian is that of the sharpest corner of a joint's
quadrilateral. Measured: 8e-7 at worst, in the hub's ring.
Source: elementary geometry (geometry/closed_form.py), itself checked against shapely in
tests/unit/test_geometry_lattice.py. Negative controls: another thickness, another foot and another tread are caught.
"""

from __future__ import annotations

import functools
import math
from dataclasses import replace

import numpy as np
import pytest

from contracts.errors import MeshError
from contracts.mesh import TaggedMesh
from geometry.build import build_mesh
from geometry.checks import check_matches_design, check_mesh
from geometry.closed_form import closed_form_joint_areas, closed_form_volume
from geometry.lattice import Lattice, lattice_plan
from geometry.measures import joint_areas, mesh_volume, scaled_jacobians
from geometry.parts import Grousers, Tread
from geometry.resolution import part_bands
from geometry.wheel import WheelDesign, exomars_hoops

HONEYCOMB = Lattice(
    kind="honeycomb", cells=9, layers=2, thickness=1.2e-3, weld_length=7e-3, bands=((-0.06, 0.06),), phase=0.3
)
RE_ENTRANT = replace(HONEYCOMB, kind="re_entrant", layers=1, angle=math.radians(25.0))
BANDS = ((-0.05, -0.02), (0.02, 0.05))
HOOPS = exomars_hoops()
BARE = replace(HOOPS, grousers=None, spring_sets=(), lattice=HONEYCOMB, cone=None, impact_springs=None, inner_hub=None)
DESIGNS = {
    "honeycomb": BARE,
    "re_entrant with grousers": replace(
        BARE, lattice=RE_ENTRANT, grousers=Grousers(count=12, height=3e-3, thickness=1e-3, phase=0.1)
    ),
    "honeycomb in two bands": replace(BARE, lattice=replace(HONEYCOMB, bands=BANDS)),
    "narrow tread": replace(
        BARE, tread=Tread(thickness=8e-3, width=0.09), grousers=Grousers(count=6, height=4e-3, thickness=3e-3)
    ),
}


@functools.cache
def built(design: WheelDesign, through: int, *, half_width: bool = True) -> TaggedMesh:
    refinement = {"tread": 3e-3} if design.tread is not None else {}
    return build_mesh(
        design,
        element_size=8e-3,
        axial_size=40e-3,
        thickness_elements=through,
        half_width=half_width,
        refinement=refinement,
    )


@pytest.mark.parametrize(("name", "through"), [*((name, 1) for name in DESIGNS), ("honeycomb", 3), ("narrow tread", 2)])
def test_volumes_and_joints(name: str, through: int) -> None:
    design = DESIGNS[name]
    half_width = through == 1
    mesh = built(design, through, half_width=half_width)
    check_mesh(mesh)
    assert mesh_volume(mesh) == pytest.approx(dict(closed_form_volume(design, half_width)), rel=1e-6)
    assert joint_areas(mesh) == pytest.approx(dict(closed_form_joint_areas(design, half_width)), rel=1e-6)


@pytest.mark.parametrize("lattice", [HONEYCOMB, RE_ENTRANT], ids=lambda lattice: lattice.kind)
def test_worst_cells_are_the_corners_of_joints(lattice: Lattice) -> None:
    """A quadrilateral of a joint has the triangle's own corner; its others, at the middle, are blunter."""
    mesh = built(replace(BARE, lattice=lattice), 1)
    worst = float(scaled_jacobians(mesh).min())
    sines = []
    for joint in (j for joints in lattice_plan(lattice, (0.05, HOOPS.tire.inner_radius)).joints for j in joints):
        corners = joint.corners(lattice.thickness)
        for k in range(3):
            a, b = corners[k - 1] - corners[k], corners[k - 2] - corners[k]
            sines.append(abs(a[0] * b[1] - a[1] * b[0]) / (np.linalg.norm(a) * np.linalg.norm(b)))
    assert 0.5 < worst <= min(sines) * (1.0 + 1e-9)


def test_negative_controls() -> None:
    """Damage of 0.5 % in a number of the design is caught by the check every mesh goes through."""
    mesh = built(BARE, 1)
    for changes, words in (
        ({"thickness": 1.005 * HONEYCOMB.thickness}, "joint of lattice and lattice_joints"),
        ({"weld_length": 1.005 * HONEYCOMB.weld_length}, "joint of lattice_joints"),
        ({"angle": 1.02 * HONEYCOMB.angle}, "joint of lattice and lattice_joints"),
    ):
        with pytest.raises(MeshError, match=words):
            check_matches_design(mesh, replace(BARE, lattice=replace(HONEYCOMB, **changes)), 1e-4)


def test_the_tread_is_divided_through_its_thickness_and_bonded_where_it_is_wide() -> None:
    design = DESIGNS["narrow tread"]
    mesh = built(design, 1, half_width=False)
    assert part_bands(design)["grousers"] == part_bands(design)["tread"] == ((-0.045, 0.045),)
    nodes = mesh.points[np.unique(mesh.cells[mesh.cell_tags == mesh.parts["tread"]])]
    radii = np.hypot(nodes[:, 0], nodes[:, 2])
    assert len(np.unique(radii.round(7))) == 2 * 3 + 1
    outer = mesh.points[mesh.facets[mesh.facet_tags == mesh.faces["tire_outer"]]]
    assert np.abs(outer[..., 1]).min() == pytest.approx(0.045)  # beside the tread alone the rim is bare
