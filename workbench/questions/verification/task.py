"""Tasks of the finite elements' verification: benchmarks with known answers, each with a damaged copy as control.

They depend on the solver alone, not on the study, so that every study shares their stored results. Meshes are the
smallest on which tests/verification show the tolerances met. Verified by tests/end_to_end/test_verification.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from reference_fe.material.hyperelastic import MaterialLaw
from reference_fe.problem.static_problem import Discretisation
from reference_fe.verification import half_cylinder, hertz_line, patch, ring_between_plates, sliding_block
from reference_fe.verification.cantilever import THICKNESS, EndLoad, cantilever_path, cantilever_table
from reference_fe.verification.hemisphere import TWENTY_NODES, hemisphere_path, hemisphere_table
from reference_fe.verification.hinged_roof import THICKNESS as ROOF_THICKNESS
from reference_fe.verification.hinged_roof import roof_path, roof_table
from reference_fe.verification.load_path import LoadPath, distance_to_path, limit_loads, relative_error
from reference_fe.verification.manufactured_solution import Convergence, convergence, with_shear_modulus
from reference_fe.verification.pulled_cylinder import THICKNESS as CYLINDER_THICKNESS
from reference_fe.verification.pulled_cylinder import cylinder_path, cylinder_table
from workbench.questions.verification.benchmark_runs import Numbers, Runs, run_with_control

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["run_benchmark"]

_TENTHS = tuple(round(0.1 * k, 10) for k in range(1, 11))
_COARSE = {1: (4, 6, 9), 2: (3, 4, 6)}
_HERTZ_CELLS = (13, 14, 15, 16)
"""Along the contact, which ends 1.625, 1.75, 1.875 and 2 of them from the middle."""


def run_benchmark(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Run ``inputs["benchmark"]`` and its negative control: ``result.json`` with what was measured."""
    return run_with_control(_BENCHMARKS, inputs["benchmark"], out, progress)


def _patch() -> Numbers:
    tension = [patch.uniaxial_tension(law) for law in MaterialLaw]
    return {
        "linear_field_m": patch.linear_field_error(),
        "stress_error": max(found.error for found in tension),
        "rotation_force": patch.rigid_rotation_force(),
        "modes": patch.zero_energy_modes(),
        "iterations": sum(found.iterations for found in tension),
    }


def _manufactured() -> Numbers:
    found = {law.value: {degree: _by_degree(law, degree) for degree in _COARSE} for law in MaterialLaw}
    iterations = sum(c.iterations for by_degree in found.values() for c in by_degree.values())
    errors = {
        law: {
            str(degree): {"cells": c.cells.tolist(), "l2": c.l2.tolist(), "h1": c.h1.tolist(), "orders": c.orders}
            for degree, c in by_degree.items()
        }
        for law, by_degree in found.items()
    }
    return {"laws": errors, "iterations": iterations}


def _by_degree(law: MaterialLaw, degree: int) -> Convergence:
    """Full integration of 8-node cells, the default rule of 27-node ones."""
    points = (2, 2, 2) if degree == 1 else Discretisation().gauss_points
    return convergence(Discretisation(law=law, degree=degree, gauss_points=points), counts=_COARSE[degree])


def _manufactured_damaged() -> float:
    choice = Discretisation(degree=1, gauss_points=(2, 2, 2))
    return convergence(choice, with_shear_modulus(1.25), _COARSE[1]).orders[0]


def _ring() -> Numbers:
    found = ring_between_plates.pressed_ring()
    return {
        "compression": found.compression.tolist(),
        "load": found.load.tolist(),
        "elastica": found.elastica.tolist(),
        "iterations": found.iterations,
    }


def _hertz(cells: Sequence[int] = _HERTZ_CELLS, radius: float = hertz_line.RADIUS) -> Numbers:
    """The mesh that is furthest off; the contact ends at another place within a cell in each."""
    width, pressure = hertz_line.HALF_WIDTH, hertz_line.PEAK_PRESSURE / hertz_line.GENTLE
    gentle = hertz_line.GENTLE * radius, hertz_line.LOAD / hertz_line.GENTLE
    runs = {n: hertz_line.line_contact(gentle[0], cells=(n, 8), load=gentle[1]) for n in cells}
    return {
        "half_width_m": [max((run.half_width for run in runs.values()), key=lambda a: abs(a - width)), width],
        "peak_pressure_Pa": [
            max((run.peak_pressure for run in runs.values()), key=lambda p: abs(p - pressure)),
            pressure,
        ],
        "meshes": {f"{n} x 8 cells": abs(run.half_width / width - 1.0) for n, run in runs.items()},
        "iterations": sum(run.iterations for run in runs.values()),
    }


def _hertz_damaged() -> float:
    found, expected = _hertz(_HERTZ_CELLS[:1], 1.2 * hertz_line.RADIUS)["half_width_m"]
    return float(abs(found / expected - 1.0))


def _block(friction: float = sliding_block.FRICTION) -> Numbers:
    found = sliding_block.dragged_block(friction)
    return {
        "slide_N": [float(found.tangential[-1]), sliding_block.FRICTION * float(found.normal[-1])],
        "stick_N_per_m": [float(found.tangential[2] / found.drag[2]), sliding_block.PENALTY * sliding_block.SIDE**2],
        "iterations": int(found.iterations.sum()),
    }


def _block_damaged() -> float:
    found, expected = _block(0.99 * sliding_block.FRICTION)["slide_N"]
    return float(abs(found / expected - 1.0))


