"""What a STEP file of a wheel holds: its solids and faces, as a user names them and as they are measured.

Verified by tests/unit/test_own_mesh_step.py.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from geometry.own_mesh.file_mesh import FileMesh
from geometry.own_mesh.roles import AXES, Placement

__all__ = ["FaceRule", "StepBody", "StepFace", "StepSizes", "StepSolid", "named_faces", "told"]

Array = NDArray[np.float64]
Range = tuple[float, float]

_SAME = 1e-4
"""Relative to the wheel's largest radius: lengths of a face that are taken for the same."""
_SMALL = 5e-3
"""Largest radius of a body [m] below which its unit is asked about."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StepSizes:
    """How a STEP file is meshed.

    Attributes
    ----------
    element_size : largest edge of an element [m]
    of_solids : name of solids -> the same for them alone [m]
    around : elements around a full circle of any curved edge or face; 0 for no such limit
    part_of : name of solids -> the part that they belong to, by which a message names their size
    """

    element_size: float
    of_solids: Mapping[str, float]
    around: int
    part_of: Mapping[str, str] = field(default_factory=dict)


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
    """One solid.

    Attributes
    ----------
    number, name : its number, and its name, or the number if it has none
    volume : [m^3]
    box : (2, 3) corners of the box around it in the file's axes [m]
    ends : numbers of the points at which its edges end, by which solids that touch are known
    """

    number: int
    name: str
    volume: float
    box: Array
    ends: frozenset[int] = frozenset()


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
            raise self._held_for_none(rule, placement, _SAME * reach)
        return found

    def _held_for_none(self, rule: FaceRule, placement: Placement, same: float) -> InputError:
        """What a rule that holds for no face asks for, and which faces or which axle come nearest."""
        others = [replace(placement, axle=axis, up=_another(axis)) for axis in AXES if axis != placement.axle]
        axes = [one.axle for one in others if any(_holds(rule, face, one, same) for face in self.faces)]
        across = 1e3 * float(np.ptp(np.concatenate([solid.box for solid in self.solids]), axis=0).max())
        hint = "workbench check lists the faces"
        if 0.5e-3 * across < _SMALL:
            hint = f"the file's body is {across:.3g} mm across: is its unit right?"
        elif axes:
            hint = f'with axle = "{axes[0]}" it holds for some: which of the file\'s axes is the axle?'
        asked = replace(rule, radius=None, position=None)
        there = [face for face in self.faces if _holds(asked, face, placement, same)] or self.faces
        near = sorted(there, key=lambda face: _off(rule, face, placement))[:3]
        words = "; ".join(f"face {face.number} of {face.solid}: {_place(face, placement)}" for face in near)
        return InputError("rule", _asked(rule), f"holds for no face on the outside; the nearest are {words}", hint)

    def numbers_of(self, rules: Mapping[str, FaceRule], placement: Placement) -> dict[str, tuple[int, ...]]:
        """Numbers of the faces that each name stands for; raises InputError as `numbers`, with the rule's name."""
        found = {}
        for name, rule in rules.items():
            try:
                found[name] = self.numbers(rule, placement)
            except InputError as error:
                key = f"faces.{name}" + (f".{error.key}" if error.key else "")
                raise InputError(error.what, error.value, error.rule, error.hint, key=key) from error
        return found

    def require_joined(self, held: Iterable[str]) -> None:
        """Raise InputError for solids that hang on none of those held, given by name, by what they touch."""
        known = {name.casefold() for name in held}
        reached = {solid.number for solid in self.solids if solid.name.casefold() in known}
        ends = {end for solid in self.solids if solid.number in reached for end in solid.ends}
        while more := [one for one in self.solids if one.number not in reached and one.ends & ends]:
            reached |= {one.number for one in more}
            ends |= {end for one in more for end in one.ends}
        loose = [solid for solid in self.solids if solid.number not in reached]
        if loose and reached:
            alone = [one for one in loose if not any(one.ends & other.ends for other in self.solids if other != one)]
            names = ", ".join(f"solid {one.number}, {one.name}" for one in (alone or loose)[:6])
            rule = "touches no other solid" if len(alone) == 1 else "touch no other solid"
            rule = rule if alone else "touch one another, but nothing that hangs on the hub"
            hint = "close the gap in the CAD program, or name what holds them in hub"
            raise InputError("solids", names, rule, hint, key="hub")

    def named(self, rules: Mapping[str, FaceRule], placement: Placement) -> FileMesh:
        """The mesh with the groups of faces that rules name; raises InputError as `numbers_of`."""
        facets = dict(self.file.facets)
        for name, numbers in self.numbers_of(rules, placement).items():
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
        words = f"{face.kind}, {_place(face, placement)}"
        alike.setdefault(f"of {face.solid}: {words}, {1e4 * face.area:.3g} cm^2", []).append(face)
    for words, faces in alike.items():
        called = "face" if len(faces) == 1 else "faces"
        each = " each" if len(faces) > 1 else ""
        lines.append(f"{called} {_spans([face.number for face in faces])} {words}{each}")
    return lines


def named_faces(body: StepBody, numbers: Mapping[str, Sequence[int]], part_of: Mapping[str, str]) -> list[str]:
    """A line for each name of faces: the numbers it stands for, by part.

    numbers : name -> numbers of faces; part_of : name of solids -> their part
    """
    known = {solid.casefold(): part for solid, part in part_of.items()}
    owner = {face.number: known.get(face.solid.casefold(), face.solid) for face in body.faces}
    lines = []
    for name, mine in numbers.items():
        parts = {owner[number]: [one for one in mine if owner[one] == owner[number]] for number in mine}
        words = ", ".join(f"{_spans(faces)} of {part}" for part, faces in parts.items())
        lines.append(f"{name}: {'face' if len(mine) == 1 else 'faces'} {words}")
    return lines


def _holds(rule: FaceRule, face: StepFace, placement: Placement, same: float) -> bool:
    """Whether each condition of a rule holds for a face, lengths to ``same`` [m]."""
    within = [(rule.radius, face.radius(placement)), (rule.position, face.position(placement))]
    named = (not rule.solids or face.solid in rule.solids) and (not rule.numbers or face.number in rule.numbers)
    return named and all(
        asked is None or (asked[0] - same <= low and high <= asked[1] + same) for asked, (low, high) in within
    )


def _off(rule: FaceRule, face: StepFace, placement: Placement) -> float:
    """How far a face lies outside a rule's lengths [m]."""
    within = [(rule.radius, face.radius(placement)), (rule.position, face.position(placement))]
    return sum(max(0.0, asked[0] - low) + max(0.0, high - asked[1]) for asked, (low, high) in within if asked)


def _asked(rule: FaceRule) -> str:
    """What a rule says, in words."""
    words = [f"of {', '.join(rule.solids)}"] if rule.solids else []
    words += [f"numbers {_spans(sorted(rule.numbers))}"] if rule.numbers else []
    words += [f"radius {_millimetres(rule.radius)}"] if rule.radius else []
    return ", ".join(words + ([f"position {_millimetres(rule.position)}"] if rule.position else []))


def _place(face: StepFace, placement: Placement) -> str:
    return f"radius {_millimetres(face.radius(placement))}, position {_millimetres(face.position(placement))}"


def _another(axis: str) -> str:
    return next(one for one in AXES if one != axis)


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
