"""ISO/TS 18571 rating, on curves of which it is known how they compare; that it is imported on request alone."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import numpy as np

from workbench.questions.two_curves.rating import iso_18571_rating

X = np.linspace(0.0, 1.0, 201)
_IMPORTED = (
    "import sys; from workbench.cli import _run; _run(sys.argv[1:]); print('objective_rating_metrics' in sys.modules)"
)


def test_rating_falls_with_distance() -> None:
    reference = np.sin(2.0 * np.pi * X)
    found = [iso_18571_rating(reference * (1.0 + e), reference) for e in (0.0, 0.1, 0.3, 1.0)]
    assert found[0] == 1.0
    assert found == sorted(found, reverse=True)
    assert found[-1] < 0.8


def test_it_can_rank_the_worse_curve_higher() -> None:
    """Why no check rests on it: a tenth too stiff beats wavering by 2 %."""
    reference = 240.0 * X * (1.0 - 0.12 * X)
    stiff, wavering = 1.1 * reference, reference * (1.0 + 0.02 * np.sin(20.0 * X))
    off = [float(np.linalg.norm(f - reference) / np.linalg.norm(reference)) for f in (stiff, wavering)]
    assert off[0] > 5.0 * off[1]
    assert iso_18571_rating(stiff, reference) > 0.9 > 0.8 > iso_18571_rating(wavering, reference)


def test_constant_curves_have_no_rating() -> None:
    flat, line = np.full_like(X, 5.0), 8250.0 * X + 5.0
    assert all(math.isnan(iso_18571_rating(*pair)) for pair in ((flat, line), (line, flat), (flat, flat)))


def test_it_is_imported_only_for_who_asks(tmp_path: Path) -> None:
    for name, end in (("a.csv", 275), ("b.csv", 250)):
        (tmp_path / name).write_text(f"deflection_m,load_N\n0,0\n0.03,{end}\n", encoding="utf-8")
    for options, imported, shown in (([], "False", False), (["--rating", "iso18571"], "True", True)):
        command = [sys.executable, "-c", _IMPORTED, "compare", str(tmp_path / "a.csv"), str(tmp_path / "b.csv")]
        ended = subprocess.run([*command, *options], capture_output=True, text=True, check=True)
        assert ended.stdout.split()[-1] == imported
        assert ("ISO/TS 18571 rating" in ended.stdout) is shown
