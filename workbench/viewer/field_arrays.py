"""Arrays of the field files (.vtu) of `workbench.questions.fe.field_file`, decoded by what they say and no more.

VTK's own readers take memory on a file's word and crash on some; a viewer opens folders of others. What is read here is
what meshio writes: zlib blocks in base64 in one XML file, which names no other.

Verified by tests/unit/test_viewer_field_arrays.py and tests/unit/test_viewer_scene.py.
"""

from __future__ import annotations

import base64
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from contracts.input_file import input_bytes

__all__ = ["field_arrays"]

_LARGEST = 1_000_000_000
"""Bytes of a file, and of all its arrays: ten million nodes."""
_TYPES = {"Float64": "<f8", "Float32": "<f4", "Int64": "<i8", "Int32": "<i4"}
_TYPES |= {"UInt64": "<u8", "UInt32": "<u4", "UInt8": "u1", "Int8": "i1"}
_HEADER = np.dtype("<u4")


def field_arrays(path: Path) -> Mapping[str, NDArray[Any]]:
    """Arrays by name: Points, connectivity, offsets, types and the fields, those with components as (n, k).

    Raises
    ------
    InputError
        As `contracts.input_file.input_bytes`.
    ValueError, KeyError, zlib.error, ElementTree.ParseError
        If the file is not what meshio writes, or claims more than it holds.
    """
    content = input_bytes(path, "field file", _LARGEST)
    if b"<!ENTITY" in content or b"<!DOCTYPE" in content:
        raise ValueError("defines entities")
    root = ElementTree.fromstring(content)
    packing = (root.get("type"), root.get("byte_order"), root.get("header_type", "UInt32"), root.get("compressor"))
    if packing != ("UnstructuredGrid", "LittleEndian", "UInt32", "vtkZLibDataCompressor"):
        raise ValueError(f"is packed as {packing}")
    found, room = dict[str, NDArray[Any]](), _LARGEST
    for element in root.iter("DataArray"):
        array = _decoded(element, room)
        room -= array.nbytes
        found[element.attrib["Name"]] = array
    return found


def _decoded(element: ElementTree.Element, room: int) -> NDArray[Any]:
    """One array; raises ValueError if it would be larger than ``room`` bytes."""
    name, text = element.get("Name"), (element.text or "").strip()
    if element.get("format") != "binary":
        raise ValueError(f"{name} is not in binary")
    (blocks,) = np.frombuffer(base64.b64decode(text[:8])[: _HEADER.itemsize], _HEADER).tolist()
    length = 4 * -(-(3 + blocks) * _HEADER.itemsize // 3)  # base64 has four letters for three bytes
    if length > len(text):
        raise ValueError(f"{name} claims {blocks} blocks")
    _, size, last, *packed = np.frombuffer(base64.b64decode(text[:length]), _HEADER).tolist()
    sizes = [size] * (blocks - 1) + [last or size] * (blocks > 0)
    if sum(sizes) > room:
        raise ValueError(f"{name} claims {sum(sizes) / 1e6:.3g} MB")
    data, place, parts = base64.b64decode(text[length:]), 0, []
    for wanted, here in zip(sizes, packed, strict=True):
        parts.append(zlib.decompressobj().decompress(data[place : place + here], max(wanted, 1)))
        place += here
        if len(parts[-1]) != wanted:
            raise ValueError(f"{name} is cut short")
    array = np.frombuffer(b"".join(parts), _TYPES[element.attrib["type"]])
    components = int(element.get("NumberOfComponents") or 1)
    return array if components == 1 else array.reshape(-1, components)
