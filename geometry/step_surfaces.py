"""B-spline surfaces out of STEP files (ISO 10303-21): control points and knots, which gmsh does not give away.

Read are the ADVANCED_FACEs on a B_SPLINE_SURFACE_WITH_KNOTS (ISO 10303-42), whichever way the face is turned. A
rational surface, a plane, a trimmed face or a part moved by its assembly is refused by name, not passed over, and so is
what no tire has: counts, degrees, places and knots are judged before anything is made of them.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from geometry.spline_surface import SplineSurface
from geometry.step_records import StepRecords, read_step_records

__all__ = ["read_surfaces_step"]

_METRE = re.compile(r"LENGTH_UNIT\s*\(\s*\).*SI_UNIT\s*\(\s*(?:\$|\.([A-Z]+)\.)\s*,\s*\.METRE\.\s*\)", re.DOTALL)
_PREFIXES = {None: 1.0, "DECI": 1e-1, "CENTI": 1e-2, "MILLI": 1e-3, "MICRO": 1e-6}
_CORNER_TOLERANCE = 1e-6
"""A face whose vertices lie further than this from its surface's corners is trimmed; relative to the surface's size."""
_MOST_FACES = 3000
"""A tire of a thousand plates, each with both faces and the one between."""
_MOST_POINTS = 100_000
"""Control points of all surfaces."""
_HIGHEST_DEGREE = 25
"""Of CAD systems; OpenCASCADE's own limit."""
_FARTHEST = 1000.0
"""Largest coordinate [m]."""
_LARGEST_KNOT, _SMALLEST_SPAN = 1e9, 1e-9
"""Largest knot [-], and smallest distance of two that differ, relative to the range of all."""
_LONGEST_NAME, _LONGEST_UNIT = 200, 1000
"""Characters."""


def read_surfaces_step(path: Path) -> tuple[SplineSurface, ...]:
    """Read the surface of every face, in the order of the file, in metres.

    Parameters
    ----------
    path : STEP file of whole faces on B-spline surfaces without weights, in an SI unit of length

    Returns
    -------
    surfaces : named as their product in the file; where a product has several, ``"{product} {k}"``, k = 0, 1, ...

    Raises
    ------
    InputError
        If the file cannot be read, is not STEP or holds no face; for faces that are trimmed or lie on other surfaces,
        rational ones among them; for parts moved by their assembly; for other units.

    Verified by tests/unit/test_geometry_step_surfaces.py and tests/verification/test_ancf_spline_step.py.
    """
    records = read_step_records(path)
    try:
        return _surfaces(records)
    except InputError:
        raise
    except (IndexError, TypeError, ValueError, OverflowError) as error:  # a record with other parameters than its name
        rule = f"has a record that does not fit its name ({str(error)[:80]})"
        raise records.error(rule, "export it again") from error


def _surfaces(model: StepRecords) -> tuple[SplineSurface, ...]:
    """The surface of every face."""
    scale = _scale(model)
    _refuse_moved_parts(model)
    faces = model.of("ADVANCED_FACE")
    if not faces:
        raise model.error("holds no face", "export the surfaces, not a wireframe")
    if len(faces) > _MOST_FACES:
        rule = f"holds {len(faces)} faces, more than {_MOST_FACES}"
        raise model.error(rule, "export the surfaces of the tire alone")
    names, surfaces, points = _names(model), list[SplineSurface](), 0
    for face in faces:
        surface = _surface(model, model.values(face)[2], names.get(face, f"surface {len(surfaces)}"), scale)
        points += surface.control_points.size // 3
        if points > _MOST_POINTS:
            raise model.error(f"holds more than {_MOST_POINTS} control points", "approximate it by coarser surfaces")
        _refuse_trim(model, face, surface, scale)
        surfaces.append(surface)
    return tuple(surfaces)


def _scale(model: StepRecords) -> float:
    """Metres in the file's unit of length."""
    units = [text for text in model.instances.values() if "LENGTH_UNIT" in text and len(text) < _LONGEST_UNIT]
    found = {match[1] for text in units if (match := _METRE.search(text))}
    inch = any("CONVERSION_BASED_UNIT" in text for text in units)
    if inch or len(found) != 1 or not found <= _PREFIXES.keys():
        raise model.error("must have one SI unit of length", "export it in millimetres or metres")
    return _PREFIXES[found.pop()]


def _refuse_moved_parts(model: StepRecords) -> None:
    """Raise InputError if an assembly moves a part: its surfaces would land elsewhere."""
    for transformation in model.of("ITEM_DEFINED_TRANSFORMATION"):
        start, end = (model.values(place)[1:] for place in model.values(transformation)[2:4])
        if [model.values(n)[1] for n in start if n] != [model.values(n)[1] for n in end if n]:
            raise model.error("moves a part in an assembly", "export the assembly as one part, or its parts alone")


