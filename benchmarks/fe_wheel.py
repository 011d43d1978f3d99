"""Speed and accuracy of the static solver beside CalculiX and FElupe: same mesh, material, steps and tolerance.

Run by `make bench NAME=fe_wheel`; `make bench NAME=fe_wheel ARGS="--only half-cylinder-40"` runs chosen cases. Prints a
table and writes build/bench/fe_wheel.json. Cases: a clamped half cylinder whose digits all codes agree on, and half the
ExoMars wheel pressed on the edge of a grouser by 20 mm, which no code needs contact for, and, by us and CalculiX, on a
plane by 5 mm. README.md here has the last measured table.

Times are processor seconds of one thread, which another load on the machine changes little; set-up is included.
Memory is the largest resident set of the solver's process, which reads its mesh from a file; ours is given once more
without what it holds after the warm-up: Python, libraries, compiled loops.
"""

from __future__ import annotations

import argparse
import importlib.util
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT)]

from benchmarks.output.run import Run, add_option  # noqa: E402
from benchmarks.peer_codes import calculix, calculix_wheel  # noqa: E402
from benchmarks.peer_codes.built_cases import from_description  # noqa: E402
from benchmarks.peer_codes.calculix_wheel import WheelDeck  # noqa: E402
from benchmarks.peer_codes.case import Description, write_case  # noqa: E402
from benchmarks.peer_codes.outcome import Outcome, python_run  # noqa: E402

WARM_UP: Description = ("half_cylinder", 8, 2)
LIMIT_S = 3600.0
"""Processor time after which a run is given up [s]."""
METRICS = {
    "time per Newton iteration": ("s", lambda o: o.cpu_s / o.iterations),
    "time per converged increment": ("s", lambda o: o.cpu_s / o.increments),
    "time to 20 mm": ("s", lambda o: o.cpu_s),
    "Newton iterations to 20 mm": ("-", lambda o: float(o.iterations)),
    "peak memory": ("MB", lambda o: o.memory_MB),
    "peak memory above our libraries": ("MB", lambda o: o.memory_MB - o.libraries_MB),
    "unknowns": ("-", lambda o: float(o.unknowns)),
    "force at 20 mm": ("N", lambda o: o.force_N),
}
NO_RATIO = ("unknowns", "force at 20 mm")


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """One row group of the table.

    Attributes
    ----------
    ours : our mesh, and the element on it
    peer : the peers' mesh; another one than ours where codes are compared at equal accuracy
    calculix_element : reduced (C3D20R) or full (C3D20) integration; reduced hourglasses on the wheel's single layer
    steps : increments of equal length, all codes; None: one for us, four for the peers
    """

    ours: Description
    element: str
    peer: Description
    calculix_element: str
    steps: int | None = 4


def _on_ground(element_size: float, axial_size: float, element: str = "20 nodes, 18 points") -> Comparison:
    """The wheel on a plane, its mesh by element sizes [m]."""
    mesh = ("ground", element_size, axial_size)
    return Comparison(ours=mesh, element=element, peer=mesh, calculix_element="C3D20R", steps=1)


CASES = {
    "half-cylinder-40": Comparison(
        ours=("half_cylinder", 40, 8), element="20 nodes", peer=("half_cylinder", 40, 8), calculix_element="C3D20R"
    ),
    "half-cylinder-120": Comparison(
        ours=("half_cylinder", 120, 24), element="20 nodes", peer=("half_cylinder", 120, 24), calculix_element="C3D20R"
    ),
    "half-cylinder-220": Comparison(
        ours=("half_cylinder", 220, 44), element="20 nodes", peer=("half_cylinder", 220, 44), calculix_element="C3D20R"
    ),
    "half-cylinder-equal-accuracy": Comparison(
        ours=("half_cylinder", 40, 8), element="27 nodes", peer=("half_cylinder", 120, 24), calculix_element="C3D20R"
    ),
    "wheel-60k": Comparison(
        ours=("wheel", 0.0055, 0.015), element="27 nodes", peer=("wheel", 0.0055, 0.015), calculix_element="C3D20"
    ),
    "wheel-200k": Comparison(
        ours=("wheel", 0.003, 0.0085), element="27 nodes", peer=("wheel", 0.003, 0.0085), calculix_element="C3D20"
    ),
    "wheel-one-increment": Comparison(
        ours=("wheel", 0.008, 0.020),
        element="27 nodes",
        peer=("wheel", 0.008, 0.020),
        calculix_element="C3D20",
        steps=None,
    ),
    "ground-20k": _on_ground(0.008, 0.020),
    "ground-60k": _on_ground(0.0055, 0.015),
    "ground-60k-27-nodes": _on_ground(0.0055, 0.015, "27 nodes"),
    "ground-140k": _on_ground(0.003, 0.0085),
}


def compare(name: str, wanted: Comparison, threads: int) -> list[dict[str, object]]:
    """Rows of one case: ours against each peer, measured in turn."""
    with tempfile.TemporaryDirectory() as folder:
        ours = _ours(wanted, Path(folder), threads)
        _show(name, f"ours, {wanted.element}", ours)
        rows = []
        for peer, run in _peers().items():
            if wanted.peer[0] == "ground" and peer == "FElupe":
                continue  # no contact of this kind
            theirs = _attempt(peer, run, wanted, Path(folder), threads)
            _show(name, peer, theirs)
            rows += _rows(f"{name} against {peer}", ours, theirs)
    return rows


