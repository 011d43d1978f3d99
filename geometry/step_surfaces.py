"""B-spline surfaces out of STEP files (ISO 10303-21): control points and knots, which gmsh does not give away.

Read are the ADVANCED_FACEs on a B_SPLINE_SURFACE_WITH_KNOTS (ISO 10303-42), whichever way the face is turned. A
rational surface, a plane, a trimmed face or a part moved by its assembly is refused by name, not passed over.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from geometry.spline_surface import SplineSurface

__all__ = ["read_surfaces_step"]

_INSTANCE = re.compile(r"#(\d+)\s*=\s*((?:'[^']*'|[^';])*);")
_RECORD = re.compile(r"([A-Z_0-9]+)\s*\((.*)\)", re.DOTALL)
_TOKEN = re.compile(r"('[^']*')|#(\d+)|\.[A-Z_0-9]+\.|[$*]|\s+")
_METRE = re.compile(r"LENGTH_UNIT\s*\(\s*\).*SI_UNIT\s*\(\s*(?:\$|\.([A-Z]+)\.)\s*,\s*\.METRE\.\s*\)", re.DOTALL)
_PREFIXES = {None: 1.0, "DECI": 1e-1, "CENTI": 1e-2, "MILLI": 1e-3, "MICRO": 1e-6}
_CORNER_TOLERANCE = 1e-6
"""A face whose vertices lie further than this from its surface's corners is trimmed; relative to the surface's size."""


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
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError as error:
        raise InputError("STEP file", path, f"cannot be read ({error.strerror})", "check the path") from error
    if not text.lstrip().startswith("ISO-10303-21"):
        raise InputError("STEP file", path, "does not begin with ISO-10303-21", "export it as STEP, AP203 or AP214")
    text = re.sub(r"/\*.*?\*/", "", text.partition("DATA;")[2], flags=re.DOTALL)
    model = _Model(path=path, instances={int(n): record.strip() for n, record in _INSTANCE.findall(text)})
    scale = _scale(model)
    _refuse_moved_parts(model)
    names = _names(model)
    surfaces: list[SplineSurface] = []
    for face in model.of("ADVANCED_FACE"):
        surface = _surface(model, model.values(face)[2], names.get(face, f"surface {len(surfaces)}"), scale)
        _refuse_trim(model, face, surface, scale)
        surfaces.append(surface)
    if not surfaces:
        raise model.error("holds no face", "export the surfaces, not a wireframe")
    return tuple(surfaces)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Model:
    """One file: instance number -> text of its record."""

    path: Path
    instances: dict[int, str]

    def keyword(self, number: int) -> str:
        """Name of an instance's entity; empty for a complex one."""
        found = _RECORD.fullmatch(self.instances[number])
        return found[1] if found else ""

    def values(self, number: int) -> tuple[Any, ...]:
        """Parameters: numbers, texts, lists, and references as numbers; enumerations and blanks as None."""
        found = _RECORD.fullmatch(self.instances[number])
        values: tuple[Any, ...] = ast.literal_eval(f"({_TOKEN.sub(_python, found[2])},)") if found else ()
        return values

    def of(self, keyword: str) -> list[int]:
        """Instances of one entity, in the order of the file."""
        return [number for number, text in self.instances.items() if re.match(rf"{keyword}\s*\(", text)]

    def reached(self, start: int, keyword: str) -> list[int]:
        """Instances of one entity that another leads to, through whatever lies between."""
        seen, waiting, found = {start}, [start], []
        while waiting:
            number = waiting.pop()
            if self.keyword(number) == keyword:
                found.append(number)
                continue
            text = re.sub(r"'[^']*'", "", self.instances[number])
            new = {int(n) for n in re.findall(r"#(\d+)", text)} & self.instances.keys() - seen
            seen |= new
            waiting += new
        return sorted(found)

    def error(self, rule: str, hint: str) -> InputError:
        """What is wrong with this file."""
        return InputError("STEP file", self.path, rule, hint)


