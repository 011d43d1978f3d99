"""Cost against the number of plates and of contact points."""

from __future__ import annotations

from dataclasses import replace

from ancf_reduced.tire.preset import refined_preset, thesis_preset
from benchmarks.flexible_rows.cases import STRAIGHT, driven, rover, row
from benchmarks.flexible_rows.kernels import kernel_times

__all__ = ["plate_rows", "point_rows"]

PLATES = {8: (4, 1), 16: (8, 2), 32: (16, 4), 64: (32, 8), 128: (64, 16)}
"""Plates of a tire: those around, and those of each spoke."""
POINTS = (5, 10, 20)
STIFFER, LIGHTER, END, TOLERANCE = 10.0, 0.8, 1.0, 1e-5
"""Tires of more plates are softer, fold under the rover, and are heavier than its wheels (a rim of few plates is no
circle); with this modulus and density over the thesis' they stand and fit."""


def plate_rows() -> list[dict[str, object]]:
    """Kernels, and one second of the straight path, on tires of more plates at one stiffness of the material."""
    rows = []
    for plates, (around, spoke) in PLATES.items():
        preset = refined_preset(thesis_preset(), around, spoke)
        preset = replace(preset, young_modulus=STIFFER * preset.young_modulus, density=LIGHTER * preset.density)
        vehicle, case = rover(STRAIGHT, preset), f"{plates} plates a tire, modulus {STIFFER:g} times"
        times, motion = kernel_times(vehicle), driven(vehicle, END, TOLERANCE)
        rows += [
            row(case, "free vectors of a tire", "-", len(vehicle.tires.mass) - 4),
            row(case, "all forces", "us", times["all forces"]),
            row(case, "all tangents, as blocks", "us", times["all tangents, as blocks"]),
            row(case, "condensation", "us", times["condensation"]),
            row(case, "processor time of a second", "s", motion.seconds / END),
            row(case, "Newton iterations, settling included", "-", motion.motion.iterations),
            row(case, "linearisations, settling included", "-", motion.motion.linearisations),
        ]
    return rows


def point_rows() -> list[dict[str, object]]:
    """The thesis' tire with more or fewer contact points of the same stiffness for an area."""
    rows = []
    for points in POINTS:
        stiffness = thesis_preset().contact_stiffness * (10.0 / points) ** 2
        preset = replace(thesis_preset(), contact_points=(points, points), contact_stiffness=stiffness)
        vehicle, case = rover(STRAIGHT, preset), f"{points} x {points} points a plate"
        times, motion = kernel_times(vehicle), driven(vehicle, END, TOLERANCE)
        rows += [
            row(case, "contact force", "us", times["contact force"]),
            row(case, "contact tangents", "us", times["contact tangents"]),
            row(case, "processor time of a second", "s", motion.seconds / END),
        ]
    return rows
