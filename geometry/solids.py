"""Sections and cone as OpenCASCADE solids in a gmsh session, divided into structured hexahedra.

Every solid is a block with its part's name; every named surface comes from the block side that made it.
Verified by tests/verification/test_mesh_volume.py and tests/verification/test_mesh_conformity.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.blocks import Block, Curve, Key, Section
from geometry.resolution import Ring

__all__ = [
    "ConeShape",
    "Drawn",
    "Solids",
    "add_cone",
    "add_section",
    "divide_faces",
    "draw_faces",
    "draw_frustum_section",
    "mesh_solids",
]

Array = NDArray[np.float64]

Drawn = tuple[Block, int, dict[str, tuple[int, ...]]]
"""A block, its face, and the tags of its curves ``"inner"``, ``"outer"``, ``"ends"`` and of its ``"corners"``."""

_SAME_PLACE = 1e-7


@dataclass(slots=True, kw_only=True)
class Solids:
    """What has been built in a session so far.

    Attributes
    ----------
    volumes : (part name, volume tag) of each block
    surfaces : (face group, surface tag)
    curves : (curve tag, elements) still to be divided
    faces : (surface tag, corner point tags) of the base faces still to be divided
    wedges : elements along circle, radius and thickness of each volume of a cone
    raised : (face group of the base, drawn blocks) of each axial band, whose volumes and surfaces are still to be named
    """

    volumes: list[tuple[str, int]] = field(default_factory=list)
    surfaces: list[tuple[str, int]] = field(default_factory=list)
    curves: list[tuple[int, int]] = field(default_factory=list)
    faces: list[tuple[int, tuple[int, ...]]] = field(default_factory=list)
    wedges: list[tuple[int, int, int]] = field(default_factory=list)
    raised: list[tuple[str | None, list[Drawn]]] = field(default_factory=list)


@dataclass(frozen=True, slots=True, kw_only=True)
class ConeShape:
    """Section of the cone: radii (outer, inner) [m], axial extents ((y0, y1) outer, inner) [m], elements."""

    radii: tuple[float, float]
    joints: tuple[tuple[float, float], tuple[float, float]]
    n_radial: int
    n_thickness: int


@dataclass(slots=True, kw_only=True)
class _Pen:
    """Draws the points and curves of one section at the axial position ``y``, each only once."""

    occ: Any
    section: Section
    y: float
    points: dict[Key, int] = field(default_factory=dict)
    centres: dict[tuple[float, float], int] = field(default_factory=dict)
    curves: dict[tuple[Key, Key], int] = field(default_factory=dict)

    def point(self, key: Key) -> int:
        if key not in self.points:
            x, z = self.section.corners[key]
            self.points[key] = self.occ.addPoint(x, self.y, z)
        return self.points[key]

    def line(self, start: Key, end: Key) -> int:
        return self._once(start, end, lambda a, b: int(self.occ.addLine(a, b)))

    def long_side(self, curve: Curve) -> int:
        return self._once(curve.start, curve.end, lambda a, b: self._bend(curve, a, b))

    def _once(self, start: Key, end: Key, draw: Any) -> int:
        if (start, end) not in self.curves:
            tag = draw(self.point(start), self.point(end))
            self.curves[start, end], self.curves[end, start] = tag, -tag
        return self.curves[start, end]

    def _bend(self, curve: Curve, a: int, b: int) -> int:
        if curve.centre is not None:
            at = (float(curve.centre[0]), float(curve.centre[1]))
            if at not in self.centres:
                self.centres[at] = self.occ.addPoint(at[0], self.y, at[1])
            return int(self.occ.addCircleArc(a, self.centres[at], b))
        if curve.through is None:
            return int(self.occ.addLine(a, b))
        assert curve.tangents is not None
        between = [self.occ.addPoint(x, self.y, z) for x, z in curve.through]
        tangents = [c for t in curve.tangents for c in (t[0], 0.0, t[1])]
        # The points between stay: to remove one, OpenCASCADE goes through the whole model; no cell has their nodes.
        return int(self.occ.addSpline([a, *between, b], tangents=tangents))


def draw_faces(occ: Any, section: Section, y: float) -> list[Drawn]:
    """Draw the blocks of a section at the axial position ``y`` [m] as plane faces that share their edges.

    Returns each block with its face and the tags of its ``"inner"``, ``"outer"`` and ``"ends"`` curves (negative where
    run backwards) and ``"corners"`` points.
    """
    pen = _Pen(occ=occ, section=section, y=y)
    drawn = []
    for block in section.blocks:
        inner, outer = pen.long_side(block.inner), pen.long_side(block.outer)
        ends = pen.line(block.inner.start, block.outer.start), pen.line(block.inner.end, block.outer.end)
        face = int(occ.addPlaneSurface([occ.addCurveLoop([inner, ends[1], -outer, -ends[0]])]))
        corners = [block.inner.start, block.inner.end, block.outer.end, block.outer.start]
        points = tuple(pen.points[key] for key in corners)
        drawn.append((block, face, {"inner": (inner,), "outer": (outer,), "ends": ends, "corners": points}))
    occ.remove([(0, p) for p in pen.centres.values()])
    return drawn


def add_section(gmsh: Any, solids: Solids, section: Section, band: tuple[float, float, int], base: str | None) -> None:
    """Draw a section at y0, extrude it to y1 and record the blocks.

    Parameters
    ----------
    gmsh : module of an open session
    solids : record that is added to
    section : corners and blocks
    band : y0 [m], y1 [m], elements along the axle
    base : face group of the faces at y0, or None
    """
    occ = gmsh.model.occ
    drawn = draw_faces(occ, section, band[0])
    _note_divisions(solids, drawn)
    bases = {face for _, face, _ in drawn}
    occ.extrude([(2, f) for f in bases], 0.0, band[1] - band[0], 0.0, numElements=[band[2]], recombine=True)
    solids.raised.append((base, drawn))


def _note_divisions(solids: Solids, drawn: list[Drawn]) -> None:
    """Record how drawn blocks are divided along and across."""
    for block, face, sides in drawn:
        solids.faces.append((face, sides["corners"]))
        solids.curves += [(abs(c), block.n_length) for c in (*sides["inner"], *sides["outer"])]
        solids.curves += [(abs(c), block.n_thickness) for c in sides["ends"]]


def _name_raised(gmsh: Any, solids: Solids) -> None:
    """Record the volume each block was raised to, and the surfaces raised from its named sides."""
    for base, drawn in solids.raised:
        bases = {face for _, face, _ in drawn}
        for block, face, sides in drawn:
            solids.volumes.append((block.part, int(gmsh.model.getAdjacencies(2, face)[0][0])))
            if base is not None:
                solids.surfaces.append((base, face))
            for side, group in block.groups.items():
                for curve in sides[side]:
                    above = set(map(int, gmsh.model.getAdjacencies(1, abs(curve))[0])) - bases
                    solids.surfaces += [(group, s) for s in sorted(above)]


def add_cone(gmsh: Any, solids: Solids, shape: ConeShape, ring: Ring) -> None:
    """Revolve the cone's section about the axle, one block per interval of the hub's division.

    The blocks are divided as transfinite volumes, not as extruded meshes: gmsh recognises a revolved end by its place
    and would take the ring's last end for the source of its first. Only the cone may be in the session's model.
    """
    occ = gmsh.model.occ
    levels = [np.linspace(low, high, shape.n_thickness + 1) for low, high in shape.joints]
    for i, count in enumerate(ring.counts):
        for k in range(shape.n_thickness):
            joints = [(float(y[k]), float(y[k + 1])) for y in levels]
            face = draw_frustum_section(occ, shape.radii, (joints[0], joints[1]), ring.angle(i))
            revolved = occ.revolve([(2, face)], 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -ring.step(i))
            solids.volumes.append(("cone", int(next(tag for dim, tag in revolved if dim == 3))))
            solids.wedges.append((int(count), shape.n_radial, 1))


def draw_frustum_section(
    occ: Any, radii: tuple[float, float], joints: tuple[tuple[float, float], tuple[float, float]], phi: float
) -> int:
    """Face of a frustum's section at ``phi`` [rad]: from the joint (y0, y1) at one radius to that at the other [m]."""
    corners = [(radii[0], joints[0][0]), (radii[0], joints[0][1]), (radii[1], joints[1][1]), (radii[1], joints[1][0])]
    points = [occ.addPoint(r * math.sin(phi), y, -r * math.cos(phi)) for r, y in corners]
    return int(occ.addPlaneSurface([occ.addCurveLoop([occ.addLine(points[k], points[k - 3]) for k in range(4)])]))


