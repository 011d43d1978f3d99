"""A quicker triangular matrix product for MUMPS where OpenBLAS' own is slow.

MUMPS updates each front of a symmetric matrix by ``dgemmt``, one triangle of a matrix product. OpenBLAS computes it
column by column as matrix times vector (its issue 4921), far below the speed of its ``dgemm``: on the benchmarks a
quarter of a factorisation's time is lost so. ``dgemmt.c`` does it in blocks by ``dgemm``. It is compiled once by the C
compiler that DOLFINx needs anyway, and loaded before PETSc, so that the dynamic linker finds it first. Without a
compiler, or with another build of PETSc than the PyPI wheel's, nothing is replaced: slower, and nothing else.
Verified by tests/unit/test_fe_triangular_product.py.
"""

from __future__ import annotations

import contextlib
import ctypes
import functools
import hashlib
import importlib.util
import os
import platform
import subprocess
import sysconfig
import tempfile
from pathlib import Path

__all__ = ["connect", "provide"]

SOURCE = Path(__file__).with_name("dgemmt.c")


@functools.cache
def provide() -> ctypes.CDLL | None:
    """Load our ``dgemmt`` for every library loaded later; None where there is nothing to replace. `connect` follows."""
    if _openblas() is None:
        return None
    with contextlib.suppress(OSError, RuntimeError, subprocess.SubprocessError):
        return ctypes.CDLL(str(_compiled()), mode=ctypes.RTLD_GLOBAL)
    return None


def connect() -> None:
    """Give our ``dgemmt`` the ``dgemm`` of the wheel's OpenBLAS, once that is loaded and before any use."""
    library, openblas = provide(), _openblas()
    if library is not None and openblas is not None:
        product = ctypes.cast(ctypes.CDLL(str(openblas)).dgemm_, ctypes.c_void_p)
        ctypes.c_void_p.in_dll(library, "dgemmt_product").value = product.value


def _openblas() -> Path | None:
    """OpenBLAS of the PyPI wheel of DOLFINx, if that is installed."""
    wheel = importlib.util.find_spec("dolfinx_solver")
    if wheel is None or wheel.origin is None:
        return None
    found = Path(wheel.origin).parent / "lib" / "libopenblas.so.0"
    return found if found.is_file() else None


def _compiled() -> Path:
    """The shared library, compiled at the first use on this machine."""
    compiler = os.environ.get("CC") or str(sysconfig.get_config_var("CC") or "cc")
    command = [*compiler.split(), "-O2", "-shared", "-fPIC", str(SOURCE), "-o"]
    made_from = SOURCE.read_bytes() + " ".join([platform.machine(), *command[:-2]]).encode()
    digest = hashlib.sha256(made_from).hexdigest()[:16]
    folder = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "wheel-workbench"
    target = folder / f"dgemmt-{digest}.so"
    if not target.is_file():
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder) as scratch:
            made = Path(scratch) / target.name
            subprocess.run([*command, str(made)], check=True, capture_output=True)
            made.replace(target)  # at once: another process may do the same
    return target
