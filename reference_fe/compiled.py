"""Compilation of the loops over cells and contact points."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import numba

from contracts.compile_cache import kept_by_sources

__all__ = ["compiled"]


def compiled[F: Callable[..., object]](**options: Any) -> Callable[[F], F]:
    """Compile with numba and these options, cached on disk for the present sources of the package."""

    def decorate(function: F) -> F:
        with kept_by_sources(numba.config, Path(__file__).parent):
            return cast(F, numba.njit(cache=True, **options)(function))

    return decorate
