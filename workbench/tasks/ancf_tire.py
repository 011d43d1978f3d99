"""The ANCF tire of a task: built from its preset, or on plates that came from the study's STEP file.

Verified by tests/unit/test_workbench_study_surfaces.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from ancf_reduced.plates.mesh import PlateMesh
    from ancf_reduced.tire.mesh import Tire
    from ancf_reduced.tire.preset import TirePreset

__all__ = ["preset_from", "tire_from", "tire_values"]


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
