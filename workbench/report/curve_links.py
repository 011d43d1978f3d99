"""Links to the curves that keep the page in one file. Verified by tests/end_to_end/test_report.py."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from contracts.curves import StiffnessCurve, write_curve
from workbench.charts.packing import file_link
from workbench.report.outputs import curve_file

__all__ = ["curve_links"]


def curve_links(curves: Sequence[StiffnessCurve]) -> dict[str, str]:
    """``curves/{name}.csv`` -> a ``data:`` link with the bytes that the file in the report's folder has."""
    links = {}
    with TemporaryDirectory() as folder:
        for curve in curves:
            path = Path(folder) / curve_file(curve)
            write_curve(curve, path)
            links[f"curves/{path.name}"] = file_link(path.read_bytes())
    return links
