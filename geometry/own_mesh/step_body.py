"""What a STEP file of a wheel holds: its solids and faces, as a user names them and as they are measured.

Verified by tests/unit/test_own_mesh_step.py.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from geometry.own_mesh.file_mesh import FileMesh
from geometry.own_mesh.roles import Placement

__all__ = ["FaceRule", "StepBody", "StepFace", "StepSizes", "StepSolid", "told"]

Array = NDArray[np.float64]
Range = tuple[float, float]

_SAME = 1e-4
"""Relative to the wheel's largest radius: lengths of a face that are taken for the same."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StepSizes:
    """How a STEP file is meshed.

    Attributes
    ----------
    element_size : largest edge of an element [m]
    of_solids : name of solids -> the same for them alone [m]
    around : elements around a full circle of any curved edge or face; 0 for no such limit
    """

    element_size: float
    of_solids: Mapping[str, float]
    around: int


@dataclass(frozen=True, slots=True, kw_only=True)
class FaceRule:
    """Which faces a name stands for; each condition that is given must hold.

    Attributes
    ----------
    solids : names of solids of which it is a face; empty for any
    numbers : of faces, as `told` lists them; empty for any
    radius : every point of the face lies at this distance from the axle, least and largest [m]
    position : every point of it lies there along the axle, from the hub's centre, least and largest [m]
    """

    solids: tuple[str, ...] = ()
    numbers: tuple[int, ...] = ()
    radius: Range | None = None
    position: Range | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class StepSolid:
    """One solid: its number, its name, or the number if it has none, its volume [m^3], and the corners of the box
    around it, (2, 3) in the file's axes [m]."""

    number: int
    name: str
    volume: float
    box: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class StepFace:
    """One face on the outside of the body.

    Attributes
    ----------
    number : counted as the mesher does
    kind : e.g. ``"plane"``, ``"cylinder"``
    solid : name of the one that it bounds
    area : [m^2]
    points : (n, 3) nodes on it in the file's axes [m]
    """

    number: int
    kind: str
    solid: str
    area: float
    points: Array

    def radius(self, placement: Placement) -> Range:
        """Least and largest distance of its nodes from the axle [m]."""
        places = placement.to_wheel(self.points)
        return _range(np.hypot(places[:, 0], places[:, 2]))

    def position(self, placement: Placement) -> Range:
        """Least and largest place of its nodes along the axle [m]."""
        return _range(placement.to_wheel(self.points)[:, 1])


@dataclass(frozen=True, slots=True, kw_only=True)
class StepBody:
    """Solids and outer faces of a STEP file, and its mesh, whose groups of cells have the solids' names and whose
    groups of faces the faces' numbers."""

    file: FileMesh
    solids: Sequence[StepSolid]
    faces: Sequence[StepFace]

    def numbers(self, rule: FaceRule, placement: Placement) -> tuple[int, ...]:
        """Numbers of the faces that a rule stands for.

        Raises
        ------
        InputError
            If there are none, or if it names a solid or a face that is not there.
        """
        known = {solid.name for solid in self.solids}
        for name in rule.solids:
            if name not in known:
                raise InputError("solid", name, f"is not in the file, which has {_words(known)}", "correct the name")
        every = [face.number for face in self.faces]
        for number in rule.numbers:
            if number not in every:
                rule_text = f"is no face on the outside, which are {_spans(every)}"
                raise InputError("face", number, rule_text, "workbench check lists the faces", key="numbers")
        reach = max(face.radius(placement)[1] for face in self.faces)
        found = tuple(face.number for face in self.faces if _holds(rule, face, placement, _SAME * reach))
        if not found:
            raise InputError("rule", "", "holds for no face on the outside", "workbench check lists the faces")
        return found

    def named(self, rules: Mapping[str, FaceRule], placement: Placement) -> FileMesh:
        """The mesh with the groups of faces that rules name; raises InputError as `numbers`, with the rule's name."""
        facets = dict(self.file.facets)
        for name, rule in rules.items():
            try:
                numbers = self.numbers(rule, placement)
            except InputError as error:
                key = f"faces.{name}" + (f".{error.key}" if error.key else "")
                raise InputError(error.what, error.value, error.rule, error.hint, key=key) from error
            facets[name] = [rows for number in numbers for rows in self.file.facets[str(number)]]
        file = self.file
        return FileMesh(
            points=file.points,
            node_numbers=file.node_numbers,
            blocks=file.blocks,
            groups=file.groups,
            facets=facets,
            flat=file.flat,
        )


def told(body: StepBody, placement: Placement) -> list[str]:
    """A line for each solid, and for the faces of a solid that are alike, as a user needs them to name them."""
    lines = []
    for solid in body.solids:
        size = " x ".join(f"{1e3 * length:.4g}" for length in np.ptp(solid.box, axis=0))
        lines.append(f"solid {solid.number}, {solid.name}: {1e6 * solid.volume:.4g} cm^3, {size} mm")
    alike: dict[str, list[StepFace]] = {}
    for face in body.faces:
        words = f"{face.kind}, radius {_millimetres(face.radius(placement))}"
        where = f"position {_millimetres(face.position(placement))}"
        alike.setdefault(f"of {face.solid}: {words}, {where}, {1e4 * face.area:.3g} cm^2", []).append(face)
    for words, faces in alike.items():
        called = "face" if len(faces) == 1 else "faces"
        each = " each" if len(faces) > 1 else ""
        lines.append(f"{called} {_spans([face.number for face in faces])} {words}{each}")
    return lines


def _holds(rule: FaceRule, face: StepFace, placement: Placement, same: float) -> bool:
    """Whether each condition of a rule holds for a face, lengths to ``same`` [m]."""
    within = [(rule.radius, face.radius(placement)), (rule.position, face.position(placement))]
    named = (not rule.solids or face.solid in rule.solids) and (not rule.numbers or face.number in rule.numbers)
    return named and all(
        asked is None or (asked[0] - same <= low and high <= asked[1] + same) for asked, (low, high) in within
    )


def _range(values: Array) -> Range:
    return float(values.min()), float(values.max())


def _millimetres(values: Range) -> str:
    low, high = (f"{round(1e3 * value, 3) + 0.0:.6g}" for value in values)
    return f"{low} mm" if low == high else f"{low} to {high} mm"


def _words(names: Iterable[str]) -> str:
    return ", ".join(sorted(names))


def _spans(numbers: Sequence[int]) -> str:
    """``"1, 4 to 7"``."""
    rows = np.split(np.array(numbers), np.flatnonzero(np.diff(numbers) != 1) + 1)
    return ", ".join(f"{row[0]}" if len(row) == 1 else f"{row[0]} to {row[-1]}" for row in rows)
