"""Compare two stiffness curves point by point; fail where they differ by more than 1e-8 of the largest load.

Usage: python compare_curves.py CURVE.csv REFERENCE.csv      ("-" reads the reference from standard input)
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

TOLERANCE = 1e-8


def difference(curve: str, reference: str) -> float:
    """Largest difference of the loads over the largest load [-]; both are CSV text with deflection and load first."""
    ours, theirs = (np.loadtxt(_rows(text), delimiter=",", ndmin=2) for text in (curve, reference))
    if ours.shape != theirs.shape or not np.allclose(ours[:, 0], theirs[:, 0], rtol=1e-12, atol=0.0):
        raise SystemExit(f"the curves have other deflections: {ours[:, 0]} and {theirs[:, 0]}")
    return float(np.abs(ours[:, 1] - theirs[:, 1]).max() / np.abs(theirs[:, 1]).max())


def _rows(text: str) -> list[str]:
    return [line for line in text.splitlines() if line and not line.startswith(("#", "deflection_m"))]


def main(curve: Path, reference: str) -> int:
    """Print the difference; 0 if it is within the tolerance, else 1."""
    other = sys.stdin.read() if reference == "-" else Path(reference).read_text(encoding="utf-8")
    found = difference(curve.read_text(encoding="utf-8"), other)
    print(f"largest difference of the curves: {found:.2e} (allowed {TOLERANCE:g})")
    return int(not found <= TOLERANCE)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), sys.argv[2]))
