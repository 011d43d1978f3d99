"""The ANCF tire of a task: built from its preset, or on plates that came from the study's STEP file.

Verified by tests/unit/test_workbench_study_surfaces.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from contracts.errors import InputError

if TYPE_CHECKING:
    from ancf_reduced.plates.mesh import PlateMesh
    from ancf_reduced.tire.mesh import Tire
    from ancf_reduced.tire.preset import TirePreset

__all__ = ["drawn_tire", "preset_from", "tire_from", "tire_values"]


def tire_values(preset: TirePreset, mesh: PlateMesh | None) -> dict[str, Any]:
    """A tire as inputs of a task: ``"preset"``, and ``"plates"`` where it has plates of its own.

    The plates' numbers themselves are inputs, so that the key of a result follows the surfaces and not a file's date.
    """
    if mesh is None:
        return {"preset": asdict(preset)}
    arrays = {name: getattr(mesh, name).tolist() for name in ("points", "elements", "gradients", "dimensions")}
    return {"preset": asdict(preset), "plates": arrays | {"parts": list(mesh.parts)}}


def preset_from(values: Mapping[str, Any]) -> TirePreset:
    """The preset from a task's inputs, where tuples are lists."""
    from ancf_reduced.tire.preset import TirePreset

    changed: dict[str, Any] = {key: tuple(v) if isinstance(v, list) else v for key, v in values.items()}
    return TirePreset(**changed)


def tire_from(inputs: Mapping[str, Any]) -> Tire:
    """The tire of a task's inputs, see `tire_values`."""
    from ancf_reduced.plates.mesh import PlateMesh
    from ancf_reduced.tire.mesh import build_tire, tire_on_mesh

    preset, plates = preset_from(inputs["preset"]), inputs.get("plates")
    if plates is None:
        return build_tire(preset)
    mesh = PlateMesh(
        points=np.array(plates["points"]),
        elements=np.array(plates["elements"], dtype=np.int64),
        gradients=np.array(plates["gradients"]),
        dimensions=np.array(plates["dimensions"]),
        parts=tuple(plates["parts"]),
    )
    return tire_on_mesh(preset, mesh)


def drawn_tire(values: Mapping[str, Any], n_vectors: int) -> Tire:
    """The tire of a recorded motion, on a coarse contact grid, which is not drawn.

    Parameters
    ----------
    values : see `tire_values`, with plates
    n_vectors : of one tire in the motion

    Raises
    ------
    InputError
        If the values make no tire, or one of other vectors.
    """
    from ancf_reduced.motion.vector_coordinates import with_reference_node

    what, hint = "tire of the motion file", "run the report or the scenario again"
    try:
        preset = dict(values["preset"]) | {"contact_points": (2, 2), "quadrature": (1, 1, 1)}
        tire = tire_from({"preset": preset, "plates": values["plates"]})
        found = with_reference_node(tire.tie).n_vectors
    except (ValueError, KeyError, IndexError, TypeError, OverflowError, RecursionError) as error:
        rule = f"cannot be read ({type(error).__name__}: {str(error)[:80]})"
        raise InputError(what, "its numbers", rule, hint) from error
    if found != n_vectors:
        raise InputError(what, f"{found} vectors", f"must have the motion's {n_vectors}", hint)
    return tire
