"""Our wheel in another code: forces of the solid model beside CalculiX' on our own mesh, ground and springs in contact.

``make bench NAME=crosscheck``; needs ``ccx`` (Debian, Ubuntu: the package calculix-ccx). Five of the study's
orientations, a quarter, half and three quarters of its largest deflection, both sides from first touch; at the first
one the hub is pressed with friction too and moved forwards. Ours are the curves of the report, from the store; CalculiX
solves the same hexahedra with the 20 of their 27 nodes that its element has (C3D20R). Writes
``build/bench/crosscheck.json`` and the record that the report reads, ``crosscheck.json`` beside the study.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT)]

from benchmarks.output.run import Run  # noqa: E402
from benchmarks.peer_codes import calculix, calculix_wheel  # noqa: E402
from benchmarks.peer_codes.calculix_wheel import CalculixRun, WheelDeck  # noqa: E402
from contracts.curves import StiffnessCurve, read_curve  # noqa: E402
from contracts.errors import InputError  # noqa: E402
from contracts.frames import ground_direction_h  # noqa: E402
from contracts.hub_travel import Way  # noqa: E402
from contracts.mesh import TaggedMesh  # noqa: E402
from geometry.inp import TWENTY_NODES  # noqa: E402
from reference_fe.contact.inner_pairs import wheel_contact_pairs  # noqa: E402
from reference_fe.contact.patch import contact_faces, facet_samples  # noqa: E402
from reference_fe.wheel.problem import CONTACT_FACES  # noqa: E402
from workbench.commands.computing import computed  # noqa: E402
from workbench.commands.options import DEFAULT_STORE, computing  # noqa: E402
from workbench.execution.task import Task  # noqa: E402
from workbench.questions.crosscheck.results import COMMAND, NAME, crosscheck_tasks, points_of  # noqa: E402
from workbench.questions.fe.graph import INNER_STIFFNESS  # noqa: E402
from workbench.questions.kept import keep  # noqa: E402
from workbench.questions.model_curves import CURVE  # noqa: E402
from workbench.questions.travel_files import travel_curves, travel_name  # noqa: E402
from workbench.questions.travel_start import approach  # noqa: E402
from workbench.questions.wheel.mesh_file import MESH, read_mesh  # noqa: E402
from workbench.study.model import Study  # noqa: E402
from workbench.study.orientation import orientation_name  # noqa: E402
from workbench.study.reading import built_in_study, read_study  # noqa: E402
from workbench.study.wheel_design import wheel_design  # noqa: E402

LIMIT_S = 3600.0
"""Processor time after which a run is given up [s]."""


def deck_of(study: Study, mesh: TaggedMesh, orientation: float, deflections: tuple[float, ...]) -> WheelDeck:
    """The study's wheel at an orientation [deg], its ground where it just touches the undeformed faces."""
    normal = -ground_direction_h(np.deg2rad(orientation))
    faces = tuple(face for face in CONTACT_FACES if face in mesh.faces)
    points, _ = facet_samples(mesh.points, contact_faces(mesh, faces))
    materials = {part: m for part, m in wheel_design(study).materials.items() if part in mesh.parts}
    pairs = wheel_contact_pairs(mesh) if study.fe.inner_contact else ()
    return WheelDeck(
        mesh=mesh,
        materials=materials,
        rigid=("outer_hub",),
        ground_faces=faces,
        pairs=tuple((pair.slave, pair.master) for pair in pairs if pair.master == "tire_inner"),
        normal=normal,
        distance_at_touch=-float((points @ normal).min()),
        deflections=deflections,
        stiffness=study.fe.contact_stiffness or INNER_STIFFNESS,
    )


def refuse_others(study: Study) -> None:
    """Raise InputError for a study whose wheel the deck does not describe."""
    fe, plane = study.fe, study.fe.obstacle.shape == "plane"
    fits = fe.hub == "rigid" and plane and not fe.friction and not fe.camber and study.mesh.half_width
    if not (fits and study.mesh.order == 2 and fe.material_law == "st_venant_kirchhoff" and fe.contact_stiffness):
        rule = "must be half a wheel of order 2, St. Venant-Kirchhoff, its hub rigid, on a smooth plane by a penalty"
        raise InputError("study", study.name, rule, "take studies/exomars.toml")


def compared(
    study: Study, folders: Mapping[str, Path], wanted: tuple[float, ...], at_once: int
) -> list[dict[str, object]]:
    """One entry of the record for each orientation [deg]: loads of both at the deflections."""
    mesh, deflections = read_mesh(folders["mesh"] / MESH), points_of(study)[1]

    def one(orientation: float) -> dict[str, object]:
        curve = _curve(folders, orientation)
        with tempfile.TemporaryDirectory() as folder:
            deck = deck_of(study, mesh, orientation, deflections)
            peer = calculix_wheel.solve(deck, Path(folder), 1, LIMIT_S)
        ours = curve.load_at(np.array(deflections)).tolist()
        _show(orientation, deflections, ours, peer)
        found = {"orientation_deg": orientation, "ours_N": ours, "peer_N": list(peer.loads)}
        return found | {"iterations": peer.iterations, "wall_s": round(peer.wall_s, 1)}

    with ThreadPoolExecutor(at_once) as pool:
        return list(pool.map(one, wanted))


