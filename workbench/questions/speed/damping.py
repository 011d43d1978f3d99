"""Names of what ``make bench NAME=contact_damping`` measured, and its kept run as the report shows it.

Verified by tests/unit/test_workbench_contact_damping.py.
"""

from __future__ import annotations

from dataclasses import dataclass

from workbench.questions.speed.record import BenchmarkRecord, read_record

__all__ = [
    "AT_REST",
    "BOUNCES",
    "LAWS",
    "SHARE",
    "SPEED",
    "STRAIGHT",
    "TRACTION",
    "DampingRow",
    "damping_rows",
    "drives_of",
]

LAWS = ("c = 0", "c = 10 N s/m", "c = 100 N s/m, as printed", "Hunt and Crossley, 0.5 s/m")
"""Cases: the last is that of every tire but the thesis'."""
STRAIGHT, TRACTION = "straight path at 70 m/h", "3.5 N m on each drive"
SHARE = {"contact_damping": "taken by contact damping", "damping": "taken by the plates", "friction": "by friction"}
"""Column of the account -> words."""
SPEED, AT_REST, BOUNCES = "speed", "deflection at rest", "bouncing left after 3 s"


def drives_of(path: str) -> str:
    """The metric of the drives' power."""
    return f"{path}: power of the drives"


@dataclass(frozen=True, slots=True, kw_only=True)
class DampingRow:
    """One law.

    Attributes
    ----------
    law : its name
    straight, traction : power of the drives [W], share of contact damping [%], speed [m/s]
    deflection : at rest [mm]
    bounces : of the bouncing, left after 3 s [%]
    """

    law: str
    straight: tuple[float, float, float]
    traction: tuple[float, float, float]
    deflection: float
    bounces: float


def damping_rows(record: BenchmarkRecord | None = None) -> list[DampingRow]:
    """Of the kept run, in the order of `LAWS`."""
    kept = record or read_record("contact_damping")

    def of(law: str, path: str) -> tuple[float, float, float]:
        metrics = (drives_of(path), f"{path}: {SHARE['contact_damping']}", f"{path}: {SPEED}")
        power, share, speed = (kept.row(law, metric).ours for metric in metrics)
        return power, share, speed

    return [
        DampingRow(
            law=law,
            straight=of(law, STRAIGHT),
            traction=of(law, TRACTION),
            deflection=kept.row(law, AT_REST).ours,
            bounces=kept.row(law, BOUNCES).ours,
        )
        for law in LAWS
    ]
