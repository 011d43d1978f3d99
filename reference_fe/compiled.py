"""Compilation of the loops over cells and contact points."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import numba

from contracts.compile_cache import kept_by_sources

__all__ = ["compiled"]


def compiled[F: Callable[..., object]](**options: Any) -> Callable[[F], F]:
    """Compile with numba and these options, no entry for callers in C, cached on disk for the present sources."""

    jit: Any = numba.njit  # whose stubs lack an option

    def decorate(function: F) -> F:
        with kept_by_sources(numba.config, Path(__file__).parent):
            return cast(F, jit(cache=True, no_cfunc_wrapper=True, **options)(function))

    return decorate
