"""STEP files that are damaged, endless or made to do harm: each ends in one InputError, soon.

Claim: a user's file is read by our own reader, which follows no reference to other files and never hands the file to
OpenCASCADE, whose crashes nobody could catch. The negative control of the counts is the file all cases are made from.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from contracts.errors import InputError
from geometry.spline_surface import SplineSurface
from geometry.step_surfaces import read_surfaces_step
from geometry.surface_step import write_surfaces_step

KNOTS = np.array([0.0, 0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 1.0]), np.array([0.0, 0.0, 0.7, 1.0, 1.0])
SEED = np.random.default_rng(3)


def _good(folder: Path) -> str:
    x, y = np.meshgrid(np.linspace(0.0, 0.3, 5), np.linspace(0.0, 0.2, 3), indexing="ij")
    points = np.stack([x, y, 0.01 * SEED.normal(size=(5, 3))], axis=-1)
    surface = SplineSurface(name="rim 0", control_points=points, degrees=(3, 1), knots=KNOTS)
    write_surfaces_step([surface], folder / "good.step")
    return (folder / "good.step").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def good(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Text of a file with one surface that is read."""
    return _good(tmp_path_factory.mktemp("good"))


def _data(lines: str) -> Callable[[str], str]:
    """The good file with more records."""
    return lambda text: text.replace("DATA;", "DATA;\n" + lines, 1)


def _swap(old: str, new: str, count: int = 1) -> Callable[[str], str]:
    """The good file with one thing put for another, which it must have."""

    def change(text: str) -> str:
        changed = re.sub(old, lambda _: new, text, count=count)
        assert changed != text, old
        return changed

    return change


def _whole(content: str) -> Callable[[str], str]:
    return lambda text: content


def _file(data: str) -> Callable[[str], str]:
    """A file of its own."""
    return _whole(f"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n{data}\nENDSEC;\nEND-ISO-10303-21;\n")


def _many_faces(text: str) -> str:
    """A hundred thousand faces on one surface."""
    face = re.search(r"#\d+ = (ADVANCED_FACE\(.*?\));", text, re.DOTALL)
    assert face
    return _data("".join(f"#{10**6 + k} = {face[1]};\n" for k in range(100_000)))(text)


