"""Tables as Parquet. The one module that imports PyArrow. Verified by tests/unit/test_workbench_sweep.py."""

from __future__ import annotations

from pathlib import Path

import pyarrow as pa  # type: ignore[import-untyped]
import pyarrow.parquet as pq  # type: ignore[import-untyped]

from workbench.questions.sweep.table import SweepTable

__all__ = ["write_parquet"]


def write_parquet(table: SweepTable, path: Path) -> None:
    """Write the table; a column of numbers is float64 or int64, any other is text, an empty cell is null."""
    columns = {name: _array(table.column(name)) for name in table.names}
    pq.write_table(pa.table(columns), path)


def _array(cells: tuple[object, ...]) -> pa.Array:
    kinds = {type(cell) for cell in cells if cell is not None}
    if kinds <= {int} and kinds:
        return pa.array(cells, pa.int64())
    return pa.array(cells, pa.float64() if kinds <= {int, float} else pa.string())
