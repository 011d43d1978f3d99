"""A clean gmsh session with fixed options. The only module that imports gmsh, and only when a session opens."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from contracts.errors import MissingLibraryError

__all__ = ["gmsh_session"]

_OPTIONS = {
    "General.Terminal": 0.0,
    "General.NumThreads": 1.0,
    "Mesh.MaxNumThreads1D": 1.0,
    "Mesh.MaxNumThreads2D": 1.0,
    "Mesh.MaxNumThreads3D": 1.0,
    "Mesh.Algorithm": 6.0,
    "Mesh.RecombinationAlgorithm": 0.0,
    "Mesh.RandomFactor": 1e-9,
    "Mesh.SecondOrderLinear": 0.0,
    "Mesh.SecondOrderIncomplete": 0.0,
    "Mesh.HighOrderOptimize": 0.0,
    "Mesh.Optimize": 0.0,
    "Mesh.Binary": 0.0,
    "Mesh.SaveAll": 0.0,
    "Mesh.MeshSizeExtendFromBoundary": 0.0,
    "Geometry.Tolerance": 1e-8,
    "Geometry.OCCAutoFix": 0.0,
}


@contextmanager
def gmsh_session(name: str) -> Iterator[Any]:
    """Yield the gmsh module with a new model, single threaded and silent; leave gmsh as it was found.

    Works in threads other than the main one (no signal handler is set) and never reads a user's gmsh settings. If gmsh
    is already initialised, the session adds a model of its own and restores the caller's model and options after it.

    Parameters
    ----------
    name : name of the model

    Raises
    ------
    MissingLibraryError
        If a shared library of the system that gmsh needs is not there.
    """
    gmsh = _gmsh()
    fresh = not gmsh.isInitialized()
    if fresh:
        gmsh.initialize(readConfigFiles=False, interruptible=False)
    before = {option: gmsh.option.getNumber(option) for option in _OPTIONS}
    current = gmsh.model.getCurrent()
    try:
        for option, value in _OPTIONS.items():
            gmsh.option.setNumber(option, value)
        gmsh.model.add(name)
        yield gmsh
    finally:
        if fresh:
            gmsh.finalize()
        else:
            gmsh.model.remove()
            for option, value in before.items():
                gmsh.option.setNumber(option, value)
            gmsh.model.setCurrent(current)


def _gmsh() -> Any:
    """The module; loads the X11 and OpenGL libraries of the system, which a server may lack."""
    try:
        import gmsh  # type: ignore[import-untyped]
    except OSError as error:
        raise MissingLibraryError("gmsh", str(error)) from error
    return gmsh
