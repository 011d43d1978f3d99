"""Claim: CalculiX finds our forces with plasticity and rubber too, on the way up and on the way back.

Source: CalculiX 2.20 on the same hexahedra with 20 of our 27 nodes. A strip between two clamps is bent by a fifth of
its length until both ends are plastic hinges, and most of the way back, where the force has turned: J2 plasticity.
A rubber bar is pulled to four thirds of its length and across: Mooney-Rivlin, bulk modulus 50 times that of shear.
Tolerance 1 % of the largest force (found 0.7 and 0.2 %): other elements and, of the rubber, another volumetric energy.
Negative controls: a yield strength and a rubber 3 % off.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from benchmarks.peer_codes import calculix
from contracts.material_laws import J2Plasticity, MooneyRivlin
from contracts.materials import TI_6AL_4V, Material
from contracts.mesh import TaggedMesh
from geometry.inp import write_inp
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.structured_hexahedra import block_mesh

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which(calculix.PROGRAM) is None, reason="CalculiX is not installed"),
]


@dataclass(frozen=True)
class Case:
    """A block whose end x0 is held while the end x1 is moved along some axes; share of the move at each stop."""

    mesh: TaggedMesh
    material: Material
    move: dict[int, float]
    stops: Sequence[float]


def block(counts: tuple[int, int, int], size: tuple[float, float, float]) -> TaggedMesh:
    return block_mesh(counts, lambda X: X * np.array(size))


METAL = replace(TI_6AL_4V, law=J2Plasticity(hardening_modulus=1e9, saturation_stress=1000e6, saturation_rate=100.0))
RUBBER = replace(
    TI_6AL_4V, name="rubber", temperature_data=None, law=MooneyRivlin(c10=0.3e6, c01=0.1e6, bulk_modulus=40e6)
)
UP, BACK = [0.2, 0.4, 0.6, 0.8, 1.0], [0.8, 0.6, 0.4, 0.2]
BENT = Case(block((40, 2, 4), (0.06, 0.01, 0.004)), METAL, {2: 0.012}, UP + BACK)
PULLED = Case(block((12, 4, 4), (0.06, 0.01, 0.01)), RUBBER, {0: 0.02, 1: 0.0, 2: 0.02}, UP)


def ours(case: Case, material: Material) -> np.ndarray:
    """Force on x1 along the moved axes at each stop, (n_stops, n_axes) [N]."""
    axes, full = tuple(case.move), tuple(case.move.values())
    supports = [Support(faces=("x1",), components=axes, value=full), Support(faces=("x0",))]
    problem = StaticProblem(Domain.from_tagged(case.mesh), {"body": material}, supports)
    rest, found = iter(case.stops), []
    aim: float | None = next(rest)

    def next_stop(reached: float) -> float | None:
        nonlocal aim
        if reached == aim:
            aim = next(rest, None)
        return aim

    for state in solve_increments(NewtonSolver(problem, NewtonSettings(relative_tolerance=1e-7)), next_stop, []):
        if state.wanted:
            residual = state.outcome.residual
            found.append([residual[problem.bcs[k].dof_indices()[0]].sum() for k in range(len(axes))])
    return np.array(found)


def theirs(case: Case, folder: Path) -> np.ndarray:
    """The same by CalculiX, one step a stop."""
    write_inp(case.mesh, folder / "mesh.inp", element="C3D20R")
    lines = ["*INCLUDE, INPUT=mesh.inp", *calculix.material_lines("M", case.material)]
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M", "*BOUNDARY", "X0, 1, 3"]
    for share in case.stops:
        lines += ["*STEP, NLGEOM, INC=1000", "*STATIC, SOLVER=SPOOLES", "0.5, 1., 1e-6, 1.", "*BOUNDARY"]
        lines += [f"X1, {axis + 1}, {axis + 1}, {share * full!r}" for axis, full in case.move.items()]
        lines += ["*NODE PRINT, NSET=X1, TOTALS=ONLY, FREQUENCY=10000", "RF", "*END STEP"]
    (folder / "case.inp").write_text("\n".join(lines) + "\n")
    subprocess.run([calculix.PROGRAM, "-i", "case"], cwd=folder, check=True, capture_output=True, timeout=600)
    found = re.findall(r"total force .*\n\n\s*(\S+)\s+(\S+)\s+(\S+)", (folder / "case.dat").read_text())
    return np.array(found, dtype=float)[:, list(case.move)]


@pytest.mark.parametrize("case", [pytest.param(BENT, marks=pytest.mark.long), PULLED], ids=["plasticity", "rubber"])
def test_the_forces_are_ours_and_other_constants_are_seen(case: Case, tmp_path: Path) -> None:
    mine, other = ours(case, case.material), theirs(case, tmp_path)
    tolerance = 0.01 * np.abs(mine).max()
    np.testing.assert_allclose(other, mine, rtol=0.0, atol=tolerance)
    law = case.material.law
    if isinstance(law, MooneyRivlin):
        wrong = replace(case.material, law=replace(law, c10=1.03 * law.c10, c01=1.03 * law.c01))
    else:
        assert isinstance(law, J2Plasticity)
        wrong = replace(case.material, yield_strength=0.97 * 880e6, law=replace(law, saturation_stress=970e6))
    assert np.abs(ours(case, wrong) - other).max() > tolerance
