"""Removes stored results by age, by total size and by name, never one that a living run uses.

Verified by tests/unit/test_workbench_pruning.py.
"""

from __future__ import annotations

import contextlib
import fnmatch
import os
import time
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

from contracts.errors import InputError
from contracts.machine import machine
from workbench.execution.inventory import Kept, leftovers, results
from workbench.execution.live_runs import exclusive, keys_in_use
from workbench.execution.store import Store, discard

__all__ = ["Pruned", "Rule", "chosen", "prune"]

_FOREIGN_SCRATCH = 7 * 86400.0
"""Age [s] from which scratch of another machine counts as left behind: whether its run lives is not seen from here."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """What to remove: everything that is older AND has such a name, then the oldest of it until the rest is small.

    Attributes
    ----------
    older_than : age [s]; None for any
    task : pattern of task names, e.g. ``"fe_*"``; None for all of them and for what lies beside the results
    larger_than : size of the store [bytes]: only as much goes, the oldest first, as brings it down to this
    """

    older_than: float | None = None
    task: str | None = None
    larger_than: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Pruned:
    """What was removed, or would be; how many matched but are in use; size of the store before [bytes]."""

    removed: tuple[Kept, ...]
    in_use: int
    size: int


def chosen(kept: Sequence[Kept], rule: Rule, now: float, in_use: Collection[str] = ()) -> list[Kept]:
    """What a rule removes of everything in the store, the oldest first.

    Parameters
    ----------
    kept : everything in the store
    rule : what to remove
    now : time [s since 1970]
    in_use : keys of results and checkpoints that stay
    """
    found = [one for one in sorted(kept, key=lambda k: k.stored_at) if _matches(one, rule, now)]
    free = [one for one in found if not _is_used(one, in_use)]
    if rule.larger_than is None:
        return free
    excess = sum(one.size for one in kept) - rule.larger_than
    removed: list[Kept] = []
    for one in free:
        if excess <= 0:
            break
        removed.append(one)
        excess -= one.size
    return removed


def _is_used(one: Kept, in_use: Collection[str]) -> bool:
    return one.kind in ("result", "checkpoint") and one.name in in_use


def _matches(one: Kept, rule: Rule, now: float) -> bool:
    age = now - one.stored_at
    if one.kind == "scratch" and not one.name.startswith(f"{machine()}-") and age < _FOREIGN_SCRATCH:
        return False
    if rule.task is not None and not (one.kind == "result" and fnmatch.fnmatchcase(one.task, rule.task)):
        return False
    return rule.older_than is None or age > rule.older_than


def prune(store: Store, rule: Rule, *, dry_run: bool = False) -> Pruned:
    """Remove what a rule chooses, checkpoints, scratch and logs of runs that ended among it.

    Results and checkpoints of runs that live are kept; no run can begin to use a result while it is being removed. With
    ``dry_run`` nothing is removed. What is not of the store's own naming is left alone.

    Raises
    ------
    InputError
        If the store cannot be written, or what a run that lives uses cannot be read; nothing is removed then.
    """
    if not (dry_run or (store.writable and os.access(store.root, os.W_OK))):
        raise InputError("result store", store.root, "cannot be written", "look with --dry-run, or ask its owner")
    with exclusive(store.root):
        kept, in_use, now = [*results(store), *leftovers(store)], keys_in_use(store.root), time.time()
        matched = chosen(kept, rule, now, in_use)
        held = sum(_is_used(one, in_use) and _matches(one, rule, now) for one in kept)
        for one in () if dry_run else matched:
            _remove(store.root, one)
    return Pruned(removed=tuple(matched), in_use=held, size=sum(one.size for one in kept))


def _remove(root: Path, one: Kept) -> None:
    with contextlib.suppress(FileNotFoundError):
        if one.kind in ("result", "scratch"):
            discard(root, one.path)
        else:
            one.path.unlink()