SURFACE = r"B_SPLINE_SURFACE_WITH_KNOTS\('',3,1"
POINT = r"CARTESIAN_POINT\('',\(0.E\+00,|CARTESIAN_POINT\('',\(0.,"
UNIT = "#9001 = ( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) );\n"
FACE = "#9002 = ADVANCED_FACE('',(#9003),#9004,.T.);\n"
CASES: dict[str, tuple[Callable[[str], str], str]] = {
    "empty": (_whole(""), "does not begin"),
    "header alone": (_whole("ISO-10303-21;"), "data section"),
    "no data": (_file(""), "data section"),
    "cut in a record": (lambda text: text[: text.index("B_SPLINE_SURFACE") + 30], "data section"),
    "cut after a record": (lambda text: text[: text.index("ENDSEC;", text.index("DATA;"))], "data section"),
    "zeros": (_whole("ISO-10303-21;" + 200_000 * "\0"), "data section"),
    "noise": (
        lambda text: "ISO-10303-21;DATA;" + SEED.bytes(200_000).decode("latin-1"),
        "cannot be understood|data section",
    ),
    "a text without end": (
        _swap(r"CARTESIAN_POINT\('", "CARTESIAN_POINT('\"'"),
        "understood|data section|fit its name",
    ),
    "a comment without end": (_data("/*"), "data section"),
    "comments without end": (_data(2_000_000 * "/*"), "data section"),
    "ten megabytes of numbers that begin": (_data(2_500_000 * "#1=("), "cannot be understood"),
    "ten megabytes of quotes": (_data("#9001 = A(" + 10_000_000 * "'" + ");"), "cannot be understood"),
    "ten megabytes of blanks": (_data("#9001 " + 10_000_000 * " " + "x;"), "cannot be understood"),
    "ten megabytes of brackets": (
        _swap(SURFACE, "B_SPLINE_SURFACE_WITH_KNOTS('',3," + 5_000_000 * "(" + 5_000_000 * ")"),
        "cannot be understood",
    ),
    "a few thousand brackets": (
        _swap(SURFACE, f"B_SPLINE_SURFACE_WITH_KNOTS('',{5000 * '('}3{5000 * ')'},1"),
        "cannot be understood",
    ),
    "a bracket that nothing opens": (_swap(SURFACE, "B_SPLINE_SURFACE_WITH_KNOTS('',3),1"), "cannot be understood"),
    "two values without a comma": (_swap(SURFACE, "B_SPLINE_SURFACE_WITH_KNOTS('',3 3,1"), "cannot be understood"),
    "larger than any": (_data("/*" + 30_000_000 * " " + "*/"), "larger than 30 MB"),
    "half a million records": (_data("".join(f"#{10**6 + k}=A(1);" for k in range(500_000))), "more than 300000"),
    "a record twice": (lambda text: text.replace("#20 =", "#19 =", 1), "twice"),
    "a number of thousands of digits": (_swap(SURFACE, f"B_SPLINE_SURFACE_WITH_KNOTS('',{5000 * '3'},1"), "understood"),
    "a reference of thousands of digits": (_data(f"#{5000 * '1'} = A();"), "cannot be understood"),
    "a record that names itself": (_file(UNIT + "#1 = ADVANCED_FACE('',(#1),#1,.T.);"), "ADVANCED_FACE"),
    "records in a circle": (
        _file(UNIT + FACE + "#9003 = FACE_BOUND('',#9004,.T.);\n#9004 = EDGE_LOOP('',(#9003));"),
        "EDGE_LOOP",
    ),
    "products in a circle": (
        _data(
            "".join(
                f"#{10**5 + k} = SHAPE_DEFINITION_REPRESENTATION(#{10**5 + (k + 1) % 3000},#{10**5 + (k + 7) % 3000});"
                for k in range(3000)
            )
        ),
        "again and again",
    ),
    "a surface that is missing": (_file(UNIT + FACE), "refers to #9004, which is not there"),
    "a point that is missing": (
        _swap(r"#\d+ = CARTESIAN_POINT\('',\(300", "#9999 = CARTESIAN_POINT('',(300"),
        "not there",
    ),
    "1e300": (_swap(r"CARTESIAN_POINT\('',\(300\.", "CARTESIAN_POINT('',(1.E+300"), "beyond 1000 m"),
    "beyond all numbers": (_swap(r"CARTESIAN_POINT\('',\(300\.", "CARTESIAN_POINT('',(1.E+999"), "beyond 1000 m"),
    "no number": (_swap(r"CARTESIAN_POINT\('',\(300\.", "CARTESIAN_POINT('',(NAN"), "cannot be understood"),
    "nothing for a number": (
        _swap(r"CARTESIAN_POINT\('',\(300\.", "CARTESIAN_POINT('',($"),
        "beyond 1000 m|fit its name",
    ),
    "a text for a point": (_swap(r"CARTESIAN_POINT\('',\(300", "CARTESIAN_POINT('',('a',300"), "fit its name"),
    "points with two coordinates": (_swap(r"(?<=CARTESIAN_POINT\('',\(300)\.,", ".),("), "fit its name"),
    "degree of a billion": (_swap(SURFACE, "B_SPLINE_SURFACE_WITH_KNOTS('',999999999,1"), "degrees 999999999, 1"),
    "degree 2.5": (_swap(SURFACE, "B_SPLINE_SURFACE_WITH_KNOTS('',2.5,1"), "degrees 2.5, 1"),
    "degree below zero": (_swap(SURFACE, "B_SPLINE_SURFACE_WITH_KNOTS('',-3,1"), "degrees -3, 1"),
    "a knot a billion times": (_swap(r"\(4,1,4\)", "(4,999999999,4)"), "repeated"),
    "a knot that is repeated less than never": (_swap(r"\(4,1,4\)", "(4,-1,4)"), "repeated"),
    "knots that fall": (_swap(r"\(0.,0.4,1.\)", "(0.,1.4,1.)"), "do not increase"),
    "knots on one place": (_swap(r"\(0.,0.4,1.\)", "(0.,0.,0.)"), "do not increase"),
    "knots beyond all numbers": (_swap(r"\(0.,0.4,1.\)", "(-1.E+308,0.4,1.E+308)"), "knots"),
    "knots that touch": (_swap(r"\(0.,0.4,1.\)", "(0.,1.E-310,1.)"), "too close"),
    "a knot too few": (_swap(r"\(0.,0.4,1.\)", "(0.,1.)"), "fit its name|knots"),
    "no points": (_swap(r"(?s)\(\s*\(#33.*?\)\)", "()"), "fit its name"),
    "too few values": (_swap(r"(?s)(?<=_SURFACE_WITH_KNOTS)\('',3,1.*?;", "('',3);"), "fit its name"),
    "a name of a million letters": (_swap(r"PRODUCT\('rim 0'", f"PRODUCT('rim{900_000 * ' '}x'"), "no line of text"),
    "a name of two lines": (_swap(r"PRODUCT\('rim 0'", "PRODUCT('rim\n\033[31m0'"), "no line of text"),
    "a hundred thousand faces": (_many_faces, "holds 100001 faces"),
    "inches": (_swap(r"SI_UNIT\(\.MILLI\.,\.METRE\.\)", "CONVERSION_BASED_UNIT('INCH',#1)"), "unit of length"),
    "two units": (_data("#9001 = ( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT($,.METRE.) );"), "unit of length"),
    "no faces": (_swap("ADVANCED_FACE", "ADVANCED_FACES", 0), "no face"),
    "another file": (_data("#9001 = DOCUMENT_FILE('/etc/passwd','',$,#9002,'',$);"), "refers to another file"),
    "another file by its address": (
        _data("#9001 = EXTERNAL_SOURCE(IDENTIFIER('http://127.0.0.1:9/a.stp'));"),
        "another file",
    ),
    "another file by its section": (
        lambda text: text.replace("DATA;", "REFERENCE;\n#1 = <other.stp#2>;\nENDSEC;\nDATA;", 1),
        "refers to other files",
    ),
}


