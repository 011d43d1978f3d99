"""A folder as ``workbench report`` leaves it, small and made up: a ring under load, a rover that rolls straight on.

The numbers are no physics; the viewer shows what files hold.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from contracts.curves import StiffnessCurve, write_curve
from contracts.mesh import TaggedMesh
from contracts.series import TimeSeries, write_series
from reference_fe.wheel.case import FieldSnapshot
from rover_dynamics.rover.rover import build_rover
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import scenario_named
from rover_dynamics.rover.scenarios.scenario import ScenarioRun
from rover_dynamics.vehicle.vehicle import VehicleMotion
from workbench.questions.fe.field_file import write_fields, write_points, write_shapes
from workbench.questions.fe.parts_file import PARTS_FILE, parts_text
from workbench.questions.rover.motion_file import write_motion

LOADS = (100.0, 200.0)
POINTS = (25.0, 50.0, 75.0, 100.0, 125.0, 150.0, 175.0, 200.0)
"""Loads of the curve at 0 degrees, whose fields are kept."""
ORIENTATIONS = (0, 30)
PRINCIPAL = np.array([0.5, 0.0, -1.5])
"""Principal stresses over half the von Mises stress, which is made up as well."""


STRENGTHS = {"hub": 250e6, "tire": 355e6}
"""Yield strength of the parts [Pa]."""


def ring_mesh(sides: int = 48) -> TaggedMesh:
    """Half of a ring about y, 0.1 to 0.14 m in radius, of 8-node hexahedra: two parts, inside 1 and outside 2."""
    angles, radii, widths = 2.0 * np.pi * np.arange(sides) / sides, np.array([0.1, 0.12, 0.14]), np.array([0.0, 0.05])
    a, r, y = np.meshgrid(angles, radii, widths, indexing="ij")
    points = np.stack([r * np.cos(a), y, r * np.sin(a)], axis=-1).reshape(-1, 3)
    number = np.arange(len(points)).reshape(a.shape)
    ahead = np.roll(number, -1, axis=0)
    cells, tags = [], []
    for k in range(2):
        lower, upper = number[:, k], number[:, k + 1]
        next_lower, next_upper = ahead[:, k], ahead[:, k + 1]
        near = [lower[:, 0], next_lower[:, 0], next_upper[:, 0], upper[:, 0]]
        far = [lower[:, 1], next_lower[:, 1], next_upper[:, 1], upper[:, 1]]
        cells.append(np.stack([*near, *far], axis=-1))
        tags.append(np.full(sides, k + 1))
    none = np.zeros((0, 4), dtype=np.int64)
    return TaggedMesh(
        points=points,
        cells=np.concatenate(cells),
        cell_tags=np.concatenate(tags).astype(np.int32),
        facets=none,
        facet_tags=np.zeros(0, dtype=np.int32),
        parts={"hub": 1, "tire": 2},
        faces={},
    )


def rolling_run(frames: int = 40) -> ScenarioRun:
    """A rover that moves on by 0.5 m in 4 s with its joints fixed."""
    design, scenario = read_rover(), scenario_named("straight")
    bodies = build_rover(design, height=-design.wheel_radius).model.bodies
    times = np.linspace(0.0, 4.0, frames)
    positions = np.tile(np.array([body.position for body in bodies]), (frames, 1, 1))
    positions[:, :, 0] += 0.125 * times[:, None]
    n, n_b = frames, len(bodies)
    motion = VehicleMotion(
        times=times,
        positions=positions,
        rotations=np.tile(np.array([body.rotation for body in bodies]), (frames, 1, 1, 1)),
        velocities=np.zeros((n, n_b, 6)),
        tires=np.zeros((n, 6, 10)),
        wrenches=np.zeros((n, 6, 6)),
        efforts=np.zeros((n, 0)),
        steps=n,
        iterations=n,
        rejected=0,
    )
    return ScenarioRun(scenario=scenario, design=design, motion=motion)


def write_small_modes(folder: Path) -> None:
    """``modes``: a turn about the axle, even, and a shift along it, odd, of half a wheel; of the whole a plate."""
    folder.mkdir()
    mesh = ring_mesh()
    turn = np.cross((0.0, 1.0, 0.0), mesh.points)
    shift = np.tile([0.0, 1.0, 0.0], (len(mesh.points), 1))
    write_shapes(mesh.points, mesh.cells, np.array([turn, shift]), folder / "modes_fe_held.vtu")
    head = "mode,frequency_Hz,growth_1_s,kind,waves,part,part_share,parity\n"
    table = f"{head}1,18.54,0,torsional,0,tire,0.7,1\n2,32.2,0,lateral,0,tire,0.6,-1\n"
    (folder / "modes_fe_held.csv").write_text(table, encoding="utf-8")
    corners = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])
    stem, up = folder / "modes_ancf_wheel_standing_phi030_200N", np.array([np.eye(4, 3)[:, [1, 2, 0]]])
    write_shapes(corners, np.arange(4)[None], up, stem.with_name(f"{stem.name}.vtu"))
    stem.with_name(f"{stem.name}.csv").write_text(f"{head}1,0,12.5,radial,2,tire,0.7,0\n", encoding="utf-8")


def write_small_report(folder: Path) -> None:
    """``curves``, ``fields``, ``series``, ``motions`` and ``modes``; ``summary.json``."""
    for name in ("curves", "fields"):
        (folder / name).mkdir(parents=True)
    (folder / "summary.json").write_text('{"study": "small", "status": "pass"}', encoding="utf-8")
    mesh, deflection = ring_mesh(), np.linspace(0.0, 0.03, 7)
    for orientation in ORIENTATIONS:
        phi, load = np.radians(orientation), (8000.0 + 20.0 * orientation) * deflection
        largest = {f"max_von_mises_{part}_Pa": 1e6 * load for part in ("hub", "tire")}
        curve = StiffnessCurve(
            model="fe", orientation_deg=float(orientation), deflection=deflection, load=load, columns=largest
        )
        write_curve(curve, folder / "curves" / f"fe_phi{orientation:03d}.csv")
        ground = np.array([np.sin(phi), 0.0, -np.cos(phi)])
        share = np.clip(mesh.points @ ground / 0.14, 0.0, 1.0)
        fields = {
            newtons: FieldSnapshot(
                load=newtons,
                deflection=newtons / 8000.0,
                displacement=-1e-4 * newtons * share[:, None] * ground,
                von_mises=2e6 * newtons * share,
                principal_stress=1e6 * newtons * share[:, None] * PRINCIPAL,
            )
            for newtons in {*LOADS, *POINTS}
        }
        stem = f"fe_phi{orientation:03d}"
        for newtons in LOADS:
            one = fields[newtons]
            path = folder / "fields" / f"{stem}_{newtons:.0f}N.vtu"
            write_fields(mesh, one.displacement, one.von_mises, path, one.principal_stress)
        if orientation == 0:
            write_points([fields[newtons] for newtons in POINTS], folder / "fields" / f"{stem}_points.npz")
    (folder / "fields" / PARTS_FILE).write_text(parts_text(STRENGTHS), encoding="utf-8")
    average = StiffnessCurve(
        model="fe", orientation_deg=None, deflection=deflection, load=8300.0 * deflection, columns={}
    )
    write_curve(average, folder / "curves" / "fe_average.csv")
    write_small_modes(folder / "modes")
    run = rolling_run()
    write_motion(run, folder / "motions" / "straight_brush.npz")
    times = run.motion.times
    loads = {f"{leg.name}_load_N": 198.0 + k * np.sin(times) for k, leg in enumerate(run.design.legs)}
    series = TimeSeries(scenario="straight", tire="brush", time=times, columns=loads)
    write_series(series, folder / "series" / "straight_brush.csv")
