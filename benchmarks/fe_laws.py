"""What laws of material cost in the finite element solver, beside St. Venant-Kirchhoff's own loops and UFL forms.

``make bench NAME=fe_laws`` prints the table and writes ``build/bench/fe_laws.json``. Processor seconds of one tangent
and one residual of the half cylinder's mesh (40 x 8 x 1 cells of 27 nodes, 2 x 3 x 3 points), the smallest of seven
taken in turn, so that another load on the machine falls on all alike. The ratio is the time over that of the loops of
St. Venant-Kirchhoff material. README.md here has the last measured table.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT)]

from benchmarks.output.run import Run, add_option  # noqa: E402
from contracts.material_laws import (  # noqa: E402
    J2Plasticity,
    Law,
    MooneyRivlin,
    NeoHookean,
    Ogden,
    StVenantKirchhoff,
)
from reference_fe.cells.discretisation import Discretisation  # noqa: E402
from reference_fe.problem.static_problem import StaticProblem  # noqa: E402
from reference_fe.verification import half_cylinder  # noqa: E402

REPEATS = 7
FORMS = Discretisation(compiled=False)
CASES: dict[str, tuple[Law, Discretisation]] = {
    "St. Venant-Kirchhoff": (StVenantKirchhoff(), Discretisation()),
    "neo-Hookean": (NeoHookean(), Discretisation()),
    "Mooney-Rivlin": (MooneyRivlin(c10=3e10, c01=1e10, bulk_modulus=2e11), Discretisation()),
    "Ogden, three terms": (
        Ogden(moduli=(5e10, 1e8, -8e8), exponents=(1.3, 5.0, -2.0), bulk_modulus=2e11),
        Discretisation(),
    ),
    "J2 plasticity": (J2Plasticity(hardening_modulus=2e9), Discretisation()),
    "St. Venant-Kirchhoff, UFL": (StVenantKirchhoff(), FORMS),
    "neo-Hookean, UFL": (NeoHookean(), FORMS),
}


def loaded(law: Law, choice: Discretisation) -> StaticProblem:
    """The half cylinder, pulled across its axis by 1 % of its height: metal yields."""
    half_cylinder.STEEL = replace(half_cylinder.STEEL, law=law, yield_strength=2e8)
    problem = half_cylinder.half_cylinder((40, 8), choice)
    problem.u.interpolate(lambda x: np.stack([-0.003 * x[0], 0.01 * x[1], -0.003 * x[2]]))
    problem.store_stress(extrapolate=False)
    return problem


def seconds(work: Callable[[], object]) -> float:
    """Processor time [s]."""
    start = time.process_time()
    work()
    return time.process_time() - start


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_option(parser)
    options, run = parser.parse_args(), Run("fe_laws")
    problems = {name: loaded(*case) for name, case in CASES.items()}
    matrices = {name: problem.tangent() for name, problem in problems.items()}
    works = {
        "tangent": lambda name: problems[name].tangent(matrices[name]),
        "residual": lambda name: problems[name].body_residual(),
    }
    taken = {(name, metric): float("inf") for name in CASES for metric in works}
    for _ in range(REPEATS):
        for name, metric in taken:
            taken[name, metric] = min(taken[name, metric], seconds(lambda n=name, m=metric: works[m](n)))  # type: ignore[misc]
    first, rows = next(iter(CASES)), list[dict[str, object]]()
    for name in CASES:
        for metric in works:
            ours, here = taken[first, metric], taken[name, metric]
            print(f"{name:<28}{metric:<10}{here:9.4f} s   ratio {here / ours:6.2f}")
            measured = {"unit": "s", "ours": ours, "peer": here, "ratio": here / ours}
            rows.append({"case": name, "metric": f"{metric} of 320 cells", **measured})
    for path in run.write(rows, keep=options.record):
        print(path)


if __name__ == "__main__":
    main()
