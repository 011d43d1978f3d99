"""A tagged mesh as a DOLFINx mesh with named parts and faces."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.mesh import TaggedMesh
from reference_fe import dolfinx_api as api

__all__ = ["Domain"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Domain:
    """DOLFINx mesh with its tags; made from a `contracts.mesh.TaggedMesh`.

    Attributes
    ----------
    tagged : the mesh as given
    mesh : dolfinx.mesh.Mesh
    cell_tags, facet_tags : dolfinx.mesh.MeshTags with the tags of ``tagged``
    width : width at right angles to a planar mesh [m], constant on each cell; 1 for a solid one

    Verified by tests/unit/test_fe_domain.py.
    """

    tagged: TaggedMesh
    mesh: api.Mesh
    cell_tags: api.MeshTags
    facet_tags: api.MeshTags
    width: api.Expr = 1.0

    @classmethod
    def from_tagged(cls, tagged: TaggedMesh) -> Domain:
        """Build the DOLFINx mesh and its tags."""
        mesh = api.mesh_from_arrays(tagged.points, tagged.cells)
        dim = tagged.dim
        cells = np.arange(mesh.topology.index_map(dim).size_local, dtype=np.int32)
        values = tagged.cell_tags[mesh.topology.original_cell_index[: len(cells)]].astype(np.int32)
        return cls(
            tagged=tagged,
            mesh=mesh,
            cell_tags=api.meshtags(mesh, dim, cells, values),
            facet_tags=api.facet_tags_from_nodes(mesh, tagged.facets, tagged.facet_tags.astype(np.int32)),
            width=_width(tagged, mesh) if tagged.widths else 1.0,
        )

    @property
    def dim(self) -> int:
        """Dimension of space: 2 or 3."""
        return self.tagged.dim

    def part_tags(self, names: Iterable[str]) -> tuple[int, ...]:
        """Cell tags of named parts; InputError for a name the mesh does not have."""
        return _look_up(names, dict(self.tagged.parts), "part")

    def face_tags(self, names: Iterable[str]) -> tuple[int, ...]:
        """Facet tags of named faces; InputError for a name the mesh does not have."""
        return _look_up(names, dict(self.tagged.faces), "face")

    def cells_of(self, names: Iterable[str]) -> NDArray[np.int32]:
        """Local cell numbers (n,) of the named parts, ascending."""
        mask = np.isin(self.cell_tags.values, self.part_tags(names))
        return np.asarray(self.cell_tags.indices[mask], dtype=np.int32)

    def facets_of(self, names: Iterable[str]) -> NDArray[np.int32]:
        """Local facet numbers (n,) of the named faces, ascending."""
        mask = np.isin(self.facet_tags.values, self.face_tags(names))
        return np.asarray(self.facet_tags.indices[mask], dtype=np.int32)

    def edges_between(self, first: str, second: str) -> NDArray[np.int32]:
        """Local numbers (n,) of this process' own edges that lie in both named faces, ascending."""
        topology = self.mesh.topology
        topology.create_entities(1)
        topology.create_connectivity(2, 1)
        links = topology.connectivity(2, 1)
        one, other = ({e for f in self.facets_of([name]) for e in links.links(f)} for name in (first, second))
        own = topology.index_map(1).size_local
        return np.array(sorted(e for e in one & other if e < own), dtype=np.int32)

    def cell_of_edge(self, edge: int) -> tuple[int, int]:
        """A cell that has the edge, and the edge's local number in it."""
        topology = self.mesh.topology
        topology.create_connectivity(1, 3)
        topology.create_connectivity(3, 1)
        cell = int(topology.connectivity(1, 3).links(edge)[0])
        return cell, int(np.flatnonzero(topology.connectivity(3, 1).links(cell) == edge)[0])


def _width(tagged: TaggedMesh, mesh: api.Mesh) -> api.Function:
    """Width of each cell's part [m], ghosts included."""
    by_tag = {tag: tagged.widths[part] for part, tag in tagged.parts.items()}
    width: api.Function = api.fem.Function(api.fem.functionspace(mesh, ("DG", 0)))
    width.x.array[:] = [by_tag[int(tag)] for tag in tagged.cell_tags[mesh.topology.original_cell_index]]
    return width


def _look_up(names: Iterable[str], known: dict[str, int], what: str) -> tuple[int, ...]:
    tags = []
    for name in names:
        if name not in known:
            raise InputError(
                f"mesh {what}", name, f"is not in the mesh (it has {', '.join(sorted(known))})", "rename it"
            )
        tags.append(known[name])
    return tuple(tags)
