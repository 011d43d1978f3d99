"""The wheel on the ground as a CalculiX deck: our mesh with 20-node hexahedra, the hub lowered, springs on rim.

Nodes and elements are those of `geometry.inp`. The block is one 8-node hexahedron whose upper face is the plane at
first touch. The hub is lowered on it along the plane's normal, one step a deflection, and may then be moved forwards
over it, one step a travel: it is not the block that moves, for then iterations begin with contact along the whole way,
and with friction none converged. Contact is CalculiX's face to face
penalty (CalculiX CrunchiX user's manual 2.20, *CONTACT PAIR, *SURFACE BEHAVIOR, *FRICTION): K times the overlap at the
integration points of the slave faces, which is our law but for its ramp around touch, and K times the elastic slip.
Verified by tests/unit/test_calculix_wheel.py and tests/verification/test_calculix_same_wheel.py.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.peer_codes.calculix import PROGRAM, material_lines
from benchmarks.peer_codes.outcome import measured
from contracts.materials import Material
from contracts.mesh import TaggedMesh
from geometry.hexahedra import FACE_CORNERS
from geometry.inp import TWENTY_NODES, write_inp

__all__ = ["CalculixRun", "WheelDeck", "face_labels", "solve", "write_deck"]

Array = NDArray[np.float64]

_LABELS = np.array([1, 3, 6, 4, 5, 2])
"""CalculiX's number of each of our cells' faces, in the order of `FACE_CORNERS`: bottom, front, left, right, ..."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelDeck:
    """One orientation of a wheel, pressed on a plane.

    Attributes
    ----------
    mesh : 27-node hexahedra of half the wheel, face group ``symmetry`` at y = 0
    materials : of every part that deforms
    rigid : parts that are held
    ground_faces : face groups that may touch the plane
    pairs : slave and master face groups of the wheel's own parts
    normal : unit normal of the plane, to the wheel, (3,) [-]
    distance_at_touch : of the plane from the wheel's centre at first touch [m]
    deflections : of the hub to the plane, ascending [m]
    stiffness : penalty [N/m^3]
    friction : Coulomb coefficient on the ground [-]
    travels : of the hub forwards at the last deflection, ascending [m]
    """

    mesh: TaggedMesh
    materials: Mapping[str, Material]
    rigid: tuple[str, ...]
    ground_faces: tuple[str, ...]
    pairs: tuple[tuple[str, str], ...]
    normal: Array
    distance_at_touch: float
    deflections: tuple[float, ...]
    stiffness: float
    friction: float = 0.0
    travels: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class CalculixRun:
    """Of the ground on the whole wheel [N]: loads at deflections; forces forwards from the last on, one a travel.

    With iterations, converged increments, wall and processor time [s] and largest resident set [MB] of the run.
    """

    loads: tuple[float, ...]
    forwards: tuple[float, ...]
    iterations: int
    wall_s: float
    increments: int
    cpu_s: float
    memory_MB: float


def face_labels(mesh: TaggedMesh, group: str, without: NDArray[np.int64] | None = None) -> list[tuple[int, int]]:
    """Cell (from 0) and CalculiX's face number of every facet of a group; none that has a node of ``without``."""
    facets = mesh.facets[mesh.facet_tags == mesh.faces[group]]
    if without is not None:
        facets = facets[~np.isin(facets, without).any(axis=1)]
    wanted = {tuple(sorted(corners)) for corners in facets[:, :4].tolist()}
    corners = np.sort(mesh.cells[:, np.array(FACE_CORNERS)], axis=2)
    near = np.flatnonzero(np.isin(mesh.cells[:, :8], facets).sum(axis=1) >= 4)
    rows = ((int(cell), face) for cell in near for face in range(6) if tuple(corners[cell, face]) in wanted)
    return [(cell, int(_LABELS[face])) for cell, face in rows]


def write_deck(deck: WheelDeck, folder: Path) -> None:
    """Write ``mesh.inp`` and ``case.inp``."""
    mesh = deck.mesh
    used = np.unique(mesh.cells[:, TWENTY_NODES])
    held = np.unique(mesh.cells[np.isin(mesh.cell_tags, [mesh.parts[part] for part in deck.rigid])])
    middle = np.setdiff1d(_nodes(mesh, "symmetry"), held)
    write_inp(mesh, folder / "mesh.inp", node_sets={"held": held, "middle": middle})
    lines = ["*INCLUDE, INPUT=mesh.inp", *_block(deck, int(used[-1]) + 2, len(mesh.cells) + 1), *_sections(deck)]
    lines += [*_contact(deck), "*BOUNDARY", "GROUND, 1, 3", "HELD, 2, 2", "MIDDLE, 2, 2"]
    forward = _forward(deck)
    for deflection in deck.deflections:
        lines += _step(-deflection * deck.normal)
    for travel in deck.travels:
        lines += _step(travel * forward - deck.deflections[-1] * deck.normal)
    (folder / "case.inp").write_text("\n".join(lines) + "\n")


def _forward(deck: WheelDeck) -> Array:
    return np.cross([0.0, 1.0, 0.0], deck.normal)


def _nodes(mesh: TaggedMesh, group: str) -> NDArray[np.int64]:
    return np.unique(mesh.facets[mesh.facet_tags == mesh.faces[group]])