def _rows(case: str, ours: Outcome, theirs: Outcome | None) -> list[dict[str, object]]:
    rows: list[dict[str, object]] = []
    for metric, (unit, value) in METRICS.items():
        if case.startswith("ground") and metric.endswith("20 mm"):
            continue  # pressed less far
        mine, other = value(ours), None if theirs is None else value(theirs)
        ratio = None if other is None or metric in NO_RATIO else other / mine
        rows.append({"case": case, "metric": metric, "unit": unit, "ours": mine, "peer": other, "ratio": ratio})
    return rows


def _ours(wanted: Comparison, folder: Path, threads: int) -> Outcome:
    case, warm_up = (_kept(description, folder) for description in (wanted.ours, WARM_UP))
    arguments = {"case": case, "warm_up": warm_up, "element": wanted.element, "steps": wanted.steps or 1}
    return python_run("ours", arguments, folder, threads, LIMIT_S)


def _kept(description: Description, folder: Path) -> str:
    """Folder of the case, for the processes that solve it."""
    case = folder / "_".join(map(str, description))
    if not case.exists():
        write_case(from_description(description), case)
    return str(case)


def _calculix(wanted: Comparison, folder: Path, threads: int) -> Outcome:
    case = from_description(wanted.peer)
    if not case.ground_faces:
        return calculix.solve(case, folder, threads, LIMIT_S, wanted.calculix_element)
    deck = WheelDeck(
        mesh=case.mesh,
        materials={part: case.material for part in case.mesh.parts if part not in case.held_parts},
        rigid=case.held_parts,
        ground_faces=case.ground_faces,
        pairs=(),
        normal=np.eye(3)[case.component],
        distance_at_touch=-case.ground_level,
        deflections=tuple(case.travel * (k + 1) / case.steps for k in range(case.steps)),
        stiffness=case.ground_stiffness,
    )
    run = calculix_wheel.solve(deck, folder / "calculix", threads, LIMIT_S)
    return Outcome(
        unknowns=case.twenty_node_unknowns(),
        increments=run.increments,
        iterations=run.iterations,
        cpu_s=run.cpu_s,
        wall_s=run.wall_s,
        memory_MB=run.memory_MB,
        force_N=run.loads[-1],
    )


def _felupe(wanted: Comparison, folder: Path, threads: int) -> Outcome:
    full = wanted.calculix_element == "C3D20"
    arguments = {"case": _kept(wanted.peer, folder), "steps": wanted.steps or 4, "points": 3 if full else 2}
    return python_run("felupe_run", arguments, folder, threads, LIMIT_S)


def _peers() -> dict[str, Callable[[Comparison, Path, int], Outcome] | None]:
    """Peer -> how it is run, or None where it is not installed."""
    felupe = all(importlib.util.find_spec(module) for module in ("felupe", "pypardiso", "tensortrax"))
    return {
        "CalculiX": _calculix if shutil.which(calculix.PROGRAM) else None,
        "FElupe": _felupe if felupe else None,
    }


def _attempt(
    peer: str,
    run: Callable[[Comparison, Path, int], Outcome] | None,
    wanted: Comparison,
    folder: Path,
    threads: int,
) -> Outcome | None:
    if run is None:
        return None
    try:
        return run(wanted, folder, threads)
    except (RuntimeError, subprocess.SubprocessError) as error:
        print(f"{peer} did not reach 20 mm: {error}", file=sys.stderr)
        return None


def _show(case: str, code: str, outcome: Outcome | None) -> None:
    head = f"{case:30s} {code:25s}"
    if outcome is None:
        print(f"{head} no result", flush=True)
        return
    o = outcome
    print(
        f"{head} {o.unknowns:8d} unknowns {o.increments:4d} increments {o.iterations:4d} iterations "
        f"{o.cpu_s / o.iterations:8.3f} s/iteration {o.cpu_s / o.increments:8.2f} s/increment {o.cpu_s:8.1f} s "
        f"{o.memory_MB:6.0f} MB ({o.memory_MB - o.libraries_MB:.0f}) {o.force_N:11.4f} N",
        flush=True,
    )


def main() -> None:
    """Run the chosen cases and write the JSON."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", choices=list(CASES), default=list(CASES), help="cases to run")
    parser.add_argument("--threads", type=int, default=1, help="threads of every code (wall time is then what counts)")
    add_option(parser)
    chosen = parser.parse_args()
    if chosen.record and set(chosen.only) != set(CASES):
        parser.error("--record keeps whole runs only: leave --only out")
    if chosen.record and None in _peers().values():
        parser.error("--record keeps whole runs only: install CalculiX and FElupe")
    run = Run("fe_wheel", {"CalculiX": calculix.version()})
    for peer, hint in (
        ("CalculiX", "install the package calculix-ccx (Debian, Ubuntu) so that ccx is on PATH"),
        ("FElupe", "`make bench` installs it; by hand: uv pip install --constraints constraints.txt --group bench"),
    ):
        if _peers()[peer] is None:
            print(f"{peer} is not installed, its columns stay empty: {hint}", file=sys.stderr)
    rows = [row for name in chosen.only for row in compare(name, CASES[name], chosen.threads)]
    for row in rows:
        peer, ratio = (f"{row[key]:12.4g}" if row[key] is not None else f"{'-':>12s}" for key in ("peer", "ratio"))
        print(f"{row['case']:48s} {row['metric']:30s} {row['unit']:3s} {row['ours']:12.4g} {peer} {ratio}")
    whole = all(row["peer"] is not None for row in rows)
    for written in run.write(rows, keep=chosen.record and whole):
        print(f"written: {written}")
    if chosen.record and not whole:
        sys.exit("the run is not kept for the report: a code did not reach 20 mm in every case")


if __name__ == "__main__":
    main()
