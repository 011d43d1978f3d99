"""Meshes and CAD files that are cut off because no more fits: noticed, removed, told of.

Each is written by a process whose files may be 20 kB long, as on a disk with no more room; gmsh says nothing of it.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from geometry.written import check_written

ROOT = Path(__file__).parents[2]
SCRIPT = """
import resource, sys
from pathlib import Path
from geometry.build import build_mesh
from geometry.msh import write_msh
from geometry.step import write_step
from geometry.wheel import exomars
wheel, path = exomars(), Path(sys.argv[1])
mesh = build_mesh(wheel, element_size=40e-3, parts="flexible") if path.suffix == ".msh" else None
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]), resource.RLIM_INFINITY))
try:
    write_step(wheel, path) if mesh is None else write_msh(mesh, path)
except Exception as error:  # a STEP file is told of by OpenCASCADE
    print("refused")
else:
    print("written")
"""


@pytest.mark.parametrize("name", ["wheel.msh", "wheel.step"])
def test_a_file_cut_off_is_noticed(tmp_path: Path, name: str) -> None:
    path, said = tmp_path / name, []
    for room in (20_000, 100_000_000):
        command = [sys.executable, "-c", SCRIPT, str(path), str(room)]
        said.append(subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split())
    assert said == [["refused"], ["written"]]


def test_the_end_decides(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(b"x" * 1000 + b"END;\n \n")
    check_written(path, b"END;")
    with pytest.raises(OSError, match=r"No space left on device: .*file"):
        check_written(path, b"$End")
    assert not path.exists()
    with pytest.raises(OSError, match="No space left"):
        check_written(path, b"END;")
