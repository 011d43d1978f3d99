"""What the finite elements' benchmarks measured against what is known; tolerances are those of tests/verification.

Verified by tests/unit/test_workbench_verification.py.
"""

from __future__ import annotations

import numpy as np

from workbench.questions.verification.lines import Benchmark, Line, Numbers, Reader, Rules
from workbench.verdict.rules import at_most

__all__ = ["BENCHMARKS"]

_SZE = "Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569, section"
_DISTANCE = "largest distance of a published point from our curve, over the curve's width and height"


def _patch(numbers: Numbers) -> Benchmark:
    rules = Rules(
        name="patch",
        title="Patch tests on distorted cells",
        source="Bathe 1996, section 4.4; exact in the element space",
    )
    lines = [
        rules.at_most("linear_field", "distance from a prescribed linear field, cube of 1 m", "m",
                      numbers["linear_field_m"], 1e-15),
        rules.at_most("uniform_stress", "uniaxial stress against force over area", "-",
                      numbers["stress_error"], 1e-10, "difference"),
        rules.at_most("rigid_rotation", "internal force after a rotation by 69°, over E m²", "-",
                      numbers["rotation_force"], 1e-13),
        rules.near("modes", "modes of one free element without stiffness", "-", [numbers["modes"], 6.0], 0.0),
    ]  # fmt: skip
    return rules.benchmark(
        numbers, lines, rules.caught("2 x 2 x 2 Gauss points: modes", numbers, 7.0, "modes"), numbers["modes"]
    )


def _manufactured(numbers: Numbers) -> Benchmark:
    rules = Rules(
        name="manufactured",
        title="Manufactured solution, finite strain",
        source="Roache 2002; orders by Ciarlet 1978; worse of St. Venant-Kirchhoff and neo-Hookean",
    )
    lines = []
    for degree in (1, 2):
        found = np.array([by_degree[str(degree)]["orders"] for by_degree in numbers["laws"].values()])
        for i, (norm, expected) in enumerate((("L2", degree + 1.0), ("H1", float(degree)))):
            worst = found[np.argmax(np.abs(found[:, i] - expected)), i]
            what = f"order of the {norm} error, degree {degree}"
            lines.append(rules.order(f"{norm.lower()}_degree{degree}", what, float(worst), expected))
    claim = rules.claim("control", "negative control, shear modulus 25 % off: L2 order", "order", "-")
    check = at_most(claim, lambda: float(numbers["damaged"]), 0.5)
    control = Line(what="shear modulus 25 % off, degree 1: L2 order", check=check)
    return rules.benchmark(numbers, lines, control, sound=lines[0].check.value)


def _shell(name: str, title: str, section: str, damage: str, numbers: Numbers) -> Benchmark:
    rules = Rules(name=name, title=title, source=f"{_SZE} {section}")
    lines = [
        rules.near("full_load", "deflection at full load, the worse of two", "-", numbers["full"], 0.02),
        rules.at_most("path", f"largest difference at {len(numbers['load'])} points of the path", "-",
                      numbers["path_error"], 0.03, "difference"),
    ]  # fmt: skip
    return rules.benchmark(numbers, lines, rules.caught(damage, numbers, 0.03), numbers["path_error"])


def _end_shear(numbers: Numbers) -> Benchmark:
    return _shell("end_shear", "Cantilever, end shear force", "3.1", "strip 2 % thicker", numbers)


def _end_moment(numbers: Numbers) -> Benchmark:
    return _shell("end_moment", "Cantilever rolled to a circle", "3.2, exact columns", "strip 2 % thicker", numbers)


def _hemisphere(numbers: Numbers) -> Benchmark:
    return _shell("hemisphere", "Hemisphere with a hole", "3.4", "3 x 3 x 3 Gauss points, which lock", numbers)


def _hinged_roof(numbers: Numbers) -> Benchmark:
    rules = Rules(
        name="hinged_roof",
        title="Hinged roof, snap-through and snap-back",
        source=f"{_SZE} 3.8, h = 6.35 mm",
    )
    lines = [
        rules.near("peak", "load over the full one where it first turns", "-", numbers["peak"], 0.01),
        rules.near("trough", "load over the full one where it turns again, negative", "-", numbers["trough"], 0.015),
        rules.at_most("path", _DISTANCE, "-", numbers["distance"], 0.01, "difference"),
    ]
    return rules.benchmark(numbers, lines, rules.caught("roof 2 % thicker: peak", numbers, 0.03))


