"""Where a package keeps its compiled functions: one folder for each state of its sources.

A compiler that caches by the file of a function does not see that another file changed whose function or constant it
took in; after an update old machine code would then compute on. A folder named by a digest of all sources of the
package, of ``contracts``, whose constants every package takes in, and of ``soil``, whose laws some compile, holds what
belongs together.
"""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

__all__ = ["compile_cache", "kept_by_sources"]

_PREFIX = "compiled-"


@cache
def compile_cache(package: Path) -> Path:
    """Folder for what is compiled from the present sources of a package; folders of earlier states are removed.

    Parameters
    ----------
    package : folder of the package

    Verified by tests/unit/test_compile_cache.py.
    """
    keep = package / "__pycache__" / f"{_PREFIX}{_state(package)}"
    for folder in keep.parent.glob(f"{_PREFIX}*"):
        if folder != keep:
            shutil.rmtree(folder, ignore_errors=True)
    return keep


def _state(package: Path) -> str:
    """Digest of the sources of a package, of this one and of the soil's laws."""
    digest, here = hashlib.sha256(), Path(__file__).parent
    for root in (package, here, here.parent / "soil"):
        for source in sorted(root.rglob("*.py")):
            digest.update(source.relative_to(root).as_posix().encode())
            digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


@contextmanager
def kept_by_sources(config: Any, package: Path) -> Iterator[None]:
    """Within, numba caches in `compile_cache` of the package, or so in the folder the user chose (``NUMBA_CACHE_DIR``).

    Parameters
    ----------
    config : ``numba.config``, handed in as this package knows numpy alone; it is left as it was
    package : as in `compile_cache`
    """
    users = config.CACHE_DIR
    config.CACHE_DIR = str(
        Path(users) / f"{package.name}-{_PREFIX}{_state(package)}" if users else compile_cache(package)
    )
    try:
        yield
    finally:
        config.CACHE_DIR = users
