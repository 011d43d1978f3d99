"""Speed of the ANCF plate loops: force, tangent and contact of the 8-plate tire, larger meshes, the arithmetic limit.

``make bench NAME=ancf_tire`` prints the table and writes ``build/bench/ancf_tire.json``. Each number is the shortest of
many short runs on one core, calls from Python included. No other code with this element is on the package registries,
so there is no peer in the run; for scale, Project Chrono's same plate, built from source on such a machine, needs 2.3
microseconds a plate for the force and 94 for force with tangent (issue text of this project). The arithmetic limit is
the loop's own floating point operations over this core's measured rate of multiply-adds in vector registers.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numba
import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from ancf_reduced.contact_grid import build_contact_grid  # noqa: E402
from ancf_reduced.contact_law import ContactLaw  # noqa: E402
from ancf_reduced.explicit_dynamics import MotionState, integrate_explicit  # noqa: E402
from ancf_reduced.plate_contact import PlateContact  # noqa: E402
from ancf_reduced.plate_mesh import build_plate_mesh, flat_patch, join_meshes  # noqa: E402
from ancf_reduced.plate_model import PlateModel, build_plate_model  # noqa: E402
from ancf_reduced.plate_system import HubMass, PlateSystem, build_plate_system  # noqa: E402
from ancf_reduced.spectrum import stable_step  # noqa: E402
from ancf_reduced.static_tire import solve_tire  # noqa: E402
from ancf_reduced.tire_mesh import RIM, Tire, build_tire  # noqa: E402
from ancf_reduced.tire_preset import thesis_preset  # noqa: E402
from ancf_reduced.vector_coordinates import side_by_side, with_reference_node  # noqa: E402
from ancf_reduced.wheel_rig import MARS_GRAVITY, wheel_rig  # noqa: E402
from contracts.height_field import sampled_terrain  # noqa: E402
from contracts.terrain import Plane, Terrain  # noqa: E402
from contracts.terrain_ridges import HalfRound, Sinusoid  # noqa: E402

OUT = ROOT / "build" / "bench" / "ancf_tire.json"
QUADRATURE = (4, 4, 2)
TARGETS = {"force": 18.0, "tangent": 40.0, "statics": 5.0, "real time": 5.0}
"""Microseconds for the force of the whole 8-plate tire, and for force with tangent of one plate; seconds for curves;
seconds of motion computed in a second.
"""
DAMPING_RATIOS = (0.0, 0.02, 0.05)
"""Of the first mode. The highest modes are damped more in proportion to their frequency, which shortens the step."""
WAVES = Sinusoid(amplitude=0.01, wavelength=0.2, yaw=0.3, base=-0.1375)
GRID_LINES = np.linspace(-0.5, 0.5, 101)
CONTACT_TERRAIN: dict[str, Terrain] = {
    "in the air": Plane(offset=-0.2),
    "plane, 5 mm deep": Plane(offset=-0.1375),
    "half-round of 20 mm": HalfRound(radius=0.02, position=0.05, base=-0.1375),
    "waves": WAVES,
    "height field": sampled_terrain(WAVES, GRID_LINES, GRID_LINES),
}
MESHES = (8, 50, 400, 3000)
FORCE_FLOPS_POINT = 2 * (2 * 16 * 6 + 2 * 4 * 3 + 90)
"""Multiply-adds, each two, at a point: base vectors and forces of 16 functions, strain and stress."""
TANGENT_FLOPS_POINT = 2 * (81 * 7 + 48 * 9 * 2 + (16 * 17 // 2) * 9 * 2)
"""Of the point's 81 stiffnesses, their rows for 48 coordinates, and 136 pairs of functions."""


def main() -> None:
    """Measure, print, write."""
    rows = [*tire_rows(), *contact_rows(), curves_row(), *motion_rows(), *six_wheels_rows(), *mesh_rows()]
    OUT.parent.mkdir(parents=True, exist_ok=True)
    OUT.write_text(json.dumps({"schema": 1, "name": "ancf_tire", "rows": rows}, indent=1) + "\n", encoding="utf-8")
    for r in rows:
        print(f"{r['case']:<24}{r['metric']:<62}{r['ours']:>10.3g} {r['unit']}")


def row(case: str, metric: str, unit: str, ours: float) -> dict[str, object]:
    """One line of the table; there is no peer."""
    return {"case": case, "metric": metric, "unit": unit, "ours": ours, "peer": None, "ratio": None}


