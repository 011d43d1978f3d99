"""NumPy archives from elsewhere: what they claim is judged before memory is taken for it."""

from __future__ import annotations

import io
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from contracts.archive import read_archive
from contracts.errors import InputError

LARGEST = 1_000_000
HEADER = "{'descr': '<f8', 'fortran_order': False, 'shape': (%s), }"


def member(header: str, data: bytes = b"") -> bytes:
    """An array with any header."""
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode("latin-1") + data


def packed(*members: bytes, compression: int = zipfile.ZIP_DEFLATED) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", compression) as archive:
        for number, content in enumerate(members):
            archive.writestr(f"a{number}.npy", content)
    return stream.getvalue()


def saved(**arrays: object) -> bytes:
    stream = io.BytesIO()
    np.savez_compressed(stream, **arrays)
    return stream.getvalue()


def lying(size: int) -> bytes:
    """A member whose directory entry claims another size than it unpacks to."""
    content = bytearray(saved(a=np.zeros(5000)))
    place = content.index(b"PK\1\2")
    content[place + 24 : place + 28] = struct.pack("<I", size)
    return bytes(content)


CASES: dict[str, tuple[Callable[[], bytes], str]] = {
    "nothing": (lambda: b"", "does not end"),
    "text": (lambda: b"no archive", "does not end"),
    "bomb": (lambda: saved(a=np.zeros(1_000_000)), "at most 1 MB"),
    "bomb of many": (lambda: saved(**{f"a{k}": np.zeros(50_000) for k in range(20)}), "at most 1 MB"),
    "huge shape": (lambda: packed(member(HEADER % "1000000000000,")), "claims"),
    "shape beyond all numbers": (lambda: packed(member(HEADER % f"{10**300},")), "claims"),
    "shape below zero": (lambda: packed(member(HEADER % "-1,")), "shape"),
    "shape of words": (lambda: packed(member(HEADER % "'a',")), "cannot be read"),
    "objects": (
        lambda: packed(member("{'descr': '|O', 'fortran_order': False, 'shape': (1,), }", b"x" * 8)),
        "objects",
    ),
    "code for a header": (lambda: packed(member("__import__('os').abort()")), "cannot be read"),
    "brackets for a header": (lambda: packed(member("(" * 9000)), "cannot be read"),
    "long header": (lambda: packed(member(" " * 60_000)), "cannot be read"),
    "another version": (lambda: packed(b"\x93NUMPY\x09\x00" + bytes(80)), "cannot be read"),
    "no array": (lambda: packed(b"hello" * 50), "cannot be read"),
    "lzma": (lambda: packed(member(HEADER % "0,"), compression=zipfile.ZIP_LZMA), "packed in another way"),
    "bzip2": (lambda: packed(member(HEADER % "0,"), compression=zipfile.ZIP_BZIP2), "packed in another way"),
    "unpacks to more": (lambda: lying(128 + 8), "claims|Bad CRC"),
    "unpacks to less": (lambda: lying(128 + 8 * 6000), "claims"),
    "many members": (
        lambda: packed(*[b""] * 20_000, compression=zipfile.ZIP_STORED),
        "too many members|smaller|larger",
    ),
    "64 bit directory": (lambda: saved(a=1)[:-22] + b"PK\6\7" + bytes(16) + saved(a=1)[-22:], "does not end"),
    "cut": (lambda: saved(a=np.arange(100.0))[:-60], "does not end"),
    "more behind": (lambda: saved(a=1) + b"more", "does not end"),
}


def test_good_archives_are_read(tmp_path: Path) -> None:
    path = tmp_path / "good.npz"
    for arrays in ({"a": np.arange(6.0).reshape(2, 3), "b": np.array("word")}, {"a": np.zeros((0, 3), np.float32)}):
        for save in (np.savez, np.savez_compressed):
            save(path, **arrays)
            found = read_archive(path, "file", LARGEST)
            assert found.keys() == arrays.keys()
            for name, array in arrays.items():
                np.testing.assert_array_equal(found[name], array)
    np.savez(path, a=np.asfortranarray(np.arange(6.0).reshape(2, 3)), other=np.zeros(10**6))
    np.testing.assert_array_equal(read_archive(path, "file", 10**7, ["a", "z"])["a"], [[0, 1, 2], [3, 4, 5]])


@pytest.mark.parametrize("case", CASES)
def test_every_hostile_archive_is_one_message(case: str, tmp_path: Path) -> None:
    make, rule = CASES[case]
    (tmp_path / "hostile.npz").write_bytes(make())
    with pytest.raises(InputError, match=rule):
        read_archive(tmp_path / "hostile.npz", "file", LARGEST)


def test_bytes_flipped_anywhere_end_in_arrays_or_one_message(tmp_path: Path) -> None:
    chance, content, refused = np.random.default_rng(1), saved(a=np.arange(50.0), b=np.eye(3)), 0
    for _ in range(1000):
        changed = bytearray(content)
        for place in chance.integers(0, len(content), chance.integers(1, 6)):
            changed[place] = chance.integers(0, 256)
        (tmp_path / "flipped.npz").write_bytes(bytes(changed))
        try:
            read_archive(tmp_path / "flipped.npz", "file", LARGEST)
        except InputError:
            refused += 1
    assert refused > 500
