"""A case by FElupe with 20-node hexahedra, two or three points an axis, and PARDISO; run as a module, see `ours`."""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

import felupe
import numpy as np
import pypardiso

from benchmarks.peer_codes.case import TOLERANCE, LoadCase, read_case
from geometry.inp import TWENTY_NODES


def solve(case: LoadCase, steps: int, points: int) -> dict[str, float]:
    """Drive the line to its full travel in equal steps."""
    cpu, wall = time.process_time(), time.perf_counter()
    used, cells = np.unique(case.mesh.cells[:, TWENTY_NODES], return_inverse=True)
    mesh = felupe.Mesh(case.mesh.points[used], cells.reshape(-1, 20), "hexahedron20")
    region = felupe.RegionQuadraticHexahedron(mesh, quadrature=felupe.GaussLegendre(order=points - 1, dim=3))
    displacement = felupe.Field(region, dim=3)
    field = felupe.FieldContainer([displacement])
    energy = felupe.constitution.tensortrax.models.hyperelastic.saint_venant_kirchhoff
    law = felupe.Hyperelastic(energy, mu=case.material.lame_mu, lmbda=case.material.lame_lambda)
    body = felupe.SolidBody(law, field)
    held, driven = (np.searchsorted(used, np.intersect1d(nodes, used)) for nodes in (case.held(), case.driven()))
    skip = [axis != case.component for axis in range(3)]
    bounds = {
        "held": felupe.dof.Boundary(displacement, mask=_mask(mesh, held)),
        "driven": felupe.dof.Boundary(displacement, mask=_mask(mesh, np.setdiff1d(driven, held)), skip=skip),
    }
    if case.symmetry:
        nodes = np.searchsorted(used, np.intersect1d(case.nodes_of_face(case.symmetry), used))
        rest = _mask(mesh, np.setdiff1d(nodes, held))
        bounds["symmetry"] = felupe.dof.Boundary(displacement, mask=rest, skip=(True, False, True))
    iterations, force = 0, 0.0
    for k in range(steps):
        bounds["driven"].value = case.travel * (k + 1) / steps
        dof0, dof1 = felupe.dof.partition(field, bounds)
        ext0 = felupe.dof.apply(field, bounds, dof0)
        result = felupe.newtonraphson(
            items=[body], x0=field, dof0=dof0, dof1=dof1, ext0=ext0, tol=TOLERANCE, solver=pypardiso.spsolve, verbose=0
        )
        iterations += result.iterations
        residual = body.assemble.vector(field).toarray().reshape(-1, 3)
        force = case.force_factor * float(residual[np.setdiff1d(driven, held), case.component].sum())
    return {
        "unknowns": 3 * len(used),
        "increments": steps,
        "iterations": iterations,
        "force_N": force,
        "cpu_s": time.process_time() - cpu,
        "wall_s": time.perf_counter() - wall,
    }


def _mask(mesh: felupe.Mesh, nodes: np.ndarray) -> np.ndarray:
    mask = np.zeros(mesh.npoints, dtype=bool)
    mask[nodes] = True
    return mask


if __name__ == "__main__":
    wanted = json.loads(sys.argv[1])
    print(json.dumps(solve(read_case(Path(wanted["case"])), wanted["steps"], wanted["points"])))