def tire_rows() -> list[dict[str, object]]:
    """The thesis' tire with 4 x 4 x 2 points."""
    model = build_tire(replace(thesis_preset(), quadrature=QUADRATURE)).model
    force, tangent, damping = times(model)
    plates, points = len(model.mesh.elements), int(np.prod(QUADRATURE))
    rate, case = multiply_add_rate(), "8-plate tire"
    limit_force = 1e6 * plates * points * FORCE_FLOPS_POINT / rate
    limit_tangent = 1e6 * points * TANGENT_FLOPS_POINT / rate
    return [
        row(case, f"force (target {TARGETS['force']:g})", "us", force),
        row(case, "damping force", "us", damping),
        row(case, f"force with tangent, a plate (target {TARGETS['tangent']:g})", "us", (force + tangent) / plates),
        row(case, "arithmetic of the force at this core's rate", "us", limit_force),
        row(case, "force over its arithmetic", "-", force / limit_force),
        row(case, "arithmetic of the tangent of a plate", "us", limit_tangent),
        row(case, "tangent of a plate over its arithmetic", "-", tangent / plates / limit_tangent),
        row("this core", "multiply-adds in vector registers", "Gflop/s", 1e-9 * rate),
    ]


def curves_row() -> dict[str, object]:
    """Stiffness curves of the thesis' tire at 36 orientations, 35 loads each."""
    tire, deflections = build_tire(thesis_preset()), 1e-3 * np.arange(1, 36)
    solve_tire(tire, 0.0, deflections[:2])
    begun = time.process_time()
    for orientation in range(36):
        solve_tire(tire, np.deg2rad(10.0 * orientation), deflections)
    spent = time.process_time() - begun
    metric = f"36 curves of 35 loads, processor time (target {TARGETS['statics']:g})"
    return row("8-plate tire", metric, "s", spent)


def contact_rows() -> list[dict[str, object]]:
    """Contact of the same tire's four rim plates, 100 points each, with friction and damping; see `CONTACT_TERRAIN`."""
    tire = build_tire(replace(thesis_preset(), quadrature=QUADRATURE))
    law = ContactLaw(stiffness=1000.0, damping=5.0, damping_depth=1e-3, friction=0.6)
    p = tire.mesh.reference_coordinates()
    v, force, tangents = 0.01 * p, np.empty_like(p), np.empty((2, len(tire.mesh.elements), 48, 48))
    rows = []
    for case, terrain in CONTACT_TERRAIN.items():
        contact = PlateContact(grid=tire.grid, terrain=terrain.pieces(), law=law)
        touching = len(contact.patch(p, v).points)
        rows += [
            row(
                case,
                f"contact force, {touching} points touch",
                "us",
                shortest(lambda c=contact: c.force(p, v, out=force)),
            ),
            row(case, "contact tangents", "us", shortest(lambda c=contact: c.tangents(p, v, out=tangents))),
        ]
    return rows


def motion_rows() -> list[dict[str, object]]:
    """The thesis' tire with 25 kg on its hub, standing on level ground: explicit steps of the longest stable length."""
    rows, seconds = [], 0.2
    preset = replace(thesis_preset(), quadrature=QUADRATURE)
    for ratio in DAMPING_RATIOS:
        hub = HubMass(mass=25.0, inertia=0.1 * np.eye(3))
        rig = wheel_rig(build_tire(preset), Plane(), hub=hub, damping_ratio=ratio)
        start = rig.start(np.array([0.0, 0.0, preset.outer_radius - 0.01]), np.zeros(3))
        step, end = stable_step(rig.system, start.z), np.array([seconds])
        spent = shortest(lambda r=rig, s=start, e=end, h=step: list(integrate_explicit(r.system, s, e, h)))  # type: ignore[misc]
        case = f"wheel, damping {ratio:g}"
        rows += [
            row(case, "longest stable step", "ms", 1e3 * step),
            row(case, "one step", "us", spent * step / seconds),
            row(case, f"faster than real time (target {TARGETS['real time']:g})", "-", 1e6 * seconds / spent),
        ]
    return rows


def six_wheels_rows() -> list[dict[str, object]]:
    """Six of these wheels as one mesh against one: all forces on the system, and one explicit step."""
    tire, seconds = build_tire(replace(thesis_preset(), quadrature=QUADRATURE)), 0.05
    times_us, steps_us = [], []
    for wheels in (1, 6):
        system, start = wheels_on_the_ground(tire, wheels)
        step, end = stable_step(system, start.z), np.array([seconds])
        times_us.append(shortest(lambda s=system, b=start: s.force(b.z, b.v)))  # type: ignore[misc]
        spent = shortest(lambda s=system, b=start, e=end, h=step: list(integrate_explicit(s, b, e, h)))  # type: ignore[misc]
        steps_us.append(spent * step / seconds)
    case = "six wheels, one mesh"
    return [
        row(case, "all forces", "us", times_us[1]),
        row(case, "all forces, over those of one wheel", "-", times_us[1] / times_us[0]),
        row(case, "one step", "us", steps_us[1]),
        row(case, "one step, over that of one wheel", "-", steps_us[1] / steps_us[0]),
    ]


