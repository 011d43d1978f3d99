"""Files a user names: pipes, devices, sockets, folders and huge files get one message at once; marks are no error."""

from __future__ import annotations

import os
import socket
from collections.abc import Callable
from pathlib import Path

import pytest

from contracts.curves import read_curve
from contracts.errors import InputError, StudyError
from contracts.input_file import input_bytes, input_table, input_text, require_ordinary_file
from rover_dynamics.rover.rover_file import EXOMARS_ROVER, read_rover
from workbench.study.curve_file import in_si, read_measured_curve
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study
from workbench.verdict.baseline import read_baseline


def _pipe(folder: Path) -> Path:
    os.mkfifo(folder / "pipe")
    return folder / "pipe"


def _socket(folder: Path) -> Path:
    place = os.open(folder, os.O_RDONLY)  # by its short name: the path of a socket has at most 107 letters
    with socket.socket(socket.AF_UNIX) as made:
        made.bind(f"/proc/self/fd/{place}/socket")
    os.close(place)
    return folder / "socket"


def _huge(folder: Path) -> Path:
    with (folder / "huge").open("wb") as stream:
        stream.truncate(10**13)  # sparse: it takes no space
    return folder / "huge"


def _loop(folder: Path) -> Path:
    (folder / "loop").symlink_to(folder / "loop")
    return folder / "loop"


HOSTILE: dict[str, tuple[Callable[[Path], Path], str]] = {
    "pipe": (_pipe, "is a pipe, not a file"),
    "endless device": (lambda _: Path("/dev/zero"), "is a device, not a file"),
    "socket": (_socket, "is a socket, not a file"),
    "folder": (lambda folder: folder, "is a folder, not a file"),
    "huge": (_huge, "is larger than 1(00)? MB"),
    "missing": (lambda folder: folder / "none", "does not exist"),
    "below a file": (lambda _: EXOMARS_ROVER / "below", "cannot be read"),
    "link to itself": (_loop, "cannot be read"),
    "zero byte": (lambda folder: folder / "a\0b", "cannot be read"),
}
READERS: dict[str, Callable[[Path], object]] = {
    "study": read_study,
    "rover": read_rover,
    "measured curve": read_measured_curve,
    "the user's curve of a study": in_si,
    "curve": read_curve,
}


@pytest.mark.timeout(50)
@pytest.mark.parametrize("reader", READERS)
@pytest.mark.parametrize("kind", HOSTILE)
def test_what_is_no_ordinary_file_is_refused_at_once(kind: str, reader: str, tmp_path: Path) -> None:
    make, words = HOSTILE[kind]
    with pytest.raises((InputError, StudyError), match=words):
        READERS[reader](make(tmp_path))


@pytest.mark.timeout(50)
def test_a_baseline_that_is_a_pipe_is_refused(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "summary.json")
    with pytest.raises(InputError, match="is a pipe"):
        read_baseline(tmp_path, "exomars")


def test_a_file_that_becomes_a_pipe_or_grows_is_not_waited_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Between the look at the file and its opening it may be replaced."""
    pipe = _pipe(tmp_path)
    monkeypatch.setattr("contracts.input_file.require_ordinary_file", lambda *_: None)
    assert input_bytes(pipe, "file") == b""
    with pytest.raises(InputError, match=r"is larger than 0\.001 MB"):
        input_bytes(Path("/dev/zero"), "file", 1000)


def test_marks_and_line_ends_of_other_systems_are_no_error(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_bytes(b"\xef\xbb\xbfa\r\nb\rc\n")
    assert input_text(path, "file") == "a\nb\nc\n"
    require_ordinary_file(path, "file", 10)
    with pytest.raises(InputError, match="is larger than 9e-06 MB"):
        require_ordinary_file(path, "file", 9)


@pytest.mark.parametrize("source", [built_in_study(), EXOMARS_ROVER], ids=["study", "rover"])
def test_studies_and_rovers_may_begin_with_a_byte_order_mark(tmp_path: Path, source: Path) -> None:
    path, read = tmp_path / source.name, read_rover if source == EXOMARS_ROVER else read_study
    path.write_bytes(b"\xef\xbb\xbf" + source.read_bytes())
    own, other = read(path), read(source)
    assert own.kept_in(other.kept) == other if isinstance(own, Study) else own == other


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        (".".join(["a"] * 30_000) + " = 1", "has more than 2000 points in line 1"),
        ("[" + "x" * 2_000_000 + "]", "is larger than 1 MB"),
    ],
)
def test_a_key_that_takes_minutes_to_read_is_refused_at_once(tmp_path: Path, text: str, rule: str) -> None:
    """The first takes time as its length squared."""
    (tmp_path / "a.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=rule):
        input_table(tmp_path / "a.toml", "study file", "studies/first.toml")
