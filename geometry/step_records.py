"""Records of a STEP file (ISO 10303-21, the exchange structure): number -> keyword and parameters, within limits.

The text is split once from front to back, parameters are taken apart only where they are asked for, and both take time
in proportion to the file: no bracket in bracket, reference in a circle or comment without end makes them longer.
Nothing a file names is opened. References to other files are refused: their shapes would be missing without a word.

Verified by tests/unit/test_geometry_step_hostile.py and tests/unit/test_geometry_step_surfaces.py.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from contracts.errors import InputError
from contracts.input_file import input_bytes

__all__ = ["StepRecords", "read_step_records"]

_LARGEST = 30_000_000
"""Size of a file [byte]; a tire of 48 plates with all faces has 0.4 MB."""
_MOST_RECORDS = 300_000
_LONGEST = 1_000_000
"""Characters of one record, a surface of a hundred control points each way with room to spare."""
_DEEPEST = 16
"""Brackets in brackets; two are the most a B-spline surface has."""
_MOST_STEPS = 1_000_000
"""References that are followed in all; a tire of 48 plates needs 40 000."""
_BREAK = re.compile(r"'[^']*(?:'|\Z)|/\*.*?(?:\*/|\Z)|;", re.DOTALL)
_INSTANCE = re.compile(r"#(\d{1,18})\s*=\s*(.*)", re.DOTALL)
_RECORD = re.compile(r"([A-Z_0-9]+)\s*\((.*)\)", re.DOTALL)
_TOKEN = re.compile(
    r"\s*(?:(?P<text>'(?:[^']|'')*')|\#(?P<reference>\d{1,18})"
    r"|(?P<real>[-+]?\d+(?:\.\d*(?:[Ee][-+]?\d+)?|[Ee][-+]?\d+))|(?P<integer>[-+]?\d{1,18})(?!\d)"
    r"|(?P<blank>\.[A-Z_0-9]+\.|[$*]|\"[0-9A-F]*\")|(?P<kind>[A-Z_][A-Z_0-9]*(?=\s*\())|(?P<mark>[(),]))\s*"
)
_TEXT = re.compile(r"'[^']*'")
_REFERENCE = re.compile(r"#(\d{1,18})")
_OTHER_FILES = ("DOCUMENT_FILE", "EXTERNAL_SOURCE", "EXTERNALLY_DEFINED_ITEM")


def read_step_records(path: Path) -> StepRecords:
    """Records of the data section.

    Raises
    ------
    InputError
        If the file cannot be read, is not STEP, is cut short, refers to other files or is larger than any tire's.
    """
    text = input_bytes(path, "STEP file", _LARGEST).decode("utf-8", errors="replace")
    if not text.lstrip().startswith("ISO-10303-21"):
        raise InputError("STEP file", path, "does not begin with ISO-10303-21", "export it as STEP, AP203 or AP214")
    records = StepRecords(path=path)
    section = ""
    for statement in _statements(text):
        keyword = statement.partition("(")[0].strip()
        if section == "DATA" and keyword != "ENDSEC":
            records.add(statement)
        elif keyword == "REFERENCE":
            raise records.error("refers to other files", "export everything into one file")
        elif keyword in ("HEADER", "DATA", "ENDSEC", "ANCHOR"):
            section = "" if keyword == "ENDSEC" else keyword
    if section or not records.instances:
        raise records.error("has no whole data section", "export it again; it may have been cut short")
    records.refuse_other_files()
    return records


def _statements(text: str) -> Iterator[str]:
    """What stands before each semicolon outside texts and comments, without the comments."""
    start, parts = 0, list[str]()
    for found in _BREAK.finditer(text):
        if text[found.start()] == "'":
            continue
        parts.append(text[start : found.start()])
        start = found.end()
        if text[found.start()] == ";":
            yield "".join(parts).strip()
            parts = []


@dataclass(slots=True, kw_only=True)
class StepRecords:
    """One file: instance number -> text of its record; instances of each keyword in the order of the file."""

    path: Path
    instances: dict[int, str] = field(default_factory=dict)
    _kinds: dict[str, list[int]] = field(default_factory=dict)
    _steps: int = 0

    def add(self, statement: str) -> None:
        """Take up ``#number = record``."""
        found = _INSTANCE.fullmatch(statement)
        if not found or len(statement) > _LONGEST:
            rule = f"has a record that cannot be understood: {_shown(statement)}"
            raise self.error(rule, "export it again")
        number = int(found[1])
        if number in self.instances:
            raise self.error(f"has #{number} twice", "export it again")
        if len(self.instances) >= _MOST_RECORDS:
            raise self.error(f"has more than {_MOST_RECORDS} records", "export the surfaces of the tire alone")
        self.instances[number] = found[2]
        self._kinds.setdefault(found[2].partition("(")[0].strip(), []).append(number)

    def refuse_other_files(self) -> None:
        """Raise InputError if a record names another file."""
        for kind in _OTHER_FILES:
            if self.of(kind):
                rule = f"refers to another file (#{self.of(kind)[0]}, {kind})"
                raise self.error(rule, "export everything into one file, without documents")

    def record(self, number: int) -> str:
        """Text of one record; raises InputError if it is not there."""
        if number not in self.instances:
            raise self.error(f"refers to #{number}, which is not there", "export it again; it may have been cut short")
        return self.instances[number]

    def keyword(self, number: int) -> str:
        """Name of an instance's entity; empty for a complex one."""
        return self.record(number).partition("(")[0].strip()

    def of(self, keyword: str) -> list[int]:
        """Instances of one entity, in the order of the file."""
        return self._kinds.get(keyword, [])

    def values(self, number: int) -> tuple[Any, ...]:
        """Parameters: numbers, texts, lists, and references as numbers; enumerations and blanks as None.

        Empty for a complex instance; raises InputError for what is no list of parameters.
        """
        found = _RECORD.fullmatch(self.record(number))
        if not found:
            return ()
        parameters = _parameters(found[2])
        if parameters is None:
            rule = f"has a record that cannot be understood: #{number} = {_shown(found[0])}"
            raise self.error(rule, "export it again")
        return parameters

    def reached(self, start: int, keyword: str) -> list[int]:
        """Instances of one entity that another leads to, through whatever lies between."""
        seen, waiting, found = {start}, [start], []
        while waiting:
            number = waiting.pop()
            if self.keyword(number) == keyword:
                found.append(number)
                continue
            numbers = _REFERENCE.findall(_TEXT.sub("", self.record(number)))
            self._steps += 1 + len(numbers)
            if self._steps > _MOST_STEPS:
                raise self.error("refers to itself again and again", "export the surfaces of the tire alone")
            new = {n for n in map(int, numbers) if n in self.instances and n not in seen}
            seen |= new
            waiting += new
        return sorted(found)

    def error(self, rule: str, hint: str) -> InputError:
        """What is wrong with this file."""
        return InputError("STEP file", self.path, rule, hint)


