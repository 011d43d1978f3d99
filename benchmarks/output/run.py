"""Writes a benchmark's rows: always to ``build/bench``, and into the package when a run is to be kept.

The kept run (``--record``) is what the report shows under "Speed", with the date, machine, load and versions it was
measured with: see `workbench.questions.speed.record`.
"""

from __future__ import annotations

import argparse
import datetime
import json
import os
import platform
from collections.abc import Mapping, Sequence
from pathlib import Path

from workbench.execution.fingerprint import library_versions
from workbench.questions.speed.record import DATA
from workbench.report.provenance import git_commit

__all__ = ["Run", "add_option"]

ROOT = Path(__file__).resolve().parents[2]
LIBRARIES = ("dolfinx-solver-real", "numpy", "numba", "felupe", "pypardiso", "exudyn")


def add_option(parser: argparse.ArgumentParser) -> None:
    """The option ``--record``."""
    parser.add_argument("--record", action="store_true", help="keep this run in the package, for the report")


class Run:
    """One run of a benchmark; note the load before anything is measured.

    Parameters
    ----------
    name : of the benchmark
    further_versions : of programs that are no Python distributions; more may be added before the rows are written
    """

    def __init__(self, name: str, further_versions: Mapping[str, str] | None = None) -> None:
        self.name, self.further_versions = name, dict(further_versions or {})
        self._load, self._started = os.getloadavg()[0], datetime.datetime.now(datetime.UTC)

    def write(self, rows: Sequence[Mapping[str, object]], *, keep: bool) -> list[Path]:
        """Write the rows; the files written."""
        plain = {"schema": 1, "name": self.name, "rows": list(rows)}
        written = {ROOT / "build" / "bench" / f"{self.name}.json": plain}
        if keep:
            written[DATA / f"{self.name}.json"] = plain | {"recorded": self._conditions()}
        for target, content in written.items():
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
        return [target.relative_to(ROOT) for target in written]

    def _conditions(self) -> dict[str, object]:
        return {
            "date": self._started.date().isoformat(),
            "commit": git_commit(ROOT) or "unknown",
            "processor": _processor(),
            "cores": os.cpu_count() or 1,
            "load": round(self._load, 2),
            "system": f"{platform.system()} {platform.machine()}, Python {platform.python_version()}",
            "versions": _present(LIBRARIES) | self.further_versions,
        }


def _present(names: Sequence[str]) -> dict[str, str]:
    """Versions of those libraries that are installed."""
    return {name: version for name, version in library_versions(names).items() if version != "missing"}


def _processor() -> str:
    """Name of the processor as the system knows it."""
    info = Path("/proc/cpuinfo")
    lines = info.read_text(encoding="utf-8").splitlines() if info.is_file() else []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()
