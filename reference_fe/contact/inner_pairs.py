"""Which faces of a wheel may touch which, from the face groups that its mesh has."""

from __future__ import annotations

from itertools import combinations_with_replacement

from contracts.mesh import TaggedMesh
from reference_fe.contact.inner import ContactPair

__all__ = ["wheel_contact_pairs"]

_CELL = "lattice_cell_"


def wheel_contact_pairs(mesh: TaggedMesh) -> tuple[ContactPair, ...]:
    """Pairs of face groups between rim and outer hub, and between the hubs where the mesh has the impact springs.

    A spring set is known by its face groups ``{set}_front`` (the broad side that faces both rings) and ``{set}_back``.
    The strip is the slave, the ring the master; of two rings the rim, or the outer hub, is the slave. A strip's back
    can meet the hub, and the back of a strip (a hoop's two welds, where it bottoms out), never its own ring. In a
    planar mesh sets of different axial bands lie over each other: a set touches itself and the rings, no other set, and
    finds the rings whole where other sets are welded to them. Walls of a lattice meet within their cell, a face group
    ``lattice_cell_{row}_{number}``; those of the first row meet the hub, too, those of the last one the rim.

    Verified by tests/unit/test_fe_inner_contact.py.
    """
    sets = [name.removesuffix("_front") for name in mesh.faces if name.endswith("_front")]
    inner = [name for name in sets if name == "impact_springs"]
    pairs = _gap_pairs([name for name in sets if name not in inner], "tire_inner", "outer_hub_outer", mesh.dim)
    pairs += _cell_pairs([name for name in mesh.faces if name.startswith(_CELL)])
    if inner:
        pairs += _gap_pairs(inner, "outer_hub_bore", "inner_hub_outer", mesh.dim)
    return tuple(pair for pair in pairs if pair.slave in mesh.faces and pair.master in mesh.faces)


def _cell_pairs(cells: list[str]) -> list[ContactPair]:
    """Pairs within each cell of a lattice."""
    rows = {cell: int(cell.removeprefix(_CELL).partition("_")[0]) for cell in cells}
    pairs = [ContactPair(slave=cell, master=cell) for cell in cells]
    pairs += [ContactPair(slave=cell, master="outer_hub_outer") for cell, row in rows.items() if row == 0]
    return pairs + [
        ContactPair(slave=cell, master="tire_inner") for cell, row in rows.items() if row == max(rows.values())
    ]


def _gap_pairs(sets: list[str], outer: str, inner: str, dim: int) -> list[ContactPair]:
    """Pairs among the springs in the gap between two rings, and with the rings' faces."""
    others = {name: tuple(other for other in sets if other != name) if dim == 2 else () for name in sets}
    sides = [(f"{name}_front", ring, others[name]) for name in sets for ring in (outer, inner)]
    sides += [(f"{name}_back", inner, others[name]) for name in sets]
    pairs = [ContactPair(slave=slave, master=master, across=across) for slave, master, across in sides]
    pairs += [
        ContactPair(slave=f"{a}_{side}", master=f"{b}_{side}")
        for a, b in combinations_with_replacement(sets, 2)
        if dim == 3 or a == b
        for side in ("front", "back")
    ]
    return [*pairs, ContactPair(slave=outer, master=inner)]
