"""What is said of a full disk: which one, and what to try."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from workbench.execution import disk
from workbench.execution.disk import OUT, STORE, disk_full, naming_the_disk, no_room, where_full
from workbench.execution.errors import DiskFullError


class _Room:
    """Disks with room as told, by the folder they are mounted at."""

    def __init__(self, free: dict[Path, int]) -> None:
        self._free, self._real = free, os.statvfs

    def __call__(self, path: Path) -> os.statvfs_result:
        state = list(self._real(path))
        for folder, free in self._free.items():
            if Path(path).is_relative_to(folder):
                state[1], state[2], state[3], state[4] = 1, 5_000_000, free, free
        return os.statvfs_result([*state, 255])


@pytest.fixture
def places(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Path]:
    """A store with no room and an output folder with some."""
    found = {STORE: tmp_path / "store", OUT: tmp_path / "out"}
    for path in found.values():
        path.mkdir()
    monkeypatch.setattr(disk.os, "statvfs", _Room({found[STORE]: 0, found[OUT]: 3_000_000}))
    return found


def _full(path: Path | None = None, number: int = errno.ENOSPC) -> OSError:
    return OSError(number, os.strerror(number), *([str(path)] if path else []))


def test_an_error_that_names_its_file_is_about_that_disk(places: dict[str, Path]) -> None:
    text = disk_full(_full(places[OUT] / "report.html"), places)
    assert text.startswith("No space left on device: the disk mounted at ")
    assert f"which holds the output folder {places[OUT]} (3 MB of 5 MB free)" in text
    assert "choose another with --out" in text


def test_of_a_copy_the_target_counts(places: dict[str, Path]) -> None:
    error = OSError(errno.ENOSPC, "No space left on device", str(places[STORE] / "a"), None, str(places[OUT] / "a"))
    assert f"the output folder {places[OUT]}" in disk_full(error, places)


def test_an_error_that_names_none_is_about_the_place_with_the_least_room(places: dict[str, Path]) -> None:
    text = disk_full(_full(), places)
    assert f"the result store {places[STORE]} (0 bytes of 5 MB free); make room, or choose another with --store" in text


def test_a_quota_and_a_cause_behind_another_error(places: dict[str, Path]) -> None:
    error = RuntimeError("could not compile")
    error.__cause__ = _full(number=errno.EDQUOT)
    assert disk_full(error, places).startswith("Disk quota exceeded: ")


def test_a_file_longer_than_may_be(places: dict[str, Path]) -> None:
    text = disk_full(_full(places[OUT] / "report.html", errno.EFBIG), places)
    assert text.startswith(f"File too large: {places[OUT] / 'report.html'}: a file may not be longer")


def test_a_file_too_long_that_has_no_name_is_laid_to_no_disk(places: dict[str, Path]) -> None:
    text = disk_full(_full(number=errno.EFBIG), places)
    assert text.startswith("File too large: a file may not be longer")
    assert str(places[STORE]) not in text


def test_standard_output_is_no_disk(places: dict[str, Path]) -> None:
    text = disk_full(_full(Path("standard output")), places)
    assert text.startswith("standard output: No space left on device; ")
    assert str(places[STORE]) not in text


def test_of_two_places_in_each_other_the_inner_one_is_named(places: dict[str, Path]) -> None:
    """Though the outer one, on another disk, has less room."""
    inner = {**places, OUT: places[STORE] / "disk" / "out"}
    assert f"which holds the output folder {inner[OUT]}" in disk_full(_full(inner[OUT] / "a"), inner)


def test_other_errors_are_not_about_a_disk(places: dict[str, Path]) -> None:
    assert disk_full(ValueError("28"), places) == ""
    assert disk_full(PermissionError(errno.EACCES, "Permission denied", "x"), places) == ""
    with pytest.raises(PermissionError), naming_the_disk(OUT, places[OUT]):
        raise PermissionError(errno.EACCES, "Permission denied", "x")


def test_where_there_is_no_room(places: dict[str, Path]) -> None:
    assert where_full(places).startswith("there is no room on the disk mounted at ")
    assert where_full({OUT: places[OUT]}) == ""
    assert (no_room(places[STORE]), no_room(places[OUT])) == (True, False)


def test_it_becomes_one_of_our_errors(places: dict[str, Path]) -> None:
    with pytest.raises(DiskFullError, match="which holds the result store"), naming_the_disk(STORE, places[STORE]):
        raise _full()
