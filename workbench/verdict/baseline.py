"""What changed since the last accepted report, and which of it makes the gate fail.

A report is accepted by keeping its ``summary.json`` (`workbench.commands.accept`). A value has moved if it moved by
more than `NOISE` of the room its tolerance leaves. Beside gates that do not pass, the gate fails for a gate that is
gone, has become a finding, measures something else or is held against a looser limit: what was accepted may not be
given up without being accepted again.

Verified by tests/unit/test_workbench_baseline.py and tests/end_to_end/test_ci_gate.py.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_args

from contracts.errors import InputError
from contracts.foreign_folder import read_json
from contracts.records import Check, Role, Status

__all__ = ["NOISE", "SUMMARY", "Baseline", "Change", "Kept", "Kind", "changes_since", "read_baseline"]

SUMMARY = "summary.json"
NOISE = 0.01
"""Share of the room between reference and limit by which a value may move unnoticed [-]."""
_SCHEMAS = (1, 2)
_WORDS = 100
"""Of an error's, shown."""
_LOOSER = 0.05
"""Share by which a limit may grow: some follow from the numerical uncertainty, which moves a little [-]."""

Kind = Literal[
    "broken", "gone", "no gate any more", "measures something else", "looser limit", "status", "moved", "new"
]


@dataclass(frozen=True, slots=True, kw_only=True)
class Kept:
    """A check as a summary keeps it; fields as in `contracts.records.Check`."""

    id: str
    claim: str
    quantity: str
    unit: str
    value: float | None
    reference: float | tuple[float, float] | None
    tolerance: str
    status: str
    role: str

    @property
    def room(self) -> float | None:
        """How far the value may lie off its reference, or the limit's own size [unit]; None without a reference."""
        if isinstance(self.reference, tuple):
            return 0.5 * (self.reference[1] - self.reference[0])
        if self.reference is None:
            return None
        share = self.share
        return abs(self.reference) * (1.0 if share is None else share)

    @property
    def share(self) -> float | None:
        """Relative tolerance about the reference [-]; None where the reference is a limit."""
        found = re.match(r"([\d.e+-]+) %", self.tolerance)
        return None if found is None else float(found[1]) / 100.0

    @property
    def rule(self) -> str:
        """Kind of rule: ``at most``, ``at least``, ``near``, ``within`` or none of them."""
        if isinstance(self.reference, tuple):
            return "within"
        return "near" if self.share is not None else " ".join(self.tolerance.split()[:2])


@dataclass(frozen=True, slots=True, kw_only=True)
class Baseline:
    """The report that was accepted last: its study, the commit and time it was made at, its checks by identifier."""

    study: str
    commit: str | None
    created: str
    checks: Mapping[str, Kept]


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """One change.

    Attributes
    ----------
    kind : what it is
    before, now : the check then and now; None where there was or is none
    shift : change of the value over the room its tolerance leaves [-]; None where one of them is not known
    """

    kind: Kind
    before: Kept | None
    now: Kept | None
    shift: float | None = None

    @property
    def check(self) -> Kept:
        """The check as it is, or was."""
        found = self.now or self.before
        assert found is not None
        return found

    @property
    def fails(self) -> bool:
        """Whether it makes the gate fail."""
        was_gate = self.before is not None and self.before.role == "gate"
        return was_gate and self.kind not in ("status", "moved", "new")


def read_baseline(folder: Path, study: str, what: str = "baseline") -> Baseline:
    """The accepted report in a folder; InputError, about ``what``, if there is none, or one of another study."""
    path, hint = folder / SUMMARY, "accept a report first: workbench accept DIR"
    if what != "baseline":
        hint = "give the folder that workbench report wrote"
    try:
        content = read_json(path, what, hint)
        schema = content.get("schema", 1)
        if isinstance(schema, bool) or not isinstance(schema, int) or schema not in _SCHEMAS:
            raise ValueError("schema of another version")
        checks = [_kept(row) for row in content["checks"]]
        if len({check.id for check in checks}) < len(checks):
            raise ValueError("one identifier twice")
        origin = content["provenance"]
        if not isinstance(content["study"], str) or not isinstance(origin.get("commit"), str | None):
            raise TypeError("study and commit are texts")
        found = Baseline(
            study=str(content["study"]),
            commit=origin.get("commit"),
            created=str(origin.get("created", "")),
            checks={check.id: check for check in checks},
        )
    except InputError as error:
        raise InputError(what, path, error.rule, hint) from None
    except (ValueError, KeyError, TypeError, AttributeError, IndexError, OverflowError) as error:
        why = f"{type(error).__name__}: {str(error)[:_WORDS]}"
        raise InputError(what, path, f"is no summary of a report ({why})", hint) from None
    if found.study != study:
        raise InputError(what, path, f"is of study {found.study!r}, not {study!r}", "give that of this study")
    return found