def _divide_wedge(gmsh: Any, volume: int, counts: tuple[int, int, int]) -> None:
    """Transfinite counts of a revolved block: along circles, along the radius, through the thickness."""
    faces = gmsh.model.getBoundary([(3, volume)], oriented=False)
    for _, curve in {c for face in faces for c in gmsh.model.getBoundary([face], oriented=False)}:
        ends = [gmsh.model.getValue(0, int(p), []) for p in gmsh.model.getAdjacencies(1, curve)[1]]
        (r0, y0), (r1, y1) = ((math.hypot(x, z), y) for x, y, z in ends)
        same_r, same_y = abs(r1 - r0) < _SAME_PLACE, abs(y1 - y0) < _SAME_PLACE
        count = counts[0] if same_r and same_y else counts[2] if same_r else counts[1]
        gmsh.model.mesh.setTransfiniteCurve(curve, count + 1)
    for _, face in faces:
        gmsh.model.mesh.setTransfiniteSurface(face)
        gmsh.model.mesh.setRecombine(2, face)
    gmsh.model.mesh.setTransfiniteVolume(volume)


def mesh_solids(gmsh: Any, solids: Solids, order: int) -> None:
    """Divide every base face into structured quadrilaterals and mesh in three dimensions with the given order."""
    mesh = gmsh.model.mesh
    gmsh.model.occ.synchronize()
    _name_raised(gmsh, solids)
    for (_, volume), counts in zip(solids.volumes, solids.wedges, strict=False):
        _divide_wedge(gmsh, volume, counts)
    _divide_bases(gmsh, solids)
    gmsh.option.setNumber("Mesh.ElementOrder", order)
    mesh.generate(3)


def divide_faces(gmsh: Any, drawn: list[Drawn], order: int) -> None:
    """Divide drawn blocks into structured quadrilaterals and mesh in two dimensions with the given order."""
    solids = Solids()
    _note_divisions(solids, drawn)
    gmsh.model.occ.synchronize()
    _divide_bases(gmsh, solids)
    gmsh.option.setNumber("Mesh.ElementOrder", order)
    gmsh.model.mesh.generate(2)


def _divide_bases(gmsh: Any, solids: Solids) -> None:
    """Transfinite counts of the base faces and their curves."""
    mesh = gmsh.model.mesh
    for curve, count in solids.curves:
        mesh.setTransfiniteCurve(curve, count + 1)
    for face, corners in solids.faces:
        mesh.setTransfiniteSurface(face, cornerTags=list(corners))
        mesh.setRecombine(2, face)