def _python(token: re.Match[str]) -> str:
    """One token as Python: texts stay, references become numbers, enumerations and blanks None."""
    if token[1] is not None:
        return repr(token[1][1:-1])
    return token[2] or ("None" if token[0].strip() else "")


def _scale(model: _Model) -> float:
    """Metres in the file's unit of length."""
    found = {match[1] for text in model.instances.values() if (match := _METRE.search(text))}
    inch = any("CONVERSION_BASED_UNIT" in text and "LENGTH_UNIT" in text for text in model.instances.values())
    if inch or len(found) != 1 or not found <= _PREFIXES.keys():
        raise model.error("must have one SI unit of length", "export it in millimetres or metres")
    return _PREFIXES[found.pop()]


def _refuse_moved_parts(model: _Model) -> None:
    """Raise InputError if an assembly moves a part: its surfaces would land elsewhere."""
    for transformation in model.of("ITEM_DEFINED_TRANSFORMATION"):
        start, end = (model.values(place)[1:] for place in model.values(transformation)[2:4])
        if [model.values(n)[1] for n in start if n] != [model.values(n)[1] for n in end if n]:
            raise model.error("moves a part in an assembly", "export the assembly as one part, or its parts alone")


def _names(model: _Model) -> dict[int, str]:
    """Face -> name of its product, with a number where the product has several faces."""
    names: dict[int, str] = {}
    for link in model.of("SHAPE_DEFINITION_REPRESENTATION"):
        definition, representation = model.values(link)
        products = model.reached(definition, "PRODUCT")
        faces = [face for face in model.reached(representation, "ADVANCED_FACE") if face not in names]
        for k, face in enumerate(faces if products else []):
            product = model.values(products[0])[0]
            names[face] = f"{product} {k}" if len(faces) > 1 else product
    return names


def _surface(model: _Model, number: int, name: str, scale: float) -> SplineSurface:
    """The surface of one face."""
    kind = model.keyword(number)
    if kind != "B_SPLINE_SURFACE_WITH_KNOTS":
        rule = f"holds {name!r} on a {kind or 'rational B-spline surface'}"
        raise model.error(rule, "convert it to B-spline surfaces without weights")
    _, p, q, points, _, _, _, _, *repeats, knots_u, knots_v, _ = model.values(number)
    ends = [np.repeat(np.asarray(k, dtype=np.float64), n) for k, n in zip((knots_u, knots_v), repeats, strict=True)]
    P = np.array([[model.values(point)[1] for point in row] for row in points], dtype=np.float64)
    return SplineSurface(name=name, control_points=scale * P, degrees=(p, q), knots=(ends[0], ends[1]))


def _refuse_trim(model: _Model, face: int, surface: SplineSurface, scale: float) -> None:
    """Raise InputError unless the face's vertices are its surface's corners."""
    bounds = [vertex for bound in model.values(face)[1:2] for vertex in _vertices(model, bound)]
    vertices = scale * np.array(bounds, dtype=np.float64).reshape(-1, 3)
    (u, v), P = surface.breaks, surface.control_points
    corners = surface.value(np.array([(a, b) for a in u[[0, -1]] for b in v[[0, -1]]]))
    distance = np.linalg.norm(corners[:, None] - vertices[None], axis=-1)
    size = float(np.ptp(P.reshape(-1, 3), axis=0).max())
    if not len(vertices) or max(distance.min(axis=0).max(), distance.min(axis=1).max()) > _CORNER_TOLERANCE * size:
        raise model.error(f"holds {surface.name!r}, which is trimmed", "export whole B-spline surfaces")


def _vertices(model: _Model, bounds: Any) -> list[NDArray[np.float64]]:
    """Positions of a face's vertices, in the file's unit; one bound reads as a number, several as a list."""
    loops = bounds if isinstance(bounds, tuple) else (bounds,)
    vertices = [vertex for loop in loops for vertex in model.reached(loop, "VERTEX_POINT")]
    return [np.asarray(model.values(model.values(vertex)[1])[1]) for vertex in vertices]