def _half_cylinder() -> Numbers:
    found = half_cylinder.crown_force(half_cylinder.MESHES["s8"])
    return {
        "load": found.load.tolist(),
        "force_N": found.force.tolist(),
        "calculix_N": half_cylinder.calculix("s8").tolist(),
        "felupe_N": half_cylinder.FELUPE["s8"],
        "iterations": found.iterations,
    }


def _half_cylinder_damaged() -> float:
    thickness = 1.001 * half_cylinder.THICKNESS
    found = half_cylinder.crown_force(half_cylinder.MESHES["s8"], loads=(1.0,), thickness=thickness)
    return abs(float(found.force[0]) / half_cylinder.FELUPE["s8"] - 1.0)


def _cantilever(load: EndLoad) -> Numbers:
    table = cantilever_table(load)
    meshes = {f"{n} cells": _full_load_error(cantilever_path(load, n, [1.0]), table) for n in (4, 8, 16)}
    return _path(cantilever_path(load), table) | {"meshes": meshes}


def _cantilever_damaged(load: EndLoad) -> float:
    path = cantilever_path(load, targets=[0.25, 1.0], thickness=1.02 * THICKNESS)
    return float(np.abs(relative_error(path, cantilever_table(load))).max())


def _hemisphere() -> Numbers:
    table, meshes = hemisphere_table(), {}
    for nodes, choice, ratio in ((20, TWENTY_NODES, 1), (27, Discretisation(), 2)):
        for n in (8, 12, 16):
            error = _full_load_error(hemisphere_path((n, ratio * n), choice, (1.0,)), table)
            meshes[f"{n} x {ratio * n} of {nodes} nodes"] = error
    return _path(hemisphere_path((16, 16), TWENTY_NODES, _TENTHS), table) | {"meshes": meshes}


def _hemisphere_damaged() -> float:
    choice = Discretisation(family=TWENTY_NODES.family, gauss_points=(3, 3, 3))
    path = hemisphere_path((16, 16), choice, (0.5, 1.0))
    return float(np.abs(relative_error(path, hemisphere_table())).max())


def _roof() -> Numbers:
    path, table = roof_path(), roof_table()
    peak, trough = map(float, limit_loads(path))
    limits = {"peak": [peak, _first_peak(table)], "trough": [trough, float(table[:, 0].min())]}
    meshes = {f"{n} x {n} cells": float(distance_to_path(roof_path((n, n)), table).max()) for n in (4, 6)}
    return _followed(path, table) | limits | {"meshes": meshes}


def _first_peak(table: np.ndarray) -> float:
    """Load before it first falls."""
    return float(table[np.argmax(np.diff(table[:, 0]) < 0.0), 0])


def _roof_damaged() -> float:
    """By how much a roof 2 % thicker misses the peak."""
    peak = limit_loads(roof_path((6, 6), thickness=1.02 * ROOF_THICKNESS))[0]
    return abs(float(peak) / _first_peak(roof_table()) - 1.0)


def _cylinder() -> Numbers:
    path, table = cylinder_path(), cylinder_table()
    worst = int(np.argmax(np.abs(path.deflection[-1] / table[-1, 1:] - 1.0)))
    full = [float(path.deflection[-1, worst]), float(table[-1, 1 + worst])]
    return _followed(path, table) | {"full": full, "free_side": _free_side(path)}


def _free_side(path: LoadPath) -> float:
    """Distance of B and C, whose form changes in the snap; A is under the force, where the mesh counts most."""
    return float(distance_to_path(path, cylinder_table())[:, 1:].max())


def _cylinder_damaged() -> float:
    return _free_side(cylinder_path(thickness=1.02 * CYLINDER_THICKNESS))


def _followed(path: LoadPath, table: np.ndarray) -> Numbers:
    return {
        "load": path.load.tolist(),
        "deflection": path.deflection.tolist(),
        "table": table.tolist(),
        "distance": float(distance_to_path(path, table).max()),
        "iterations": path.iterations,
    }


def _full_load_error(path: LoadPath, table: np.ndarray) -> float:
    """Difference of the displacement that is further off at full load."""
    return float(np.abs(relative_error(path, table)[-1]).max())


def _path(path: LoadPath, table: np.ndarray) -> Numbers:
    error = np.abs(relative_error(path, table))
    worst = int(np.argmax(error[-1]))
    return {
        "load": path.load.tolist(),
        "deflection": path.deflection.tolist(),
        "table": table.tolist(),
        "full": [float(path.deflection[-1, worst]), float(table[-1, 1 + worst])],
        "path_error": float(error.max()),
        "iterations": path.iterations,
    }


_BENCHMARKS: Runs = {
    "patch": (_patch, lambda: float(patch.zero_energy_modes((2, 2, 2)))),
    "manufactured": (_manufactured, _manufactured_damaged),
    "end_shear": (lambda: _cantilever("shear"), lambda: _cantilever_damaged("shear")),
    "end_moment": (lambda: _cantilever("moment"), lambda: _cantilever_damaged("moment")),
    "hemisphere": (_hemisphere, _hemisphere_damaged),
    "hinged_roof": (_roof, _roof_damaged),
    "pulled_cylinder": (_cylinder, _cylinder_damaged),
    "half_cylinder": (_half_cylinder, _half_cylinder_damaged),
    "ring": (_ring, lambda: ring_between_plates.pressed_ring(thickness=1.01 * ring_between_plates.THICKNESS).error),
    "hertz": (_hertz, _hertz_damaged),
    "sliding_block": (_block, _block_damaged),
}