def wheels_on_the_ground(tire: Tire, wheels: int) -> tuple[PlateSystem, MotionState]:
    """Wheels of 25 kg in one mesh, 10 mm deep in level ground, half a metre apart."""
    mesh = join_meshes([tire.mesh] * wheels)
    preset = tire.preset
    model = build_plate_model(
        mesh,
        young_modulus=preset.young_modulus,
        poisson_ratio=preset.poisson_ratio,
        density=preset.density,
        quadrature=preset.quadrature,
    )
    grid = build_contact_grid(mesh, mesh.plates_of(RIM), preset.contact_points, preset.contact_layout)
    contact = PlateContact(grid=grid, terrain=Plane().pieces(), law=ContactLaw(stiffness=preset.contact_stiffness))
    system = build_plate_system(
        model,
        side_by_side([with_reference_node(tire.tie)] * wheels),
        gravity=np.array([0.0, 0.0, -MARS_GRAVITY]),
        hubs=(HubMass(mass=25.0, inertia=0.1 * np.eye(3)),) * wheels,
        external=(contact,),
    )
    z = system.reference()
    rows = system.coordinates.position_rows.reshape(wheels, -1)
    for k in range(wheels):
        z[rows[k]] += [0.5 * k, 0.0, preset.outer_radius - 0.01]
    return system, MotionState(time=0.0, z=z, v=np.zeros_like(z))


def mesh_rows() -> list[dict[str, object]]:
    """Cost of a plate as the mesh grows."""
    rows = []
    for plates in MESHES:
        patches = [
            flat_patch(np.array([0.1 * i, 0, 0]), np.array([0.1, 0, 0]), np.array([0, 0.1, 0]), 0.01, "strip")
            for i in range(plates)
        ]
        model = build_plate_model(
            build_plate_mesh(patches), young_modulus=1e6, poisson_ratio=0.3, density=1.0, quadrature=QUADRATURE
        )
        force, tangent, _ = times(model)
        rows += [
            row(f"{plates} plates", "force, a plate", "us", force / plates),
            row(f"{plates} plates", "tangent, a plate", "us", tangent / plates),
        ]
    return rows


def times(model: PlateModel) -> tuple[float, float, float]:
    """Force, tangents and damping force of a whole mesh [us]."""
    model = replace(model, viscosity=(1.0, 1.0))
    p = model.mesh.reference_coordinates()
    p += 1e-3 * np.random.default_rng(1).normal(size=p.shape)
    rates, force = 0.1 * p, np.empty_like(p)
    tangents = np.empty((len(model.mesh.elements), 48, 48))
    return (
        shortest(lambda: model.elastic_force(p, force)),
        shortest(lambda: model.elastic_tangents(p, tangents)),
        shortest(lambda: model.damping_force(p, rates, force)),
    )


def shortest(call: Callable[[], object], budget_s: float = 2.0) -> float:
    """Shortest time of a call in bursts of about a millisecond [us]."""
    call()
    begun = time.perf_counter()
    call()
    burst = max(1, int(1e-3 / (time.perf_counter() - begun)))
    best, end = float("inf"), time.perf_counter() + budget_s
    while time.perf_counter() < end:
        begun = time.perf_counter()
        for _ in range(burst):
            call()
        best = min(best, (time.perf_counter() - begun) / burst)
    return 1e6 * best


@numba.njit(fastmath=True)
def _multiply_add(a: NDArray[np.float64], rounds: int) -> float:
    """Eight chains of eight lanes each, in registers: 2 * 64 * rounds operations."""
    x = a.copy()
    for _ in range(rounds):
        for k in range(64):
            x[k] = x[k] * 0.999999 + 1e-7
    return float(x.sum())


def multiply_add_rate() -> float:
    """Floating point operations a second of one core that does nothing but multiply and add."""
    a, rounds = np.ones(64), 20000
    return 2.0 * 64.0 * rounds / (1e-6 * shortest(lambda: _multiply_add(a, rounds)))


if __name__ == "__main__":
    main()
