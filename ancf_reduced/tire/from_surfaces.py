"""Plates of a tire from named B-spline surfaces, as a CAD program or `spline_plates.plate_surfaces` writes them.

A name says what its surface is. It begins with ``rim`` or ``spoke``, the part; one that ends with ``lower`` or
``upper`` is a face of the surface that is named alike or ends with ``middle``; all others are mid-surfaces. These give
the plates, one per polynomial piece; the preset gives their thickness and everything else. Faces are not needed: where
they are given they must lie where the preset's thickness puts them.

Verified by tests/unit/test_ancf_surface_tire.py and tests/unit/test_workbench_study_surfaces.py.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ancf_reduced.plates.mesh import PlateMesh, PlatePatch, build_plate_mesh
from ancf_reduced.plates.spline_plates import plates_between, plates_on_surface
from ancf_reduced.tire.preset import HUB_REACH, RIM, SPOKE, TirePreset
from contracts.errors import InputError
from geometry.spline_surface import SplineSurface

__all__ = ["JOINED", "SIZE_TOLERANCE", "surface_mesh"]

FloatArray = NDArray[np.float64]
JOINED = 1e-6
"""Corners closer than this share a node, and faces may lie off by so much [m]."""
SIZE_TOLERANCE = 0.01
"""How far radius and width of the surfaces may differ from the preset's, relative: room for another cubic's arcs."""
_NAME = re.compile(r"(?P<part>rim|spoke)(?P<rest>.*?)\W*(?P<face>lower|middle|upper)?\s*", re.IGNORECASE | re.DOTALL)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Plates:
    """Plates of one mid-surface, and the name to tell a user."""

    name: str
    patches: tuple[PlatePatch, ...]


def surface_mesh(surfaces: Sequence[SplineSurface], preset: TirePreset) -> PlateMesh:
    """The tire's plates in the wheel frame, for `tire.mesh.tire_on_mesh`.

    Parameters
    ----------
    surfaces : in metres, axle along y through the origin; u and v of the rim such that r_u x r_v points outwards. u is
        the direction of the first count of contact points
    preset : thickness; outer radius, width and numbers of plates that the surfaces must have; hub radius within which
        corners belong to the hub

    Raises
    ------
    InputError
        For a name that says no part, a face without mid-surface or at another thickness, a surface outside the plate's
        space (degree above 3, doubly curved), a rim turned inside out, a tire of another size or other numbers of
        plates, surfaces that do not join.
    """
    plates = _plates(surfaces, preset)
    _check_rim(plates)
    _check_size(plates, preset)
    mesh = build_plate_mesh([patch for each in plates for patch in each.patches], JOINED)
    _check_joined(mesh, [each.name for each in plates for _ in each.patches], preset.hub_radius)
    return mesh


def _plates(surfaces: Sequence[SplineSurface], preset: TirePreset) -> list[_Plates]:
    """Plates on every mid-surface, rim first, each in the order given."""
    middles, faces = dict[tuple[str, str], SplineSurface](), dict[tuple[str, str], dict[str, SplineSurface]]()
    for surface in surfaces:
        part, rest, face = _read_name(surface.name)
        group = faces.setdefault((part, rest), {}) if face in ("lower", "upper") else None
        if (part, rest) in middles if group is None else face in group:
            raise InputError("surface", repr(surface.name), "has the name of another one", "give each its own")
        if group is None:
            middles[part, rest] = surface
        else:
            group[face] = surface
    for key, group in faces.items():
        if key not in middles:
            name = next(iter(group.values())).name
            rule = "is a face without its mid-surface"
            raise InputError("surface", repr(name), rule, "add the mid-surface, the same name with 'middle'")
    found = []
    for (part, rest), surface in sorted(middles.items(), key=lambda item: item[0][0] != RIM):
        thickness = preset.rim_thickness if part == RIM else preset.spoke_thickness
        patches = plates_on_surface(surface, thickness, part=part).patches
        _check_faces(surface.name, patches, faces.get((part, rest), {}), thickness)
        found.append(_Plates(name=surface.name, patches=patches))
    return found


def _read_name(name: str) -> tuple[str, str, str]:
    """Part, what tells it from others, and face ('' for a mid-surface) of a surface's name."""
    found = _NAME.fullmatch(name)
    if not found:
        rule = f"must have a name that begins with {RIM} or {SPOKE}"
        raise InputError("surface", repr(name), rule, "rename its part where it was drawn")
    return found["part"].lower(), found["rest"].strip().lower(), (found["face"] or "").lower().replace("middle", "")