def _block(deck: WheelDeck, first_node: int, element: int) -> list[str]:
    """The block: nodes, one element, its upper face as a surface, its corners as the set GROUND."""
    up, across = deck.normal, np.array([0.0, 1.0, 0.0])
    along, reach = np.cross(across, up), 1.5 * float(np.abs(deck.mesh.points).max())
    middle = -deck.distance_at_touch * up
    flat = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
    corners = [middle + reach * (a * along + b * across) - depth * up for depth in (reach, 0.0) for a, b in flat]
    numbers = range(first_node, first_node + 8)
    nodes = [f"{n}, {x:.12e}, {y:.12e}, {z:.12e}" for n, (x, y, z) in zip(numbers, corners, strict=True)]
    listed = ", ".join(map(str, numbers))
    cell = ["*ELEMENT, TYPE=C3D8, ELSET=BLOCK", f"{element}, {listed}"]
    return ["*NODE", *nodes, *cell, "*NSET, NSET=GROUND", listed, "*SURFACE, NAME=PLANE", f"{element}, S2"]


def _sections(deck: WheelDeck) -> list[str]:
    """A material for each part: its own, or for what is rigid and held anyway that of any other."""
    some = next(iter(deck.materials.values()))
    lines = []
    for part in (*deck.mesh.parts, "block"):
        lines += material_lines(f"OF_{part.upper()}", deck.materials.get(part, some))
        lines.append(f"*SOLID SECTION, ELSET={part.upper()}, MATERIAL=OF_{part.upper()}")
    return lines


def _contact(deck: WheelDeck) -> list[str]:
    """Surfaces and pairs: the ground below the tread, then strips off rings.

    Facets of a strip that share a node with the ring are left out: along its weld the strip has no gap, and curved
    20-node faces of two parts overlap there before anything moves.
    """
    mesh = deck.mesh
    lines = ["*SURFACE, NAME=TREAD"]
    for group in deck.ground_faces:
        lines += [f"{cell + 1}, S{face}" for cell, face in face_labels(mesh, group)]
    penalty = ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{deck.stiffness!r}"]
    rough = ["*FRICTION", f"{deck.friction!r}, {deck.stiffness!r}"] if deck.friction > 0.0 else []
    lines += ["*SURFACE INTERACTION, NAME=GROUNDED", *penalty, *rough, "*SURFACE INTERACTION, NAME=PENALTY", *penalty]
    lines += ["*CONTACT PAIR, INTERACTION=GROUNDED, TYPE=SURFACE TO SURFACE", "TREAD, PLANE"]
    pair = "*CONTACT PAIR, INTERACTION=PENALTY, TYPE=SURFACE TO SURFACE"
    for number, (slave, master) in enumerate(deck.pairs):
        shared = np.intersect1d(_nodes(mesh, slave), _nodes(mesh, master))
        for side, group, without in (("S", slave, shared), ("M", master, None)):
            lines += [f"*SURFACE, NAME={side}{number}"]
            lines += [f"{cell + 1}, S{face}" for cell, face in face_labels(mesh, group, without)]
        lines += [pair, f"S{number}, M{number}"]
    return lines


def _step(place: Array) -> list[str]:
    """Move the hub to a place, CalculiX cuts increments as it needs; print the force on the block at the end."""
    lines = ["*STEP, NLGEOM, INC=400", "*STATIC, SOLVER=SPOOLES", "0.2, 1., 1e-6, 1.", "*BOUNDARY"]
    lines += [f"HELD, {axis + 1}, {axis + 1}, {place[axis]:.12e}" for axis in (0, 2)]
    lines += ["*NODE PRINT, NSET=GROUND, TOTALS=ONLY, FREQUENCY=10000", "RF", "*END STEP"]
    return lines


def solve(deck: WheelDeck, folder: Path, threads: int, limit_s: float) -> CalculixRun:
    """Write the deck, run CalculiX, read the loads of the whole wheel.

    Raises
    ------
    RuntimeError
        If it did not reach the last step.
    subprocess.SubprocessError
        If it failed or took more than ``limit_s`` of processor time.
    """
    folder.mkdir(parents=True, exist_ok=True)
    write_deck(deck, folder)
    run = measured([PROGRAM, "-i", "case"], folder, threads, limit_s)
    rows = [line.split() for line in (folder / "case.sta").read_text().splitlines()[2:]]
    found = re.findall(r"total force .*\n\n\s*(\S+)\s+(\S+)\s+(\S+)", (folder / "case.dat").read_text())
    pressed, steps = len(deck.deflections), len(deck.deflections) + len(deck.travels)
    if len(found) != steps:
        raise RuntimeError(f"CalculiX ended in step {len(found) + 1} of {steps}")
    forces = 2.0 * np.array(found, dtype=np.float64)
    loads, forwards = (forces @ deck.normal)[:pressed], (forces @ _forward(deck))[pressed - 1 :]
    return CalculixRun(
        loads=tuple(loads.tolist()),
        forwards=tuple(forwards.tolist()),
        iterations=sum(int(row[3]) for row in rows),
        wall_s=run.wall_s,
        increments=sum(not row[2].endswith("U") for row in rows),
        cpu_s=run.cpu_s,
        memory_MB=run.memory_MB,
    )
