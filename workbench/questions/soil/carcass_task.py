"""Task: how the rim of a wheel gives way, from its shapes on rigid ground at one load, all orientations together.

Verified by tests/unit/test_workbench_soil.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.wheel.mesh import build_ancf_wheel
from contracts.archive import read_archive
from contracts.curves import StiffnessCurve, read_curve
from geometry.wheel import WheelDesign
from soil.carcass import carcass_from_shapes
from workbench.execution.result_files import read_result, write_result
from workbench.questions.ancf_wheel.task import STATES
from workbench.questions.model_curves import CURVE
from workbench.questions.wheel.mesh_file import MESH, read_mesh
from workbench.study.wheel_design import design_from

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["find"]

FloatArray = NDArray[np.float64]
_LARGEST = 1_000_000_000
"""Bytes of the states along one curve."""
_LOADS = 16
"""Points of the mean curve."""
_ON = 2e-5
"""Distance from the rim's radius within which a node lies on it [m]."""


def find(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``result.json``: compliance by harmonics [m/N], mean load [N], deflection on rigid ground [m]; returns shapes.

    Needs the mesh of the solid model, and the curves with their shapes. Curves that end before the load do not count;
    where none is left the rim counts as rigid, and the source says so.
    """
    design = design_from(inputs["wheel"])
    shapes = _of_plates if inputs["model"] == "ancf_wheel" else _of_the_solid
    found = shapes(inputs, design, needs)
    if not found:
        source = f"rigid: no curve reaches {inputs['load']:g} N"
        write_result(out, {"compliance": [], "curve": [], "load_N": 0.0, "deflection_m": 0.0, "source": source})
        return 0
    load = float(np.mean([one[0] for one in found]))
    words = {"fe": "the solid model", "ancf_wheel": "the ANCF wheel"}[inputs["model"]]
    source = f"{words} on rigid ground under {load:.0f} N at {len(found)} orientations"
    carcass = carcass_from_shapes([one[1:] for one in found], load, source)
    curves = [read_curve(needs[name] / CURVE) for _, name in inputs["curves"]]
    told = [curve for curve in curves if len(curve.load) > 1 and curve.load[-1] >= 0.9 * load]
    write_result(
        out,
        {
            "model": inputs["model"],
            "compliance": list(carcass.compliance),
            "curve": _mean_curve(told),
            "load_N": load,
            "deflection_m": load * carcass.deflection_per_load,
            "source": source,
        },
    )
    progress(1.0)
    return len(found)


def _mean_curve(curves: Sequence[StiffnessCurve]) -> list[tuple[float, float]]:
    """Loads [N] up to where every curve goes, and the mean deflections there [m]."""
    loads = np.linspace(0.0, min(float(curve.load[-1]) for curve in curves), _LOADS + 1)[1:]
    return [(float(load), float(np.mean([curve.deflection_at(load) for curve in curves]))) for load in loads]


def _of_the_solid(
    inputs: Mapping[str, Any], design: WheelDesign, needs: Mapping[str, Path]
) -> list[tuple[float, FloatArray, FloatArray]]:
    """Load, angles and ways towards the hub, of each curve."""
    mesh, radius, found = read_mesh(needs["mesh"] / MESH), design.ground_radius, []
    on_rim = np.flatnonzero(np.abs(np.hypot(mesh.points[:, 0], mesh.points[:, 2]) - radius) < _ON)
    for orientation, name in inputs["curves"]:
        snapshots = read_result(needs[name])["snapshots"]
        kept = needs[name] / f"fields_{inputs['load']:.0f}N.npz"
        if not snapshots or not kept.is_file():
            continue
        with np.load(kept, allow_pickle=False) as fields:
            moved = fields["displacement"][on_rim]
        near = min(snapshots, key=lambda one: abs(one["load_N"] - inputs["load"]))
        found.append((near["load_N"], *_shape(mesh.points[on_rim], moved, math.radians(orientation), radius)))
    return found


def _of_plates(
    inputs: Mapping[str, Any], design: WheelDesign, needs: Mapping[str, Path]
) -> list[tuple[float, FloatArray, FloatArray]]:
    """The same by the nodes of the plates of the rim, at the state nearest to the load."""
    wheel = build_ancf_wheel(design, **inputs["options"])
    nodes = np.unique(wheel.plates.plates[wheel.parts == "tire"])
    places = wheel.plates.reference[nodes, 0]
    radius, found = float(np.hypot(places[:, 0], places[:, 2]).mean()), []
    for orientation, name in inputs["curves"]:
        curve = read_curve(needs[name] / CURVE)
        if curve.load[-1] < 0.9 * inputs["load"]:
            continue
        states = read_archive(needs[name] / STATES, "states", _LARGEST, ("deflection", "free"))
        number = int(np.argmin(np.abs(curve.load - inputs["load"])))
        moved = wheel.coordinates(states["free"][number])[nodes, 0] - places
        found.append((float(curve.load[number]), *_shape(places, moved, math.radians(orientation), radius)))
    return found


def _shape(places: FloatArray, moved: FloatArray, orientation: float, radius: float) -> tuple[FloatArray, FloatArray]:
    """Angles from the ground's direction [rad] and ways towards the hub [m], the mean of what lies side by side."""
    down = np.array([math.sin(orientation), 0.0, -math.cos(orientation)])
    ahead = np.array([math.cos(orientation), 0.0, math.sin(orientation)])
    at_rest = np.round(np.arctan2(places @ ahead, places @ down), 5)
    now = places + moved
    angle, way = np.arctan2(now @ ahead, now @ down), radius - np.hypot(now[:, 0], now[:, 2])
    _, row = np.unique(at_rest, return_inverse=True)
    count = np.bincount(row)
    turned = np.bincount(row, np.mod(angle - at_rest + np.pi, 2.0 * np.pi) - np.pi) / count
    return np.unique(at_rest) + turned, np.bincount(row, way) / count
