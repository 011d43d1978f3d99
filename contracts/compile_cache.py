"""Where a package keeps its compiled functions: one folder for each state of its sources.

A compiler that caches by the file of a function does not see that another file changed whose function it took in; after
an update old machine code would then meet new arguments. A folder named by a digest of all sources of the package holds
what belongs together.
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

_PREFIX, _MARK = "compiled-", b"compiled"


@cache
def compile_cache(package: Path) -> Path:
    """Folder for what is compiled from the present sources of a package; folders of earlier states are removed.

    Parameters
    ----------
    package : folder of the package; of its sources, subfolders included, those count that speak of `compiled`, the name
        of each package's decorator

    Verified by tests/unit/test_compile_cache.py.
    """
    digest = hashlib.sha256()
    for source in sorted(package.rglob("*.py")):
        text = source.read_bytes()
        if _MARK in text:
            digest.update(source.relative_to(package).as_posix().encode())
            digest.update(text)
    keep = package / "__pycache__" / f"{_PREFIX}{digest.hexdigest()[:16]}"
    for folder in keep.parent.glob(f"{_PREFIX}*"):
        if folder != keep:
            shutil.rmtree(folder, ignore_errors=True)
    return keep


@contextmanager
def kept_by_sources(config: Any, package: Path) -> Iterator[None]:
    """Within, numba caches in `compile_cache` of the package, unless the user chose a folder (``NUMBA_CACHE_DIR``).

    Parameters
    ----------
    config : ``numba.config``, handed in as this package knows numpy alone; it is left as it was
    package : as in `compile_cache`
    """
    users = config.CACHE_DIR
    config.CACHE_DIR = users or str(compile_cache(package))
    try:
        yield
    finally:
        config.CACHE_DIR = users
