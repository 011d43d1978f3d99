"""Field files from elsewhere: what they claim is judged before memory is taken, and cells stay within their points."""

from __future__ import annotations

import base64
import re
import zlib
from collections.abc import Callable
from pathlib import Path

import meshio
import numpy as np
import pytest

from contracts.errors import InputError
from tests.small_report_folder import write_small_report
from workbench.viewer.field_arrays import field_arrays
from workbench.viewer.wheel_file import read_fields


def packed(data: bytes, claimed: int | None = None, blocks: int = 1) -> str:
    """Text of an array: its header, then one zlib block."""
    body = zlib.compress(data)
    header = np.array([blocks, claimed or len(data), claimed or len(data), len(body)], "<u4").tobytes()
    return base64.b64encode(header).decode() + base64.b64encode(body).decode()


def put(name: str, text: str) -> Callable[[str], str]:
    """The good file with other content of one array."""
    pattern = re.compile(rf'(<DataArray[^>]*Name="{name}"[^>]*>)[^<]*')

    def change(content: str) -> str:
        assert pattern.search(content)
        return pattern.sub(lambda found: found[1] + text, content, count=1)

    return change


def head(old: str, new: str) -> Callable[[str], str]:
    return lambda content: content.replace(old, new, 1)


BOMB = '<!DOCTYPE a [<!ENTITY a "aaaaaaaaaa">' + "".join(
    f'<!ENTITY {chr(98 + k)} "{10 * f"&{chr(97 + k)};"}">' for k in range(9)
)
CASES: dict[str, Callable[[str], str]] = {
    "entities": lambda content: BOMB + "]><VTKFile>&j;</VTKFile>",
    "another file": lambda content: '<!DOCTYPE a [<!ENTITY x SYSTEM "file:///etc/passwd">]><VTKFile>&x;</VTKFile>',
    "pieces in other files": head('type="UnstructuredGrid"', 'type="PUnstructuredGrid"'),
    "appended": head('format="binary"', 'format="appended" offset="0"'),
    "ascii": head('format="binary"', 'format="ascii"'),
    "uncompressed": head('compressor="vtkZLibDataCompressor"', ""),
    "claims 4 GB": put("von_mises_Pa", packed(b"0" * 80, 4_000_000_000)),
    "claims less than it holds": put("von_mises_Pa", packed(b"0" * 80_000, 8)),
    "claims more blocks than there are": put("von_mises_Pa", packed(b"0" * 80, blocks=2_000_000_000)),
    "principal stresses of fewer nodes": put("principal_stress_Pa", packed(np.zeros(6, "<f4").tobytes())),
    "principal stresses that are no numbers": put("principal_stress_Pa", packed(np.full(864, np.nan, "<f4").tobytes())),
    "no header": put("von_mises_Pa", ""),
    "no base64": put("von_mises_Pa", "%%%%%%%%%%%%%%%%"),
    "a piece of a number": put("von_mises_Pa", packed(b"0" * 81)),
    "cells beyond the points": put("connectivity", packed(np.full(8, 10**9, "<i8").tobytes())),
    "cells below the points": put("connectivity", packed(np.full(8, -5, "<i8").tobytes())),
    "no cells": put("connectivity", packed(b"")),
    "another type of cell": put("types", packed(b"\7" * 100)),
    "no fields": head("von_mises_Pa", "pressure"),
    "another type of number": head("Float64", "Float9"),
    "components without sense": head('NumberOfComponents="3"', 'NumberOfComponents="7"'),
    "components beyond all numbers": head('NumberOfComponents="3"', f'NumberOfComponents="{"9" * 5000}"'),
}


@pytest.fixture
def good(tmp_path: Path) -> Path:
    write_small_report(tmp_path)
    return tmp_path / "fields" / "fe_phi000_200N.vtu"


def test_arrays_are_those_meshio_reads(good: Path) -> None:
    found, mesh = field_arrays(good), meshio.vtu.read(good)
    np.testing.assert_array_equal(found["Points"], mesh.points)
    np.testing.assert_array_equal(found["connectivity"].reshape(len(found["types"]), -1), mesh.cells[0].data)
    for name in ("displacement_m", "von_mises_Pa"):
        np.testing.assert_array_equal(found[name], mesh.point_data[name])
    np.testing.assert_array_equal(found["part"], mesh.cell_data["part"][0])


@pytest.mark.parametrize("case", CASES)
def test_every_hostile_file_is_one_message(case: str, good: Path, capfd: pytest.CaptureFixture[str]) -> None:
    before = good.read_text(encoding="utf-8")
    changed = CASES[case](before)
    assert changed != before
    good.write_text(changed, encoding="utf-8")
    with pytest.raises(InputError, match="field file = "):
        read_fields(good)
    assert capfd.readouterr() == ("", "")


def test_bytes_flipped_anywhere_end_in_fields_or_one_message(good: Path) -> None:
    chance, content, refused = np.random.default_rng(2), good.read_bytes(), 0
    for _ in range(200):
        changed = bytearray(content)
        for place in chance.integers(0, len(content), chance.integers(1, 6)):
            changed[place] = chance.integers(0, 256)
        good.write_bytes(bytes(changed))
        try:
            read_fields(good)
        except InputError:
            refused += 1
    assert refused > 50
