"""Benchmark runs that were kept: what `make bench NAME=... ARGS=--record` measured, and under which conditions.

Verified by tests/unit/test_workbench_speed.py.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from contracts.errors import InputError

__all__ = ["DATA", "BenchmarkRecord", "BenchmarkRow", "read_record"]

DATA = Path(__file__).parent / "records"


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchmarkRow:
    """One number of one case.

    Attributes
    ----------
    case, metric, unit : what was measured
    ours, peer : the two values; None where the peer was not installed or did not end
    ratio : above one where ours is better; None where it has no meaning
    """

    case: str
    metric: str
    unit: str
    ours: float
    peer: float | None
    ratio: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchmarkRecord:
    """One kept run.

    Attributes
    ----------
    name : of the benchmark
    rows : its numbers
    date, commit : day of the run, and state of the code
    processor, cores, load : machine, and its load average when the run began; None where it was not noted
    system : operating system and Python
    versions : library or program -> version
    remark : what else a reader must know
    """

    name: str
    rows: tuple[BenchmarkRow, ...]
    date: str
    commit: str
    processor: str
    cores: int
    load: float | None
    system: str
    versions: Mapping[str, str]
    remark: str = ""

    def row(self, case: str, metric: str) -> BenchmarkRow:
        """The row of a case and a metric.

        Raises
        ------
        InputError
            If the run has none.
        """
        for row in self.rows:
            if (row.case, row.metric) == (case, metric):
                return row
        rule = f"must be among the rows of {self.name}"
        raise InputError("benchmark row", f"{case}: {metric}", rule, f"make bench NAME={self.name} ARGS=--record")

    def cases(self, metric: str) -> tuple[str, ...]:
        """Cases with a ratio of this metric, in the order of the run."""
        return tuple(row.case for row in self.rows if row.metric == metric and row.ratio is not None)


def read_record(name: str, folder: Path = DATA) -> BenchmarkRecord:
    """The kept run of a benchmark."""
    content = json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))
    rows = tuple(BenchmarkRow(**row) for row in content["rows"])
    return BenchmarkRecord(name=content["name"], rows=rows, **content["recorded"])
