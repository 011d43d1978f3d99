"""What the benchmarks of ANCF plates measured against what is known; tolerances are those of tests/verification.

Verified by tests/unit/test_workbench_verification_ancf.py.
"""

from __future__ import annotations

from workbench.questions.verification.lines import Benchmark, Line, Numbers, Reader, Rules

__all__ = ["ANCF_BENCHMARKS"]

_SZE = "Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569, section"


def _plate(numbers: Numbers) -> Benchmark:
    rules = Rules(
        name="ancf_plate",
        title="One plate",
        source="exact quadrature; agrees with Project Chrono's published 3443 shell to 1e-11",
    )
    lines = [
        rules.at_most(key, f"{key.replace('_', ' ')}, error over largest entry", "-", numbers[key], 5e-12)
        for key in ("mass", "gravity", "elastic_force")
    ]
    damage = "one sign of thesis eq. 2.13 misread: smallest error"
    control = rules.caught(damage, numbers, 1e-6, "value")
    return rules.benchmark(numbers, lines, control, max(numbers[key] for key in ("mass", "gravity", "elastic_force")))


def _pendulum(numbers: Numbers) -> Benchmark:
    rules = Rules(
        name="ancf_pendulum",
        title="Falling plate pendulum",
        source="data of Mikkola & Shabana 2003; computed anew with exact quadrature and DOP853",
    )
    lines = [
        rules.at_most("path", "largest distance from the path in 0.4 s", "m", numbers["error_m"], 1e-5),
        rules.at_most("energy", "spread of the energy over the largest kinetic one", "-",
                      numbers["energy_spread"], 1e-6),
        rules.order("energy_order", "order of the energy's error in the time step", numbers["energy_order"], 2.0),
    ]  # fmt: skip
    control = rules.caught("4 x 4 x 2 Gauss points", numbers, 1e-4, "value", "m")
    return rules.benchmark(numbers, lines, control, numbers["error_m"])


def _self_weight(numbers: Numbers) -> Benchmark:
    rules = Rules(
        name="ancf_self_weight",
        title="Plate under its own weight",
        source="elastica; Liu, Tian & Hu 2011 give 40.3 mm from a commercial code",
    )
    lines = [
        rules.near("drop", "drop of the tip, 32 plates", "m", numbers["drop_m"], 1.5e-3),
        rules.near("tip_x", "where the tip comes to", "m", numbers["tip_x_m"], 2e-5),
        rules.order_at_least("order", "order of the drop's error", numbers["order"], 2.0),
    ]
    return rules.benchmark(numbers, lines, rules.caught("modulus 1 % low", numbers, 1.5e-3))


def _bending(numbers: Numbers) -> Benchmark:
    rules = Rules(
        name="ancf_bending",
        title="Narrow cantilever, 1 N, Poisson locking relieved",
        source="beam theory, P L³ / (3 E I); plate theory, E / (1 - ν²)",
    )
    lines = [
        rules.near("relieved", "deflection, 32 plates, ν = 0.33, locking relieved", "m", numbers["relieved_m"], 3e-3),
        rules.near("held_flat", "the same, held flat across its width", "m", numbers["held_flat_m"], 3e-3),
        rules.near("straight", "deflection, ν = 0, the element as it is", "m", numbers["straight_m"], 3e-3),
    ]
    return rules.benchmark(numbers, lines, rules.caught("ν = 0.33, the element as it is", numbers, 0.05))


def _end_shear(numbers: Numbers) -> Benchmark:
    rules = Rules(name="ancf_end_shear", title="Cantilever strip, end shear force", source=f"{_SZE} 3.1")
    control = rules.caught("strip 2 % thicker", numbers, 5e-3)
    return _end_load(rules, numbers, "deflection", 1e-3, control)


def _end_moment(numbers: Numbers) -> Benchmark:
    rules = Rules(name="ancf_end_moment", title="Strip rolled to a circle", source=f"{_SZE} 3.2; exact circle")
    control = rules.caught("a moment that keeps its direction, 24 plates, a quarter of it", numbers, 0.05)
    return _end_load(rules, numbers, "shortening", 5e-3, control)


def _end_load(rules: Rules, numbers: Numbers, what: str, tolerance: float, control: Line) -> Benchmark:
    plates = next(reversed(numbers["meshes"]))
    lines = [
        rules.near("full_load", f"{what} of the end at full load, {plates}", "-", numbers["full"], tolerance),
        rules.at_most("path", f"distance over length, {len(numbers['load'])} points of the path", "-",
                      numbers["path_error"], tolerance, "difference"),
        rules.order_at_least("order", "order of the path's error", numbers["order"], 2.5),
    ]  # fmt: skip
    return rules.benchmark(numbers, lines, control, numbers["path_error"])


def _frames(numbers: Numbers) -> Benchmark:
    rules = Rules(name="ancf_frames", title="Frames that share corner nodes", source="unit-load theorem, bending only")
    lines = [
        rules.near(name.replace(" ", "_"), f"drop of the loaded arm, {name}, 8 plates a leg", "m", pair, 0.01)
        for name, pair in numbers["drop_m"].items()
    ]
    return rules.benchmark(numbers, lines, rules.caught("L, 2 % thicker", numbers, 0.04))


def _frequencies(numbers: Numbers) -> Benchmark:
    rules = Rules(
        name="ancf_frequencies",
        title="Natural frequencies",
        source="Euler-Bernoulli cantilever; free thin ring, Love 1944, art. 293",
    )
    kinds = (("cantilever", "cantilever, 24 plates, bending mode", 1), ("ring", "free ring, 48 plates, n =", 2))
    lines = [
        rules.near(f"{key}_{k}", f"{what} {k}", "Hz", [found, expected], 5e-3)
        for key, what, first in kinds
        for k, (found, expected) in enumerate(zip(*numbers[f"{key}_Hz"], strict=True), start=first)
    ]
    lines.append(rules.order_at_least("order", "order of the ring's error", numbers["order"], 3.5))
    control = rules.caught("ring 2 % thicker: smallest error", numbers, 0.01)
    return rules.benchmark(numbers, lines, control, numbers["ring_error"])


def _arch(numbers: Numbers) -> Benchmark:
    rules = Rules(
        name="ancf_arch",
        title="Clamped arch of rim plates",
        source="512 straight Timoshenko beams, terms of (t/R)² left out",
    )
    pair = numbers["stiffness_N_per_m"]
    lines = [
        rules.near("stiffness", "line load at the crown over its drop, 32 plates", "N/m", pair, 0.015),
        rules.order_at_least("order", "order of the differences between meshes", numbers["order"], 1.4),
    ]
    return rules.benchmark(numbers, lines, rules.caught("arch 4 % thinner", numbers, 0.015))


ANCF_BENCHMARKS: dict[str, Reader] = {
    "ancf_plate": _plate,
    "ancf_pendulum": _pendulum,
    "ancf_self_weight": _self_weight,
    "ancf_bending": _bending,
    "ancf_end_shear": _end_shear,
    "ancf_end_moment": _end_moment,
    "ancf_frames": _frames,
    "ancf_frequencies": _frequencies,
    "ancf_arch": _arch,
}
"""Name -> what its numbers say, in the order of the report."""
