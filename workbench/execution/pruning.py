"""Removes stored results by age, by total size and by name, never one that a living run uses.

Verified by tests/unit/test_workbench_pruning.py.
"""

from __future__ import annotations

import contextlib
import fnmatch
import os
import shutil
import socket
import time
import uuid
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

from workbench.execution.inventory import Kept, leftovers, results
from workbench.execution.live_runs import exclusive, keys_in_use
from workbench.execution.store import Store

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
    if one.kind == "scratch" and not one.name.startswith(f"{socket.gethostname()}-") and age < _FOREIGN_SCRATCH:
        return False
    if rule.task is not None and not (one.kind == "result" and fnmatch.fnmatchcase(one.task, rule.task)):
        return False
    return rule.older_than is None or age > rule.older_than


def prune(store: Store, rule: Rule, *, dry_run: bool = False) -> Pruned:
    """Remove what a rule chooses, checkpoints, scratch and logs of runs that ended among it.

    Results and checkpoints of runs that live are kept; no run can begin to use a result while it is being removed. With
    ``dry_run`` nothing is removed.
    """
    with exclusive(store.root):
        kept, in_use, now = [*results(store), *leftovers(store)], keys_in_use(store.root), time.time()
        matched = chosen(kept, rule, now, in_use)
        held = sum(_is_used(one, in_use) and _matches(one, rule, now) for one in kept)
        trash = [] if dry_run else [_set_aside(store.root, one.path) for one in matched]
    for path in trash:
        shutil.rmtree(path, ignore_errors=True)
    return Pruned(removed=tuple(matched), in_use=held, size=sum(one.size for one in kept))


def _set_aside(root: Path, path: Path) -> Path:
    """Remove a file; move a folder out of the way by one rename and return where it is now."""
    trash = root / "tmp" / f"{socket.gethostname()}-{os.getpid()}-{uuid.uuid4().hex[:8]}"
    with contextlib.suppress(FileNotFoundError):
        if path.is_dir():
            path.replace(trash)
        else:
            path.unlink()
    return trash
