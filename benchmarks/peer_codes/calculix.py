"""A case by CalculiX with 20-node hexahedra of reduced integration; the deck is written by `geometry.inp`."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np

from benchmarks.peer_codes.case import TOLERANCE, LoadCase
from benchmarks.peer_codes.outcome import Outcome, measured
from contracts.material_laws import J2Plasticity, MooneyRivlin, StVenantKirchhoff
from contracts.materials import Material
from geometry.inp import TWENTY_NODES, write_inp

__all__ = ["PROGRAM", "material_lines", "solve", "version"]

PROGRAM = "ccx"


def version() -> str:
    """Version of the program, or ``missing``."""
    if shutil.which(PROGRAM) is None:
        return "missing"
    shown = subprocess.run([PROGRAM, "-v"], capture_output=True, text=True, check=False, timeout=30).stdout
    found = re.search(r"Version (\S+)", shown)
    return found.group(1) if found else "unknown"


def solve(case: LoadCase, folder: Path, threads: int, limit_s: float, element: str = "C3D20R") -> Outcome:
    """Drive the line to its full travel; CalculiX may cut its increments as it needs, the wanted step is its largest.

    The iteration counts are those of the .sta file: every attempt is there. Solver: SPOOLES, the only direct solver of
    the Debian package.
    """
    used = np.unique(case.mesh.cells[:, TWENTY_NODES])
    held, driven = np.intersect1d(case.held(), used), np.intersect1d(case.driven(), used)
    sets = {"held": held, "driven": np.setdiff1d(driven, held)}
    write_inp(case.mesh, folder / "mesh.inp", element=element, node_sets=sets)
    (folder / "case.inp").write_text(_deck(case))
    run = measured([PROGRAM, "-i", "case"], folder, threads, limit_s)
    rows = [line.split() for line in (folder / "case.sta").read_text().splitlines()[2:]]
    attempts = [(row[2], int(row[3])) for row in rows]
    if float(rows[-1][5]) < 1.0 - 1e-9:
        raise RuntimeError(f"CalculiX ended at {rows[-1][5]} of the travel")
    totals = re.findall(r"total force .*\n\n\s*(\S+)\s+(\S+)\s+(\S+)", (folder / "case.dat").read_text())
    return Outcome(
        unknowns=3 * len(used),
        increments=sum(not mark.endswith("U") for mark, _ in attempts),
        iterations=sum(count for _, count in attempts),
        cpu_s=run.cpu_s,
        wall_s=run.wall_s,
        memory_MB=run.memory_MB,
        force_N=case.force_factor * float(totals[-1][case.component]),
    )


def material_lines(name: str, material: Material) -> list[str]:
    """The material as its block of a deck; raises NotImplementedError for a law that is not written here.

    Its Mooney-Rivlin law has (J - 1)^2 K/2 where ours has (ln J)^2 K/2, its plasticity a hardening curve in points
    (user's manual 2.20, *HYPERELASTIC, *PLASTIC). Verified by tests/verification/test_calculix_laws.py.
    """
    elastic = ["*ELASTIC", f"{material.young_modulus!r}, {material.poisson_ratio!r}"]
    match material.law:
        case None | StVenantKirchhoff():
            lines = elastic
        case MooneyRivlin(c10=c10, c01=c01, bulk_modulus=bulk):
            lines = ["*HYPERELASTIC, MOONEY-RIVLIN", f"{c10!r}, {c01!r}, {2.0 / bulk!r}"]
        case J2Plasticity() as law:
            assert material.yield_strength is not None
            strain = np.concatenate([[0.0], np.geomspace(1e-4, 1.0, 80)])
            end = law.saturation_stress or material.yield_strength
            gone = np.exp(-law.saturation_rate * strain)
            stress = end + (material.yield_strength - end) * gone + law.hardening_modulus * strain
            points = zip(stress.tolist(), strain.tolist(), strict=True)
            lines = [*elastic, "*PLASTIC", *(f"{a!r}, {b!r}" for a, b in points)]
        case other:
            raise NotImplementedError(f"a deck for {type(other).__name__}")
    return [f"*MATERIAL, NAME={name}", *lines]


def _deck(case: LoadCase) -> str:
    step, axis = 1.0 / case.steps, case.component + 1
    symmetry = f"{case.symmetry.upper()}, 2, 2\n" if case.symmetry else ""
    sections = "".join(f"*SOLID SECTION, ELSET={part.upper()}, MATERIAL=M\n" for part in case.mesh.parts)
    return (
        "*INCLUDE, INPUT=mesh.inp\n"
        f"{'\n'.join(material_lines('M', case.material))}\n{sections}"
        f"*BOUNDARY\nHELD, 1, 3\n{symmetry}"
        "*STEP, NLGEOM, INC=2000\n*STATIC, SOLVER=SPOOLES\n"
        f"{step!r}, 1., 1e-6, {step!r}\n"
        f"*CONTROLS, PARAMETERS=FIELD\n{TOLERANCE!r}, 1., , , {TOLERANCE!r}\n"
        f"*BOUNDARY\nDRIVEN, {axis}, {axis}, {case.travel!r}\n"
        "*NODE PRINT, NSET=DRIVEN, TOTALS=ONLY, FREQUENCY=1\nRF\n*END STEP\n"
    )
