"""``workbench compare``: two curves from anywhere.

Verified by tests/end_to_end/test_commands.py.
"""

from __future__ import annotations

import math
from pathlib import Path

from rich.table import Table

from contracts.curves import read_curve
from contracts.errors import InputError
from workbench.commands.computing import console

__all__ = ["run_compare"]


def run_compare(curve_path: Path, reference_path: Path, max_load: float | None) -> int:
    """Print how far one curve lies from another."""
    from workbench.comparison.metrics import compare_curves

    if max_load is not None and not (math.isfinite(max_load) and max_load > 0.0):
        raise InputError("max load", f"{max_load} N", "must be finite and > 0", "give newtons such as 250")
    metrics = compare_curves(read_curve(curve_path), read_curve(reference_path), max_load)
    table = Table(title=f"{curve_path.name} against {reference_path.name}", title_justify="left")
    table.add_column("quantity")
    table.add_column("value", justify="right")
    for name, text in (
        ("range of deflection", f"{metrics.start * 1e3:.3f} .. {metrics.end * 1e3:.3f} mm"),
        ("relative L2 difference", f"{100.0 * metrics.relative_l2:.3f} %"),
        ("largest difference", f"{metrics.max_error:.3f} N at {metrics.max_error_at * 1e3:.2f} mm"),
        ("mean slope", f"{metrics.tangent * 1e-3:.4f} N/mm"),
        ("mean slope of the reference", f"{metrics.tangent_reference * 1e-3:.4f} N/mm"),
        ("ISO/TS 18571 rating", "not defined" if metrics.iso_rating is None else f"{metrics.iso_rating:.4f}"),
    ):
        table.add_row(name, text)
    console.print(table)
    return 0