def _shown(text: str) -> str:
    """The beginning of a record on one line."""
    return repr(text[:60])


def _parameters(text: str) -> tuple[Any, ...] | None:
    """Parameters between the brackets of a record; None if they are none."""
    lists, place, awaited = [list[Any]()], 0, True  # awaited: whether a value must come next
    while place < len(text):
        token = _TOKEN.match(text, place)
        if not token:
            return None
        place = token.end()
        if token["kind"]:  # of a value with a type: LENGTH_MEASURE(1.)
            continue
        if token["mark"] in (",", ")"):
            empty = token["mark"] == ")" and not lists[-1]
            if (awaited and not empty) or (token["mark"] == ")" and len(lists) == 1):
                return None
            awaited = token["mark"] == ","
            if not awaited:
                whole = tuple(lists.pop())
                lists[-1].append(whole)
        elif not awaited or len(lists) > _DEEPEST:
            return None
        elif token["mark"]:
            lists.append([])
        else:
            lists[-1].append(_value(token))
            awaited = False
    return tuple(lists[0]) if len(lists) == 1 and not (awaited and lists[0]) else None


def _value(token: re.Match[str]) -> str | float | None:
    """A text, a number, a reference as its number; None for an enumeration or a blank."""
    if token["text"]:
        return token["text"][1:-1].replace("''", "'")
    if token["real"]:
        return float(token["real"])
    return None if token["blank"] else int(token["reference"] or token["integer"])
