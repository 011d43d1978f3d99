"""A study file with other strip thicknesses or another table; comments and order stay (tomlkit).

Verified by tests/unit/test_workbench_calibration.py and tests/unit/test_workbench_trade_offs.py.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, cast

import tomlkit

from workbench.study.sweep import Value
from workbench.study.sweep_points import set_parameters

__all__ = ["rewritten_study", "rewritten_table", "written_point"]


def rewritten_study(text: str, thickness: Mapping[str, float], note: str, folder: Path) -> str:
    """The text of a study file with new thicknesses.

    Parameters
    ----------
    text : the old file
    thickness : of ``"tire"``, ``"lattice"`` and of each spring set by its name [m]
    note : one line, put first as a comment and as the reason of an inferred tire thickness
    folder : where the old file lies; the reference's files, surfaces and an own mesh are named from there
    """
    document = _parsed(text)
    wheel = document.get("wheel", {})
    named = [(name, wheel[name]) for name in ("tire", "lattice") if name in wheel]
    for name, part in [*named, *((part.get("name"), part) for part in wheel.get("springs", ()))]:
        if name in thickness:
            part["thickness"] = f"{thickness[name] * 1e3:.4f} mm"
    if "tire" in thickness and "wheel.tire.thickness" in document.get("inferred", {}):
        document["inferred"]["wheel.tire.thickness"] = note
    _name_from_anywhere(document, folder)
    return f"# {note}\n{tomlkit.dumps(document)}"


def written_point(text: str, values: Mapping[str, Value], note: str, path: Path) -> str:
    """The text of a study file with the values of one point, without [sweep] and [optimise].

    Parameters
    ----------
    text : the old file
    values : parameter as in [sweep] -> value
    note : lines, put first as a comment
    path : of the old file; the reference's files, surfaces and an own mesh are named from its folder
    """
    document = _parsed(text)
    set_parameters(path, document, values, tomllib.loads(text))
    for section in {"sweep", "optimise"} & document.keys():
        del document[section]
    _name_from_anywhere(document, path.parent)
    comment = "".join(f"# {line}\n" for line in note.splitlines())
    return f"{comment}\n{tomlkit.dumps(document).lstrip()}"


def _name_from_anywhere(document: Mapping[str, Any], folder: Path) -> None:
    """Give the files that a study names their whole paths."""
    reference = document.get("reference", {})
    files = [(one, "file") for one in (reference.get("band", {}), *reference.get("curves", ()))]
    for section, key in (*files, (document.get("ancf", {}), "surfaces"), (document.get("mesh", {}), "file")):
        if key in section:
            section[key] = str((folder / section[key]).resolve())


def rewritten_table(text: str, table: str, values: Mapping[str, object], without: Sequence[str] = ()) -> str:
    """The text of a study file with new values in one table.

    Parameters
    ----------
    text : the old file
    table : name, e.g. ``"ancf"``
    values : key -> value; keys that the table lacks come last in it
    without : keys to leave out, with their comments
    """
    document = _parsed(text)
    section = document[table]
    for key in without:
        section.pop(key, None)
    section.update(values)
    return tomlkit.dumps(document)


def _parsed(text: str) -> dict[str, Any]:
    return cast(dict[str, Any], tomlkit.parse(text))