def _names(model: StepRecords) -> dict[int, str]:
    """Face -> name of its product, with a number where the product has several faces."""
    names: dict[int, str] = {}
    for link in model.of("SHAPE_DEFINITION_REPRESENTATION"):
        definition, representation = model.values(link)
        products = model.reached(definition, "PRODUCT")
        faces = [face for face in model.reached(representation, "ADVANCED_FACE") if face not in names]
        for k, face in enumerate(faces if products else []):
            product = model.values(products[0])[0]
            if not isinstance(product, str) or len(product) > _LONGEST_NAME or not product.isprintable():
                rule = f"has a product whose name is no line of text: {str(product)[:60]!r}"
                raise model.error(rule, f"name it with 1 to {_LONGEST_NAME} letters")
            names[face] = f"{product} {k}" if len(faces) > 1 else product
    return names


def _surface(model: StepRecords, number: int, name: str, scale: float) -> SplineSurface:
    """The surface of one face."""
    kind = model.keyword(number)
    if kind != "B_SPLINE_SURFACE_WITH_KNOTS":
        rule = f"holds {name!r} on a {kind or 'rational B-spline surface'}"
        raise model.error(rule, "convert it to B-spline surfaces without weights")
    _, p, q, points, _, _, _, _, *repeats, knots_u, knots_v, _ = model.values(number)
    count = len(points) * len(points[0])
    if count > _MOST_POINTS or not all(type(d) is int and 1 <= d <= _HIGHEST_DEGREE for d in (p, q)):
        rule = f"holds {name!r} with {count} control points of degrees {p}, {q}"
        hint = f"use at most {_MOST_POINTS} points and degrees 1 to {_HIGHEST_DEGREE}"
        raise model.error(rule, hint)
    ends = [_knots(model, name, k, n) for k, n in zip((knots_u, knots_v), repeats, strict=True)]
    P = scale * np.array([[model.values(point)[1] for point in row] for row in points], dtype=np.float64)
    if not np.all(np.abs(P) <= _FARTHEST):
        rule = f"holds {name!r} with a control point beyond {_FARTHEST:g} m"
        raise model.error(rule, "check its unit of length")
    return SplineSurface(name=name, control_points=P, degrees=(p, q), knots=(ends[0], ends[1]))


def _knots(model: StepRecords, name: str, distinct: Any, repeats: Any) -> NDArray[np.float64]:
    """Every knot as often as it is repeated."""
    values = np.asarray(distinct, dtype=np.float64)
    spans = np.diff(values)
    if not np.all(np.abs(values) <= _LARGEST_KNOT) or np.any(spans <= _SMALLEST_SPAN * np.ptp(values)):
        rule = f"holds {name!r} with knots that do not increase, lie too close or are no numbers"
        raise model.error(rule, "export it again with knots from 0 to 1")
    if not all(type(n) is int and 1 <= n <= _HIGHEST_DEGREE + 1 for n in repeats):
        rule = f"holds {name!r} with knots repeated {repeats} times"
        raise model.error(rule, f"repeat each 1 to {_HIGHEST_DEGREE + 1} times")
    return np.repeat(values, repeats)


def _refuse_trim(model: StepRecords, face: int, surface: SplineSurface, scale: float) -> None:
    """Raise InputError unless the face's vertices are its surface's corners."""
    bounds = [vertex for bound in model.values(face)[1:2] for vertex in _vertices(model, bound)]
    vertices = scale * np.array(bounds, dtype=np.float64).reshape(-1, 3)
    (u, v), P = surface.breaks, surface.control_points
    corners = surface.value(np.array([(a, b) for a in u[[0, -1]] for b in v[[0, -1]]]))
    distance = np.linalg.norm(corners[:, None] - vertices[None], axis=-1)
    size = float(np.ptp(P.reshape(-1, 3), axis=0).max())
    if not len(vertices) or max(distance.min(axis=0).max(), distance.min(axis=1).max()) > _CORNER_TOLERANCE * size:
        raise model.error(f"holds {surface.name!r}, which is trimmed", "export whole B-spline surfaces")


def _vertices(model: StepRecords, bounds: Any) -> list[NDArray[np.float64]]:
    """Positions of a face's vertices, in the file's unit; one bound reads as a number, several as a list."""
    loops = bounds if isinstance(bounds, tuple) else (bounds,)
    vertices = [vertex for loop in loops for vertex in model.reached(loop, "VERTEX_POINT")]
    return [np.asarray(model.values(model.values(vertex)[1])[1]) for vertex in vertices]