def _check_faces(
    name: str, patches: Sequence[PlatePatch], faces: Mapping[str, SplineSurface], thickness: float
) -> None:
    """Raise InputError if the faces given are not those of the plates."""
    if not faces:
        return
    if len(faces) < 2:
        rule = "has one face of two"
        raise InputError("surface", repr(name), rule, "give the lower and the upper one, or none")
    between = plates_between(faces["lower"], faces["upper"], part=patches[0].part, tolerance=JOINED).patches
    off = np.inf
    if len(between) == len(patches):
        off = max(float(np.abs(_frame(a) - _frame(b)).max()) for a, b in zip(between, patches, strict=True))
    if off > JOINED:
        rule = f"has faces that are not those of a plate of {1e3 * thickness:g} mm on it"
        hint = "set the part's thickness to the file's, or leave the faces out; a deformed tire cannot be a reference"
        raise InputError("surface", repr(name), rule, hint)


def _frame(patch: PlatePatch) -> FloatArray:
    """Corners and J0 diag(a, b, t), (4, 4, 3) [m]."""
    frame = np.swapaxes(patch.gradients * patch.dimensions, 1, 2)
    return np.concatenate([patch.corners[:, None], frame], axis=1)


def _check_rim(plates: Sequence[_Plates]) -> None:
    """Raise InputError for a rim whose directors do not point away from the axle."""
    for each in plates:
        for patch in each.patches if each.patches[0].part == RIM else ():
            if not np.all(np.sum(patch.gradients[:, ::2, 2] * patch.corners[:, ::2], axis=1) > 0.0):
                rule = "must have its normal r_u x r_v away from the axle, which is y through the origin"
                raise InputError("surface", repr(each.name), rule, "reverse u or v, or turn the wheel")


def _check_size(plates: Sequence[_Plates], preset: TirePreset) -> None:
    """Raise InputError for other dimensions or numbers of plates than the preset has."""
    patches = [patch for each in plates for patch in each.patches]
    rim = [patch for patch in patches if patch.part == RIM]
    if not rim:
        raise InputError("surfaces", len(patches), f"must have one whose name begins with {RIM}", "name the rim's so")
    corners = np.concatenate([patch.corners for patch in rim])
    radius = float(np.hypot(corners[:, 0], corners[:, 2]).max()) + 0.5 * preset.rim_thickness
    sizes = [("outer radius", radius, preset.outer_radius), ("width", float(np.ptp(corners[:, 1])), preset.width)]
    for what, found, wanted in sizes:
        if abs(found - wanted) > SIZE_TOLERANCE * wanted:
            rule = f"must be {1e3 * wanted:g} mm, the tire's, to {SIZE_TOLERANCE:.0%}"
            hint = "correct the number in [ancf], the unit of the file, or the axle, which is y through the origin"
            raise InputError(f"{what} of the surfaces", f"{1e3 * found:.4g} mm", rule, hint)
    counts = [
        ("rim plates", len(rim), preset.circumferential_plates),
        ("spoke plates", len(patches) - len(rim), preset.spokes * preset.plates_per_spoke),
    ]
    for what, number, stated in counts:
        if number != stated:
            rule = f"must be {stated}, as the tire has; each polynomial piece of a surface is one"
            hint = "correct circumferential_plates, spokes or plates_per_spoke in [ancf]"
            raise InputError(f"{what} of the surfaces", number, rule, hint)


def _check_joined(mesh: PlateMesh, names: Sequence[str], hub_radius: float) -> None:
    """Raise InputError unless every corner is another plate's too, or the hub's, and all plates hang together."""
    on_hub = np.hypot(mesh.points[:, 0], mesh.points[:, 2]) <= hub_radius + HUB_REACH
    if not on_hub.any():
        rule = "must be reached by a surface's corner"
        raise InputError("hub radius", f"{1e3 * hub_radius:g} mm", rule, "correct hub_radius, or extend the spokes")
    alone = np.flatnonzero((np.bincount(mesh.elements.ravel()) < 2) & ~on_hub)
    if len(alone):
        plate = int(np.argwhere(mesh.elements == alone[0])[0, 0])
        where = ", ".join(f"{1e3 * x:.4g}" for x in mesh.points[alone[0]])
        rule = f"does not join: its corner at ({where}) mm is no other's, and not within the hub radius"
        hint = f"let surfaces that meet share corners to {1e3 * JOINED:g} mm; split a surface where another meets it"
        raise InputError("surface", repr(names[plate]), rule, hint)
    nodes = np.where(on_hub, len(mesh.points), np.arange(len(mesh.points)))[mesh.elements]
    i, j = np.repeat(nodes[:, 0], 4), nodes.ravel()
    size = len(mesh.points) + 1
    _, group = connected_components(coo_array((np.ones(len(i)), (i, j)), shape=(size, size)), directed=False)
    apart = np.flatnonzero(group[nodes[:, 0]] != group[-1])
    if len(apart):
        raise InputError("surface", repr(names[apart[0]]), "does not hang on the hub", "add the spokes that carry it")
