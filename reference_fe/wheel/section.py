"""The planar model of a wheel: the same solver on its section, each strip held across the plane as its width asks.

What it leaves out: the rim's bending along the axle between springs narrower than itself, everything inside the outer
hub, which is held rigidly, and load cases that differ along the axle.
Verified by tests/verification/test_fe_section.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from contracts.errors import InputError
from contracts.mesh import TaggedMesh
from geometry.parts import SpringSet, Tire
from geometry.springs import leg_sides, spring_leg
from geometry.wheel import WheelDesign
from reference_fe.material.plane_state import strip_constraint
from reference_fe.wheel.pressed import WheelLoadCase, WheelResult, solve_wheel

__all__ = ["solve_section", "strip_constraints"]


def solve_section(
    mesh: TaggedMesh,
    design: WheelDesign,
    load_case: WheelLoadCase,
    progress: Callable[[float, float], None] | None = None,
) -> WheelResult:
    """Stiffness curve of a wheel's planar model at one orientation; model name ``"section"``.

    Parameters
    ----------
    mesh : from `geometry.planar.build_planar_mesh`
    design : the same wheel: materials, and dimensions for `strip_constraints`
    load_case, progress : as in `reference_fe.wheel.pressed.solve_wheel`; a load case that says how parts are held
        across the plane keeps its word

    Returns
    -------
    result : loads of the full width; fields (n_points, 2), x and z

    Raises
    ------
    ConvergenceError, InputError
        As `solve_wheel`; InputError for a solid mesh.
    """
    if mesh.dim != 2:
        raise InputError("section mesh", "solid", "must be planar", "use geometry.build_planar_mesh")
    constraint = load_case.transverse_constraint or strip_constraints(design)
    return solve_wheel(mesh, design.materials, replace(load_case, transverse_constraint=constraint), progress)


def strip_constraints(design: WheelDesign) -> dict[str, float]:
    """How rim and springs are held across the plane, part -> constraint [-], see `plane_state.strip_constraint`.

    Each strip counts with its own width, mean thickness and Poisson ratio; the bands of a set are weighted by their
    widths. The other parts are in plane strain.
    """
    tire = design.tire
    found = {"tire": _constraint(tire, tire.width, tire.outer_radius - 0.5 * tire.thickness, tire.thickness)}
    for springs in design.spring_sets:
        radius = _mean_radius(springs, (design.outer_hub.outer_radius, tire.inner_radius))
        widths = np.array([b - a for a, b in springs.bands])
        bands = np.array([_constraint(springs, float(width), radius, springs.mean_thickness) for width in widths])
        found[springs.name] = float(bands @ widths / widths.sum())
    return found


def _constraint(strip: Tire | SpringSet, width: float, radius: float, thickness: float) -> float:
    return strip_constraint(width, radius, thickness, strip.material.poisson_ratio)


def _mean_radius(springs: SpringSet, gap: tuple[float, float]) -> float:
    """Length of a leg over the angle its tangent turns by, left and right turns alike [m]."""
    leg = spring_leg(springs, gap, 0.0, leg_sides(springs)[0])
    cosines = np.einsum("ni,ni->n", leg.normals[1:], leg.normals[:-1])
    turns = np.arccos(np.clip(cosines, -1.0, 1.0))
    return float(leg.length / turns.sum())
