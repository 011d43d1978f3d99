"""The ANCF wheel beside the solid model: cost of a curve at equal error, growth with plates.

``make bench NAME=ancf_wheel`` runs all of it, some twenty minutes; ``ARGS="--only cost"`` a part: cost (a curve by both
models, several meshes, and by CalculiX' C3D20R on the study's mesh where ``ccx`` is installed), growth (plates to
10 000), arithmetic (force and tangent of a plate), motion (rolling, dropped, over a half-round). Prints a table and
writes build/bench/ancf_wheel.json; README.md here has the last measured one. Times are processor seconds of one thread,
building included, compilation not; memory is the largest resident set of the process. Errors of the cost table are
against the solid model with cells half as long.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT)]

from ancf_reduced.wheel.mesh import build_ancf_wheel  # noqa: E402
from ancf_reduced.wheel.static import WheelOnGround, press  # noqa: E402
from ancf_reduced.wheel_motion.friction import Friction  # noqa: E402
from ancf_reduced.wheel_motion.rest import above, standing  # noqa: E402
from ancf_reduced.wheel_motion.rolling import Hub, RollingWheel  # noqa: E402
from ancf_reduced.wheel_motion.travel import Account, TravelSettings, travel  # noqa: E402
from benchmarks.ancf_rows.clock import multiply_add_rate, row, shortest  # noqa: E402
from benchmarks.output.run import Run, add_option  # noqa: E402
from benchmarks.peer_codes import calculix  # noqa: E402
from contracts.curves import read_curve  # noqa: E402
from contracts.terrain import Plane, TerrainUnion  # noqa: E402
from contracts.terrain_ridges import HalfRound  # noqa: E402
from geometry.inp import TWENTY_NODES  # noqa: E402
from geometry.wheel import exomars  # noqa: E402
from workbench.questions.fe.graph import fe_inputs, without_end  # noqa: E402
from workbench.questions.fe.task import solve_orientation  # noqa: E402
from workbench.questions.model_curves import CURVE  # noqa: E402
from workbench.questions.wheel.graph import mesh_task  # noqa: E402
from workbench.questions.wheel.mesh_file import MESH, read_mesh  # noqa: E402
from workbench.questions.wheel.mesh_task import build  # noqa: E402
from workbench.study.reading import built_in_study, read_study  # noqa: E402

DEFLECTIONS = [5e-3 * k for k in range(1, 9)]
ORIENTATION = 15.0
SOLIDS = (0.5, 1.0, 1.4)
"""Length of the solid's cells against the study's; the first is what errors are measured by."""
PLATES = ((16e-3, 18e-3), (24e-3, 36e-3), (8e-3, 18e-3))
GROWTH = (1.0, 2.0, 3.0, 4.0)
Rows = list[dict[str, object]]


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=PARTS, help="one part of it")
    parser.add_argument("--child", help=argparse.SUPPRESS)
    add_option(parser)
    options = parser.parse_args()
    if options.child:
        print(json.dumps(child(json.loads(options.child))))
        return
    run, rows = Run("ancf_wheel"), Rows()
    for name, part in PARTS.items():
        if options.only in (None, name):
            for one in part():
                print(f"{one['case']!s:<44}{one['metric']!s:<52}{one['ours']:>10.4g} {one['unit']}", flush=True)
                rows.append(one)
    for path in run.write(rows, keep=options.record):
        print(f"written: {path}")


def cost() -> Iterator[dict[str, object]]:
    """One curve by both models."""
    child_run({"plates": PLATES[0], "deflections": DEFLECTIONS[:1]})  # compiles
    child_run({"solid": 1.4, "deflections": DEFLECTIONS[:1]})
    asked = [{"solid": f} for f in SOLIDS] + [{"plates": p} for p in PLATES]
    found = [child_run(one | {"deflections": DEFLECTIONS}) for one in asked]
    exact = np.array(found[0]["load"])
    for one, result in zip(asked, found, strict=True):
        plates = "plates of {:g} x {:g} mm".format(*(1e3 * s for s in one.get("plates", (0.0, 0.0))))
        case = f"solid, cells x {one['solid']:g}" if "solid" in one else plates
        yield row(case, "unknowns", "-", result["unknowns"])
        yield row(case, "curve of 8 points to 40 mm", "s", result["cpu_s"])
        yield row(case, "peak memory", "MB", result["memory_MB"])
        error = np.abs(np.array(result["load"]) / exact - 1.0).max()
        yield row(case, "load, largest difference from the finest solid", "%", 100.0 * float(error))
    if shutil.which(calculix.PROGRAM) is not None:
        yield from calculix_cost(exact)


def calculix_cost(exact: np.ndarray) -> Iterator[dict[str, object]]:
    """The same curve by CalculiX on the study's mesh, springs on the rim as `benchmarks.crosscheck` has them."""
    from benchmarks.crosscheck import LIMIT_S, deck_of
    from benchmarks.peer_codes import calculix_wheel

    study = read_study(built_in_study())
    inputs = mesh_task(study, "mesh").inputs
    with tempfile.TemporaryDirectory() as folder:
        build(inputs, {}, Path(folder), lambda _: None)
        mesh = read_mesh(Path(folder) / MESH)
    with tempfile.TemporaryDirectory() as folder:
        before = os.times()
        peer = calculix_wheel.solve(deck_of(study, mesh, ORIENTATION, tuple(DEFLECTIONS)), Path(folder), 1, LIMIT_S)
        after = os.times()
    spent = after.children_user + after.children_system - before.children_user - before.children_system
    case = "CalculiX, C3D20R, cells x 1"
    yield row(case, "unknowns", "-", 3 * len(np.unique(mesh.cells[:, TWENTY_NODES])))
    yield row(case, "curve of 8 points to 40 mm", "s", spent)
    error = np.abs(np.array(peer.loads) / exact - 1.0).max()
    yield row(case, "load, largest difference from the finest solid", "%", 100.0 * float(error))