def _kept(row: Mapping[str, Any]) -> Kept:
    """From a summary; those of earlier versions have no claim, but a title. Raises TypeError for other types."""
    names = [name for name in Kept.__slots__ if name not in ("claim", "reference", "value")]
    reference, value = row["reference"], row["value"]
    if not all(isinstance(row[name], str) for name in names):
        raise TypeError("a name that is no text")
    if row["role"] not in get_args(Role) or row["status"] not in get_args(Status):
        raise ValueError(f"role {row['role']!r}, status {row['status']!r}")
    kept = Kept(
        claim=str(row.get("claim") or row["title"]),
        reference=_interval(reference) if isinstance(reference, list) else _number(reference),
        value=_number(value),
        **{name: row[name] for name in names},
    )
    if kept.share is not None and not math.isfinite(kept.share):
        raise ValueError(f"tolerance {kept.tolerance!r}")
    return kept


def _interval(ends: Sequence[object]) -> tuple[float, float]:
    low, high = map(_number, ends)
    if low is None or high is None or low > high:
        raise ValueError("a reference that is no interval")
    return low, high


def _number(value: object) -> float | None:
    if value is None or (isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)):
        return value
    raise TypeError("a value that is no finite number")


def changes_since(baseline: Baseline, checks: Sequence[Check]) -> tuple[Change, ...]:
    """Every change, those first that make the gate fail, then by the size of the shift."""
    now = {c.id: Kept(**{name: getattr(c, name) for name in Kept.__slots__}) for c in checks}
    found = [_change(before, now.get(id)) for id, before in baseline.checks.items()]
    changes = [change for change in found if change is not None]
    changes += [Change(kind="new", before=None, now=one) for id, one in now.items() if id not in baseline.checks]
    return tuple(sorted(changes, key=lambda c: (not c.fails, -(c.shift or 0.0), c.check.id)))


def _change(before: Kept, now: Kept | None) -> Change | None:
    """The gravest change of one check, if any."""
    if now is None:
        return Change(kind="gone", before=before, now=None)
    shift = _shift(before, now)
    kind = _kind(before, now, shift)
    return None if kind is None else Change(kind=kind, before=before, now=now, shift=shift)


def _kind(before: Kept, now: Kept, shift: float | None) -> Kind | None:
    broken = now.role == "gate" and before.status == "pass" != now.status
    tests: tuple[tuple[bool, Kind], ...] = (
        (broken, "broken"),
        (before.role == "gate" != now.role, "no gate any more"),
        ((before.quantity, before.unit, before.rule) != (now.quantity, now.unit, now.rule), "measures something else"),
        (_is_looser(before, now), "looser limit"),
        (before.status != now.status, "status"),
        (shift is not None and shift > NOISE, "moved"),
    )
    return next((kind for holds, kind in tests if holds), None)


def _shift(before: Kept, now: Kept) -> float | None:
    if before.value is None or now.value is None or before.unit != now.unit:
        return None
    moved = abs(now.value - before.value)
    room = before.room or abs(before.value)
    return moved / room if room else float(moved > 0.0)


def _is_looser(before: Kept, now: Kept) -> bool:
    """Whether the limit leaves more room than it did, or lies elsewhere by more than the room."""
    if isinstance(before.reference, tuple) and isinstance(now.reference, tuple):
        slack = _LOOSER * (before.reference[1] - before.reference[0])
        return now.reference[0] < before.reference[0] - slack or now.reference[1] > before.reference[1] + slack
    if not isinstance(before.reference, float | int) or not isinstance(now.reference, float | int):
        return False
    grown = now.reference - before.reference
    if before.share is not None and now.share is not None:
        return now.share > before.share * (1.0 + _LOOSER) or abs(grown) > max(before.room or 0.0, 1e-12)
    slack = _LOOSER * abs(before.reference)
    return grown < -slack if before.rule == "at least" else grown > slack
