"""A rover's motion with what is drawn of it, ANCF tires included, as a NumPy archive without pickle, for the viewer.

Poses at no more than 181 of the recorded times, in single precision, as quaternions: 150 kB for a rover on brush tires.

Verified by tests/unit/test_workbench_motion_file.py.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contracts.archive import read_archive
from contracts.errors import InputError
from rover_dynamics.flexible.flexible_vehicle import FlexibleMotion
from rover_dynamics.rover.scenarios.scenario import ScenarioRun
from workbench.charts.solids import WORLD, Solid
from workbench.questions.rover.solids import ground_solids, rover_solids

__all__ = ["MOTION", "RecordedMotion", "read_motion", "write_motion"]

FloatArray = NDArray[np.float64]
MOTION = "motion.npz"
_MOST = 181
"""Times that are kept at most: a quarter second apart in the longest scenarios."""
_LARGEST = 500_000_000
"""Bytes of a file's arrays; six ANCF tires over the longest scenario have 20 MB."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RecordedMotion:
    """What is needed to play a motion.

    Attributes
    ----------
    title : of the scenario
    times : (n,) float [s]
    positions, rotations : (n, n_b, 3) [m] and (n, n_b, 3, 3) float, of all bodies, body to world
    vectors : (n, n_w, n_vectors, 3) float, of ANCF tires; n_w = 0 without
    tire : each of these, see `workbench.study.ancf_tire.tire_values`; None without
    up : unit vector against gravity, world
    solids : rover and ground
    """

    title: str
    times: FloatArray
    positions: FloatArray
    rotations: FloatArray
    vectors: FloatArray
    tire: Mapping[str, Any] | None
    up: FloatArray
    solids: tuple[Solid, ...]

    def replayed(self) -> FlexibleMotion:
        """The motion as it is drawn: velocities from the places by differences, no spin, and no forces."""
        n, n_b = self.positions.shape[:2]
        speeds = np.gradient(self.positions, self.times, axis=0)
        return FlexibleMotion(
            times=self.times,
            positions=self.positions,
            rotations=self.rotations,
            velocities=np.concatenate([speeds, np.zeros((n, n_b, 3))], axis=-1),
            tires=np.zeros((n, 0, 0)),
            wrenches=np.zeros((n, 0, 6)),
            efforts=np.zeros((n, 0)),
            steps=0,
            iterations=0,
            rejected=0,
            vectors=self.vectors,
            rates=np.zeros_like(self.vectors),
        )


def write_motion(run: ScenarioRun, path: Path, tire: Mapping[str, Any] | None = None) -> None:
    """Write a run; of wheels on ANCF tires, see `RecordedMotion`, only the hubs are solid."""
    motion, design = run.motion, run.design
    kept = np.unique(np.linspace(0, len(motion.times) - 1, min(_MOST, len(motion.times))).round().astype(np.int64))
    places = run.wheels[..., :2].reshape(-1, 2)
    trodden = np.array([places.min(axis=0) - design.wheel_radius, places.max(axis=0) + design.wheel_radius])
    ground = ground_solids(run.scenario.terrain(design), trodden)
    solids = [*rover_solids(design, tire["preset"]["hub_radius"] if tire else None), *ground]
    turned = Rotation.from_matrix(motion.rotations[kept].reshape(-1, 3, 3)).as_quat(scalar_first=True)
    vectors = motion.vectors[kept] if isinstance(motion, FlexibleMotion) else np.zeros((len(kept), 0, 0, 3))
    arrays: dict[str, Any] = {
        "title": np.array(run.scenario.title),
        "times": motion.times[kept],
        "positions": motion.positions[kept].astype(np.float32),
        "quaternions": turned.reshape(*motion.positions[kept].shape[:2], 4).astype(np.float32),
        "vectors": vectors.astype(np.float32),
        "tire": np.array(json.dumps(tire)),
        "up": -np.array(run.scenario.tilt.gravity(1.0)),
        "bodies": np.array([solid.body for solid in solids]),
    }
    for number, solid in enumerate(solids):
        arrays[f"points{number}"] = solid.points.astype(np.float32)
        arrays[f"quads{number}"] = solid.quads.astype(np.int32)
        arrays[f"colours{number}"] = np.array(solid.colours)
    path.parent.mkdir(parents=True, exist_ok=True)
    np.savez_compressed(path, **arrays)


def read_motion(path: Path) -> RecordedMotion:
    """Read what `write_motion` wrote.

    Raises
    ------
    InputError
        If the file cannot be read or its arrays do not fit together.
    """
    arrays = read_archive(path, "motion file", _LARGEST)
    try:
        return _motion(arrays)
    except (ValueError, KeyError, IndexError, TypeError, OverflowError, RecursionError) as error:
        rule = f"cannot be read ({type(error).__name__}: {str(error)[:80]})"
        raise InputError("motion file", path, rule, "run the report or the scenario again") from error


def _motion(arrays: Mapping[str, NDArray[Any]]) -> RecordedMotion:
    quaternions, positions = arrays["quaternions"].astype(np.float64), arrays["positions"].astype(np.float64)
    n, n_b = positions.shape[:2]
    if quaternions.shape != (n, n_b, 4) or len(arrays["times"]) != n or len(arrays["vectors"]) != n:
        raise ValueError(f"{len(arrays['times'])} times, positions {positions.shape}")
    if arrays["bodies"].min() < WORLD or arrays["bodies"].max() >= n_b:
        raise ValueError(f"solids of bodies that are none of {n_b}")
    vectors, tire = arrays["vectors"].astype(np.float64), json.loads(str(arrays["tire"]))
    if (tire is not None) != bool(vectors.shape[1]):
        raise ValueError(f"vectors of {vectors.shape[1]} ANCF tires, and {'no' if tire is None else 'a'} tire")
    rotations = Rotation.from_quat(quaternions.reshape(-1, 4), scalar_first=True).as_matrix()
    return RecordedMotion(
        title=str(arrays["title"]),
        times=arrays["times"].astype(np.float64),
        positions=positions,
        rotations=rotations.reshape(n, n_b, 3, 3),
        vectors=vectors,
        tire=tire,
        up=arrays["up"].astype(np.float64),
        solids=tuple(_solid(arrays, number) for number in range(len(arrays["bodies"]))),
    )


def _solid(arrays: Mapping[str, NDArray[Any]], number: int) -> Solid:
    colours = arrays[f"colours{number}"]
    points, quads = arrays[f"points{number}"].astype(np.float64), arrays[f"quads{number}"].astype(np.int64)
    if points.shape[1:] != (3,) or quads.shape[1:] != (4,) or not np.isfinite(points).all():
        raise ValueError(f"solid {number} of points {points.shape} and quadrangles {quads.shape}")
    if quads.size and (quads.min() < 0 or quads.max() >= len(points)):  # VTK would look beyond them
        raise ValueError(f"solid {number} has quadrangles on points it has not")
    return Solid(
        body=int(arrays["bodies"][number]),
        points=points,
        quads=quads,
        colours=str(colours) if colours.ndim == 0 else colours.astype(np.uint8),
    )