def child_run(asked: dict[str, Any]) -> dict[str, Any]:
    """What `child` finds, in a process of its own with one thread."""
    command = [sys.executable, str(Path(__file__)), "--child", json.dumps(asked)]
    threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
    ended = subprocess.run(command, env=os.environ | threads, capture_output=True, text=True, check=True)
    return dict(json.loads(ended.stdout.splitlines()[-1]))


def child(asked: dict[str, Any]) -> dict[str, Any]:
    """Loads at the deflections, unknowns, processor time, memory of this process."""
    import resource
    import time

    begun = time.process_time()
    if "plates" in asked:
        wheel = build_ancf_wheel(exomars(), element_size=asked["plates"][0], axial_size=asked["plates"][1])
        problem = WheelOnGround(wheel, math.radians(ORIENTATION))
        load, unknowns = [s.load for s in press(problem, asked["deflections"])], wheel.basis.shape[1]
    else:
        load, unknowns = solid_curve(asked["solid"], asked["deflections"])
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    return {"load": load, "unknowns": unknowns, "cpu_s": time.process_time() - begun, "memory_MB": memory}


def solid_curve(size: float, deflections: list[float]) -> tuple[list[float], int]:
    """The built-in study's solid model with cells ``size`` times as long along strips and the axle."""
    study = read_study(built_in_study())
    inputs = dict(mesh_task(study, "mesh").inputs)
    options = inputs["options"]
    sizes = {name: size * options[name] for name in ("element_size", "axial_size", "edge_size") if options[name]}
    with tempfile.TemporaryDirectory() as folder:
        mesh, curve = Path(folder) / "mesh", Path(folder) / "curve"
        mesh.mkdir()
        curve.mkdir()
        build(inputs | {"options": options | sizes}, {}, mesh, lambda _: None)
        asked = without_end(fe_inputs(study, ORIENTATION, deflections))
        unknowns = solve_orientation(asked, {"mesh": mesh}, curve, lambda _: None)
        found = read_curve(curve / CURVE, model="fe", orientation_deg=ORIENTATION)
    return [found.load_at(d) for d in deflections], unknowns