def test_the_file_all_are_made_from_is_read(good: str, tmp_path: Path) -> None:
    (tmp_path / "good.step").write_text(good, encoding="utf-8")
    (surface,) = read_surfaces_step(tmp_path / "good.step")
    assert surface.name == "rim 0"
    assert len(CASES) >= 50


@pytest.mark.parametrize("case", CASES)
@pytest.mark.timeout(120)  # against hanging; the longest takes 3 s
def test_every_hostile_file_is_one_message(case: str, good: str, tmp_path: Path) -> None:
    change, rule = CASES[case]
    path = tmp_path / "hostile.step"
    path.write_text(change(good), encoding="utf-8")
    with pytest.raises(InputError, match=rule) as found:
        read_surfaces_step(path)
    assert len(str(found.value)) < 800
    assert str(found.value).isprintable()


@pytest.mark.parametrize("kind", ["pipe", "device", "folder"])
def test_what_is_no_file_is_said_at_once(kind: str, tmp_path: Path) -> None:
    path = tmp_path / "tire.step"
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "device":
        path.symlink_to("/dev/zero")
    else:
        path.mkdir()
    with pytest.raises(InputError, match="not a file"):
        read_surfaces_step(path)


def test_bytes_flipped_anywhere_end_in_a_surface_or_one_message(good: str, tmp_path: Path) -> None:
    """A thousand files with one to twenty bytes changed: nothing but surfaces or an InputError."""
    path, content, refused = tmp_path / "flipped.step", good.encode(), 0
    for _ in range(1000):
        changed = bytearray(content)
        for place in SEED.integers(0, len(content), SEED.integers(1, 21)):
            changed[place] = SEED.integers(0, 256)
        path.write_bytes(bytes(changed))
        try:
            read_surfaces_step(path)
        except InputError:
            refused += 1
    assert 100 < refused < 1000


def test_a_user_s_file_never_reaches_gmsh(tmp_path: Path) -> None:
    """OpenCASCADE may crash; reading a study does not even load it."""
    good = _good(tmp_path)
    (tmp_path / "tire.step").write_text(good, encoding="utf-8")
    script = (
        "import sys\nfrom pathlib import Path\nfrom geometry.step_surfaces import read_surfaces_step\n"
        f"assert len(read_surfaces_step(Path({str(tmp_path / 'tire.step')!r}))) == 1\nassert 'gmsh' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", script], check=True)
