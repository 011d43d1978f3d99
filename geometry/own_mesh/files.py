"""A mesh file of any format that is read.

Verified by tests/unit/test_own_mesh_files.py.
"""

from __future__ import annotations

from pathlib import Path

from contracts.errors import InputError
from contracts.input_file import require_ordinary_file
from geometry.own_mesh.exodus_files import read_exodus
from geometry.own_mesh.file_mesh import FileMesh
from geometry.own_mesh.gmsh_files import read_gmsh
from geometry.own_mesh.inp_files import read_inp
from geometry.own_mesh.meshio_files import read_meshio

__all__ = ["ENDINGS", "LARGEST_FILE", "read_mesh_file"]

LARGEST_FILE = 2_000_000_000
"""Of a mesh file [byte]: two million 27-node cells as text."""
_READERS = {
    **{".msh": read_gmsh, ".med": read_gmsh, ".inp": read_inp},
    **{".vtu": read_meshio, ".vtk": read_meshio, ".exo": read_exodus, ".e": read_exodus},
}
ENDINGS = tuple(_READERS)


def read_mesh_file(path: Path) -> FileMesh:
    """Content of a mesh file, by its ending.

    Raises
    ------
    InputError
        For a file that is not there, too large, of no known ending, or that cannot be read.
    """
    require_ordinary_file(path, "mesh file", LARGEST_FILE)
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        rule = f"is of no format that is read: {', '.join(ENDINGS)}"
        raise InputError("mesh file", path, rule, "save it as .msh, e.g. with gmsh or meshio convert")
    return reader(path)