def moved(study: Study, tasks: Sequence[Task], folders: Mapping[str, Path], orientation: float) -> dict[str, object]:
    """The record's entry of the travel forwards at an orientation [deg]: forces of both behind each travel."""
    name = travel_name("fe", Way.FORE_AFT, orientation)
    (friction,) = (task.inputs["travel"]["friction"] for task in tasks if task.name == name)
    (ours,) = travel_curves("fe", (Way.FORE_AFT,), (orientation,), folders)
    mesh = read_mesh(folders["mesh"] / MESH)
    deck = replace(deck_of(study, mesh, orientation, approach(ours.deflection)), friction=friction)
    with tempfile.TemporaryDirectory() as folder:
        peer = calculix_wheel.solve(replace(deck, travels=tuple(ours.travel[1:].tolist())), Path(folder), 1, LIMIT_S)
    forces = ours.columns["force_forward_N"].tolist()
    for gone, mine, other in zip(ours.travel, forces, peer.forwards, strict=True):
        print(f"{orientation:4g} deg, moved {1e3 * gone:g} mm: ours {mine:8.3f} N, CalculiX {other:8.3f} N", flush=True)
    found = {"orientation_deg": orientation, "deflection_m": ours.deflection, "friction": friction}
    return found | {"travel_m": ours.travel.tolist(), "ours_N": forces, "peer_N": list(peer.forwards)}


def _curve(folders: Mapping[str, Path], orientation: float) -> StiffnessCurve:
    name = orientation_name("fe", orientation)
    return read_curve(folders[name] / CURVE, model="fe", orientation_deg=orientation)


def _show(orientation: float, deflections: tuple[float, ...], ours: list[float], peer: CalculixRun) -> None:
    for d, mine, other in zip(deflections, ours, peer.loads, strict=True):
        text = f"{orientation:4g} deg {1e3 * d:4g} mm: ours {mine:8.3f} N, CalculiX {other:8.3f} N"
        print(f"{text}, {100.0 * (other / mine - 1.0):+.2f} %", flush=True)
    print(f"{orientation:4g} deg: {peer.iterations} iterations, {peer.wall_s:.0f} s", flush=True)


def _rows(runs: list[dict[str, object]], deflections: tuple[float, ...]) -> list[dict[str, object]]:
    return [
        {
            "case": f"{run['orientation_deg']:g} deg",
            "metric": f"load at {1e3 * d:g} mm",
            "unit": "N",
            "ours": mine,
            "peer": other,
            "ratio": other / mine,
        }
        for run in runs
        for d, mine, other in zip(deflections, run["ours_N"], run["peer_N"], strict=True)  # type: ignore[call-overload]
    ]


def main() -> None:
    """Compare, print, write, keep."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--study", type=Path, default=built_in_study(), help="study file")
    parser.add_argument("--only", type=float, nargs="+", help="orientations [deg]; the run is then not kept")
    parser.add_argument("--at-once", type=int, default=1, help="runs of CalculiX at the same time, one core each")
    chosen = parser.parse_args()
    if shutil.which(calculix.PROGRAM) is None:
        parser.error("ccx is not on PATH: install CalculiX, on Debian or Ubuntu `apt-get install calculix-ccx`")
    study, run, started = read_study(chosen.study), Run(NAME, {"CalculiX": calculix.version()}), time.perf_counter()
    try:
        refuse_others(study)
    except InputError as error:
        parser.error(str(error))
    orientations, deflections = points_of(study)
    wanted = tuple(chosen.only or orientations)
    tasks = crosscheck_tasks(study, wanted)
    entries = computed(chosen.study, tasks, DEFAULT_STORE, computing(None, 1, None))
    folders = {name: entry.path for name, entry in entries.items()}
    try:
        runs = compared(study, folders, wanted, chosen.at_once)
        travel = moved(study, tasks, folders, wanted[0])
    except (RuntimeError, subprocess.SubprocessError) as error:
        sys.exit(f"crosscheck: {error}")
    written = run.write(_rows(runs, deflections), keep=False)
    if not chosen.only:
        unknowns = 3 * len(np.unique(read_mesh(folders["mesh"] / MESH).cells[:, TWENTY_NODES]))
        found = {"peer": f"CalculiX {calculix.version()}", "peer_unknowns": unknowns}
        found |= {"deflections_m": list(deflections), "runs": runs, "travel": travel}
        written.append(keep(study, NAME, COMMAND, tasks, time.perf_counter() - started, found))
    for path in written:
        print(f"written: {path}")


if __name__ == "__main__":
    main()
