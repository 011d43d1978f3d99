"""A wheel as a CAD program might give it: solids in a STEP file, which gmsh's OpenCASCADE draws.

``python -m tests.step_wheel studies/spoked.step`` draws the one that is shipped.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

from geometry.gmsh_session import gmsh_session
from geometry.step import write_named

__all__ = ["draw_disc", "draw_wheel"]

HALF_WIDTH, BORE, HUB, INNER, OUTER = 0.02, 0.015, 0.03, 0.093, 0.1
"""Of the spoked wheel [m]."""
SPOKES, THICKNESS, LEAN = 5, 0.007, math.radians(20.0)
"""Their number, thickness [m], and how far a spoke's outer end lies ahead of its inner end [rad]."""


def draw_wheel(path: Path) -> None:
    """The half at y > 0 of a wheel: hub, spokes bent along arcs, rim."""
    with gmsh_session("wheel") as gmsh:
        occ = gmsh.model.occ
        hub, rim = (_ring(occ, *radii, 0.0, HALF_WIDTH) for radii in ((BORE, HUB), (INNER, OUTER)))
        spokes = [_spoke(occ, 2.0 * math.pi * k / SPOKES) for k in range(SPOKES)]
        between = [_ring(occ, HUB, INNER, 0.0, HALF_WIDTH)]
        spokes = [occ.intersect([spoke], between, removeTool=False)[0][0] for spoke in spokes]
        occ.remove(between, recursive=True)
        _write(gmsh, path, {"hub": [hub], "spokes": spokes, "rim": [rim]})


def draw_disc(path: Path, gap: float = 0.0) -> None:
    """Hub of radii 40 and 70 mm in a rim of 100 mm, 50 mm wide; between them a gap [m], or an overlap if it is < 0."""
    with gmsh_session("disc") as gmsh:
        occ = gmsh.model.occ
        _write(
            gmsh,
            path,
            {"hub": [_ring(occ, 0.04, 0.07, -0.025, 0.05)], "rim": [_ring(occ, 0.07 + gap, 0.1, -0.025, 0.05)]},
        )


def _write(gmsh: Any, path: Path, solids: dict[str, list[tuple[int, int]]]) -> None:
    name_of = {tag: name for name, mine in solids.items() for _, tag in mine}
    occ = gmsh.model.occ
    occ.remove([entity for dim in (2, 1, 0) for entity in occ.getEntities(dim)])
    occ.synchronize()
    write_named(gmsh, path, [name_of[tag] for _, tag in occ.getEntities(3)])


def _ring(occ: Any, inner: float, outer: float, start: float, width: float) -> tuple[int, int]:
    bore, body = (occ.addCylinder(0.0, start, 0.0, 0.0, width, 0.0, radius) for radius in (inner, outer))
    found: tuple[int, int] = occ.cut([(3, body)], [(3, bore)])[0][0]
    return found


def _spoke(occ: Any, at: float) -> tuple[int, int]:
    """A plate between two arcs; its ends stick out into hub and rim."""
    ends = 0.5 * (BORE + HUB), 0.5 * (INNER + OUTER)
    start, end = (_place(radius, at + turn) for radius, turn in zip(ends, (0.0, LEAN), strict=True))
    along = end[0] - start[0], end[1] - start[1]
    length = math.hypot(*along)
    across = -along[1] / length, along[0] / length
    width = 0.7 * HALF_WIDTH

    def point(share: float, shift: float) -> int:
        x, z = (start[i] + share * along[i] + shift * across[i] for i in (0, 1))
        return int(occ.addPoint(x, 0.0, z))

    bulge = 0.12 * length
    sides = []
    for shift in (-0.5 * THICKNESS, 0.5 * THICKNESS):
        corners = point(0.0, shift), point(1.0, shift)
        sides.append((corners, occ.addCircleArc(corners[0], point(0.5, shift + bulge), corners[1], center=False)))
    (low, first), (high, second) = sides
    loop = occ.addCurveLoop([first, occ.addLine(low[1], high[1]), second, occ.addLine(high[0], low[0])])
    body = [one for one in occ.extrude([(2, occ.addPlaneSurface([loop]))], 0.0, width, 0.0) if one[0] == 3]
    found: tuple[int, int] = body[0]
    return found


def _place(radius: float, angle: float) -> tuple[float, float]:
    """x and z [m] of a place; position 0 is the lowest, positive ones lie ahead of it."""
    return radius * math.sin(angle), -radius * math.cos(angle)


if __name__ == "__main__":
    draw_wheel(Path(sys.argv[1]))
