"""A tagged mesh as a NumPy archive without pickle. Verified by tests/unit/test_workbench_tasks.py."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from contracts.mesh import TaggedMesh

__all__ = ["MESH", "OWN_FILE", "read_mesh", "write_mesh"]

MESH = "mesh.npz"
OWN_FILE = "own mesh"
"""What a task calls the user's file among what it needs."""
_ARRAYS = ("points", "cells", "cell_tags", "facets", "facet_tags")


def write_mesh(mesh: TaggedMesh, path: Path) -> None:
    """Write every array, and the names of parts and faces in the order of their tags; a planar mesh's widths too."""
    arrays = {name: getattr(mesh, name) for name in _ARRAYS}
    arrays["widths"] = np.array([mesh.widths[part] for part in mesh.parts if mesh.widths])
    for group, names in (("part", mesh.parts), ("face", mesh.faces)):
        arrays[f"{group}_names"] = np.array(list(names), dtype=np.str_)
        arrays[f"{group}_numbers"] = np.array(list(names.values()), dtype=np.int32)
    np.savez_compressed(path, **arrays)


def read_mesh(path: Path) -> TaggedMesh:
    """Read what ``write_mesh`` wrote."""
    with np.load(path, allow_pickle=False) as archive:
        names = {
            group: dict(zip(archive[f"{group}_names"].tolist(), archive[f"{group}_numbers"].tolist(), strict=True))
            for group in ("part", "face")
        }
        return TaggedMesh(
            **{name: archive[name] for name in _ARRAYS},
            parts=names["part"],
            faces=names["face"],
            widths=dict(zip(names["part"], archive["widths"].tolist(), strict=bool(len(archive["widths"])))),
        )