def _pulled_cylinder(numbers: Numbers) -> Benchmark:
    rules = Rules(name="pulled_cylinder", title="Open cylinder pulled apart", source=f"{_SZE} 3.5")
    lines = [
        rules.near("full_load", "displacement at full load, the worst of three", "-", numbers["full"], 0.02),
        rules.at_most("path", _DISTANCE, "-", numbers["distance"], 0.015, "difference"),
    ]
    control = rules.caught("cylinder 2 % thicker: distance of B and C", numbers, 0.014)
    return rules.benchmark(numbers, lines, control, numbers["free_side"])


def _half_cylinder(numbers: Numbers) -> Benchmark:
    rules = Rules(
        name="half_cylinder",
        title="Clamped half cylinder, code to code",
        source="measured with CalculiX 2.20 (C3D20R) and FElupe 11.3: 20 nodes, 2 x 2 x 2 points, 7449 unknowns",
    )
    pairs = list(zip(numbers["force_N"], numbers["calculix_N"], strict=True))
    worst = max(pairs, key=lambda pair: abs(pair[0] / pair[1] - 1.0))
    lines = [
        rules.near("felupe", "crown force at 20 mm, FElupe", "N", [pairs[-1][0], numbers["felupe_N"]], 1e-7, 8),
        rules.near("calculix", "crown force, CalculiX, worst of 4 loads", "N", list(worst), 1e-5, 8),
    ]
    return rules.benchmark(numbers, lines, rules.caught("shell 0.1 % thicker", numbers, 1e-3))


def _ring(numbers: Numbers) -> Benchmark:
    rules = Rules(name="ring", title="Ring between plates", source="elastica by quadrature, inextensible")
    error = np.array(numbers["load"]) / np.array(numbers["elastica"]) - 1.0
    k = int(np.argmax(np.abs(error)))
    where = f"load P R²/EI at {100.0 * numbers['compression'][k]:g} % compression, worst of {len(error)}"
    lines = [
        rules.near("load", where, "-", [numbers["load"][k], numbers["elastica"][k]], 0.01),
    ]
    return rules.benchmark(numbers, lines, rules.caught("ring 1 % thicker", numbers, 0.02))


def _hertz(numbers: Numbers) -> Benchmark:
    rules = Rules(name="hertz", title="Hertz line contact", source="Johnson 1985, eqs. 4.43 and 4.45")
    lines = [
        rules.near("half_width", "half width of the contact, worst of 4 meshes", "m", numbers["half_width_m"], 0.01),
        rules.near("peak_pressure", "peak pressure, worst of 4 meshes", "Pa", numbers["peak_pressure_Pa"], 0.01),
    ]
    return rules.benchmark(numbers, lines, rules.caught("radius 20 % larger: half width", numbers, 0.085))


def _sliding_block(numbers: Numbers) -> Benchmark:
    rules = Rules(name="sliding_block", title="Block dragged on a rough plane", source="statics, Coulomb's law")
    lines = [
        rules.near("slide", "tangential force of the sliding block, μN", "N", numbers["slide_N"], 1e-6, 8),
        rules.near("stick", "tangential stiffness while it sticks", "N/m", numbers["stick_N_per_m"], 1e-3, 8),
    ]
    return rules.benchmark(numbers, lines, rules.caught("friction 1 % smaller", numbers, 0.005))


BENCHMARKS: dict[str, Reader] = {
    "patch": _patch,
    "manufactured": _manufactured,
    "end_shear": _end_shear,
    "end_moment": _end_moment,
    "hemisphere": _hemisphere,
    "hinged_roof": _hinged_roof,
    "pulled_cylinder": _pulled_cylinder,
    "half_cylinder": _half_cylinder,
    "ring": _ring,
    "hertz": _hertz,
    "sliding_block": _sliding_block,
}
"""Name -> what its numbers say, in the order of the report."""
