"""A study file with other strip thicknesses or another table: changed line by line, so that comments and order stay.

Verified by tests/unit/test_workbench_calibration.py.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

__all__ = ["rewritten_study", "rewritten_table"]

_FILES = (("compare.curves", "file"), ("ancf", "surfaces"))
"""Table and key of paths relative to the study."""

_TABLE = re.compile(r"\s*\[{1,2}\s*([^\[\]]+?)\s*\]{1,2}")
_VALUE = re.compile(r"""^(\s*)("[^"]*"|[\w.-]+)(\s*=\s*)("[^"]*"|'[^']*'|[^\s#]+)(.*)$""", re.DOTALL)


def rewritten_study(text: str, thickness: Mapping[str, float], note: str, folder: Path) -> str:
    """The text of a study file with new thicknesses.

    Parameters
    ----------
    text : the old file
    thickness : of ``"tire"`` and of each spring set by its name [m]
    note : one line, put first as a comment and as the reason of an inferred tire thickness
    folder : where the old file lies; the user's curves and surfaces are named from there
    """
    lines, table, blocks = text.splitlines(keepends=True), "", list[list[str]]()
    for line in lines:
        if not blocks or _TABLE.match(line):
            blocks.append([])
        blocks[-1].append(line)
    out = [f"# {note}\n"]
    for block in blocks:
        found = _TABLE.match(block[0])
        table = found[1] if found else ""
        out += _changed(block, table, thickness, (note, folder))
    return "".join(out)


def rewritten_table(text: str, table: str, values: Mapping[str, str], without: Sequence[str] = ()) -> str:
    """The text of a study file with new values in one table.

    Parameters
    ----------
    text : the old file
    table : name, e.g. ``"ancf"``
    values : key -> value as TOML text; keys that the table lacks come first in it. Comments stay, but those behind an
        array that changes.
    without : keys to leave out, with their comments
    """
    out, inside, missing = list[str](), False, dict(values)
    place = 0
    for line in text.splitlines(keepends=True):
        if found := _TABLE.match(line):
            inside = found[1] == table
            place = len(out) + 1 if inside else place
        key = line.partition("=")[0].strip().strip('"') if inside and "=" in line else ""
        if key in without:
            continue
        if key in values:
            missing.pop(key, None)
            array = line.partition("=")[2].lstrip().startswith("[")
            line = f"{key} = {values[key]}\n" if array else _with_value(line, values[key])
        out.append(line)
    return "".join([*out[:place], *(f"{key} = {value}\n" for key, value in missing.items()), *out[place:]])


def _changed(block: list[str], table: str, thickness: Mapping[str, float], about: tuple[str, Path]) -> Iterator[str]:
    """Lines of one table, with its own changes."""
    note, folder = about
    name = "tire" if table == "wheel.tire" else _name(block) if table == "wheel.springs" else ""
    for line in block:
        key = found[2].strip('"') if (found := _VALUE.match(line)) else ""
        if key == "thickness" and name in thickness:
            yield _with_value(line, f'"{thickness[name] * 1e3:.4f} mm"')
        elif table == "inferred" and key == "wheel.tire.thickness" and "tire" in thickness:
            yield _with_value(line, f'"{note}"')
        elif (table, key) in _FILES:
            assert found is not None
            yield _with_value(line, f'"{(folder / found[4].strip(chr(34))).resolve()}"')
        else:
            yield line


def _name(block: list[str]) -> str:
    """Value of the key ``name`` of a table."""
    for line in block:
        found = _VALUE.match(line)
        if found and found[2] == "name":
            return found[4].strip("\"'")
    return ""


def _with_value(line: str, value: str) -> str:
    return _VALUE.sub(lambda found: f"{found[1]}{found[2]}{found[3]}{value}{found[5]}", line)
