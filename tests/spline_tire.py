"""A tire drawn as B-spline patches, as a designer would: a closed ring of cubic arcs and flat spokes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ancf_reduced.plates.mesh import PlateMesh, build_plate_mesh
from ancf_reduced.plates.spline_plates import plates_on_surface
from ancf_reduced.tire.mesh import RIM, SPOKE
from ancf_reduced.tire.preset import TirePreset
from contracts.frames import ground_direction_h
from geometry.spline_surface import SplineSurface

__all__ = ["ring", "spline_mesh", "spokes"]


def ring(preset: TirePreset, arcs: int) -> SplineSurface:
    """Mid-surface of the rim: one cubic per arc with the tangent (4/3) tan(alpha/4) R, double knots, linear across."""
    angle = 2.0 * np.pi / arcs
    handle = 4.0 / 3.0 * np.tan(angle / 4.0) * preset.rim_radius
    line = [preset.rim_radius * ground_direction_h(0.0)]
    for k in range(arcs):
        for phi, sign in ((k * angle, 1.0), ((k + 1) * angle, -1.0)):
            tangent = ground_direction_h(phi + 0.5 * np.pi)
            line.append(preset.rim_radius * ground_direction_h(phi) + sign * handle * tangent)
    line.append(line[0])
    half_width = np.array([0.0, 0.5 * preset.width, 0.0])
    points = np.stack([np.array(line) + half_width, np.array(line) - half_width], axis=1)
    knots = np.concatenate([[0.0] * 4, np.repeat(np.arange(1.0, arcs), 2), [arcs] * 4])
    return SplineSurface(
        name="ring", control_points=points, degrees=(3, 1), knots=(knots, np.array([0.0, 0.0, 1.0, 1.0]))
    )


def spoke(preset: TirePreset, phi: float) -> SplineSurface:
    """Mid-surface of the spoke at phi [rad], from the hub to the rim's mid-surface: degree 1 both ways."""
    ends = np.outer([preset.hub_radius, preset.rim_radius], ground_direction_h(phi))
    half_width = np.array([0.0, 0.5 * preset.width, 0.0])
    knots = np.array([0.0, 0.0, 1.0, 1.0])
    points = np.stack([ends + half_width, ends - half_width], axis=1)
    return SplineSurface(
        name=f"spoke at {np.degrees(phi):.0f} deg", control_points=points, degrees=(1, 1), knots=(knots, knots)
    )


def spokes(preset: TirePreset) -> list[SplineSurface]:
    """The preset's spokes, the first straight down."""
    return [spoke(preset, 2.0 * np.pi * k / preset.spokes) for k in range(preset.spokes)]


def spline_mesh(preset: TirePreset, rim: SplineSurface, spokes: Sequence[SplineSurface]) -> PlateMesh:
    """Plates of the ring and of the spokes."""
    patches = list(plates_on_surface(rim, preset.rim_thickness, part=RIM).patches)
    for surface in spokes:
        patches += plates_on_surface(surface, preset.spoke_thickness, part=SPOKE).patches
    return build_plate_mesh(patches)