def growth() -> Iterator[dict[str, object]]:
    """Processor time of one step as plates grow."""
    for factor in GROWTH:
        wheel = build_ancf_wheel(exomars(), factor=factor)
        problem = WheelOnGround(wheel, math.radians(ORIENTATION))
        case = f"{len(wheel.plates.plates)} plates"
        begun = os.times().user
        (state,) = press(problem, [5e-3])
        spent = os.times().user - begun
        yield row(case, "unknowns", "-", wheel.basis.shape[1])
        yield row(case, "processor time of a step", "s", spent / (state.iterations + 1))
        yield row(case, "load at 5 mm", "N", state.load)


def arithmetic() -> Iterator[dict[str, object]]:
    """Force and tangent of a plate against the multiply-adds in it at this core's rate."""
    plates = build_ancf_wheel(exomars()).plates
    q = plates.reference + 1e-5 * np.random.default_rng(1).standard_normal(plates.reference.shape)
    stresses = plates.stresses(q, 0.0 * q)
    count = len(plates.plates)
    both, force = (1e6 * shortest_s(f) / count for f in (lambda: plates.terms(q, stresses), lambda: plates.force(q)))
    rate = multiply_add_rate()
    flops = sum(points_flops(points) for points in plates._points) / count
    yield row("built-in wheel", "force, a plate", "us", force)
    yield row("built-in wheel", "force and tangent, a plate", "us", both)
    yield row("built-in wheel", "arithmetic of both, a plate", "us", 1e6 * flops / rate)
    yield row("built-in wheel", "force and tangent over arithmetic", "-", both / (1e6 * flops / rate))


def shortest_s(call: Callable[[], object]) -> float:
    """Shortest of some runs [s]."""
    return 1e-6 * shortest(call)


def points_flops(points: Any) -> float:
    """Operations at all points of one measure of strain: 3 n strains' slopes, H, its pull-back to 48 coordinates."""
    n = 2 if not points[5].any() else 5
    vectors = 3 * n
    one = 2 * (16 * vectors + vectors * vectors * 3 + vectors * n * 48 + 48 * vectors * 16)
    return float(points[1].shape[0] * points[1].shape[1] * one)


def motion() -> Iterator[dict[str, object]]:
    """Processor seconds of a second on Mars, coarse plates: rolling at 70 m/h, dropped by 10 mm, over a half-round."""
    rolls = Hub(mass=52.6, inertia=0.05, speed=70.0 / 3600.0 / 0.1425, gain=500.0)
    rock = TerrainUnion(parts=(Plane(), HalfRound(radius=10e-3, position=64e-3)))
    mars, rough, flat = 3.711, Friction(coefficient=0.6), Plane()
    cases = (
        ("rolling at 70 m/h", flat, rolls, rough, 0.5),
        ("dropped by 10 mm", flat, Hub(mass=18.0, inertia=0.05), Friction(), 0.2),
        ("over a half-round of 10 mm", rock, rolls, rough, 0.6),
    )
    for again in (False, True):  # the first time compiles
        for name, terrain, hub, friction, end in cases:
            wheel = build_ancf_wheel(exomars(), element_size=40e-3, axial_size=60e-3, ground_spacing=1e-3)
            problem = WheelOnGround(wheel, 0.0, terrain=terrain)
            rolling = RollingWheel(problem, hub, mars, friction, 0.05)
            start = above(rolling, 10e-3) if name.startswith("dropped") else standing(rolling)
            account, begun = Account(), os.times().user
            settings = TravelSettings(tolerance=1e-5 if name.startswith("dropped") else 3e-5, largest_step=0.1)
            list(travel(rolling, start, [end if again else 0.01], settings, account))
            if again:
                yield row(name, "unknowns", "-", wheel.basis.shape[1] + 3)
                yield row(name, "processor time of a second", "s", (os.times().user - begun) / end)
                yield row(name, "steps of a second", "-", (len(account.rows) - 1) / end)
                yield row(name, "energy account closes to", "%", 100.0 * account.closure())


PARTS: dict[str, Callable[[], Iterator[dict[str, object]]]] = {
    "cost": cost,
    "growth": growth,
    "arithmetic": arithmetic,
    "motion": motion,
}

if __name__ == "__main__":
    main()
