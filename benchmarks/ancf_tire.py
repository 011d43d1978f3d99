"""Speed of the ANCF plate loops: force, tangent and contact of the 8-plate tire, larger meshes, the arithmetic limit.

``make bench NAME=ancf_tire`` prints the table and writes ``build/bench/ancf_tire.json``; with ``ARGS=--record`` the
run is kept for the report, whose aims are in ``workbench/questions/speed/aims.py``. Each number is the shortest of many
short runs, processor time of one thread, calls from Python included. No other code with this element is on the package
registries, so there is no peer in the run. The arithmetic limit is the loop's own floating point operations over this
core's measured rate of multiply-adds in vector registers.
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from ancf_reduced.contact.law import ContactLaw  # noqa: E402
from ancf_reduced.contact.plate_contact import PlateContact  # noqa: E402
from ancf_reduced.plates.mesh import build_plate_mesh, flat_patch  # noqa: E402
from ancf_reduced.plates.model import PlateModel, build_plate_model  # noqa: E402
from ancf_reduced.tire.mesh import build_tire  # noqa: E402
from ancf_reduced.tire.preset import thesis_preset  # noqa: E402
from ancf_reduced.tire.static import solve_tire  # noqa: E402
from benchmarks.ancf_rows.clock import multiply_add_rate, row, shortest  # noqa: E402
from benchmarks.ancf_rows.motion import QUADRATURE, motion_rows, six_wheels_rows  # noqa: E402
from benchmarks.output.run import Run, add_option  # noqa: E402
from contracts.height_field import sampled_terrain  # noqa: E402
from contracts.terrain import Plane, Terrain  # noqa: E402
from contracts.terrain_ridges import HalfRound, Sinusoid  # noqa: E402
from workbench.questions.speed.aims import ARITHMETIC, CURVES, FORCE, FORCE_AND_TANGENT, TIRE  # noqa: E402

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
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_option(parser)
    options, run = parser.parse_args(), Run("ancf_tire")
    rows = [*tire_rows(), *contact_rows(), curves_row(), *motion_rows(), *six_wheels_rows(), *mesh_rows()]
    for r in rows:
        print(f"{r['case']:<56}{r['metric']:<46}{r['ours']:>10.3g} {r['unit']}")
    for path in run.write(rows, keep=options.record):
        print(f"written: {path}")


def tire_rows() -> list[dict[str, object]]:
    """The thesis' tire with 4 x 4 x 2 points."""
    model = build_tire(replace(thesis_preset(), quadrature=QUADRATURE)).model
    force, tangent, damping = times(model)
    plates, points = len(model.mesh.elements), int(np.prod(QUADRATURE))
    rate, case = multiply_add_rate(), TIRE
    limit_force = 1e6 * plates * points * FORCE_FLOPS_POINT / rate
    limit_tangent = 1e6 * points * TANGENT_FLOPS_POINT / rate
    return [
        row(case, FORCE, "us", force),
        row(case, "damping force", "us", damping),
        row(case, FORCE_AND_TANGENT, "us", (force + tangent) / plates),
        row(case, "arithmetic of the force at this core's rate", "us", limit_force),
        row(case, ARITHMETIC["force"], "-", force / limit_force),
        row(case, "arithmetic of the tangent of a plate", "us", limit_tangent),
        row(case, ARITHMETIC["tangent"], "-", tangent / plates / limit_tangent),
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
    return row(TIRE, CURVES, "s", spent)


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


if __name__ == "__main__":
    main()
