"""``workbench results``: what the store holds, one result in full, and how to make room.

Verified by tests/end_to_end/test_results_command.py.
"""

from __future__ import annotations

import json
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.filesize import decimal

from contracts.errors import InputError
from contracts.text import for_json
from workbench.commands.computing import console
from workbench.execution.integrity import examined
from workbench.execution.inventory import Kept, leftovers, results
from workbench.execution.progress import duration_text
from workbench.execution.pruning import Rule, prune
from workbench.execution.store import Store
from workbench.execution.store_folder import holds_a_store
from workbench.study.magnitudes import number_in_si

__all__ = ["run_list", "run_prune", "run_show"]

_PREFIX = 12
"""Digits of a key that are shown."""


def run_list(store: Path, *, check: bool) -> int:
    """Print a line for each result, the newest first; with ``check``, 1 if one is damaged."""
    kept = results(_existing(store), check=check)
    lines = _aligned([_row(one, time.time(), check=check) for one in kept], check=check)
    damaged = [one for one in kept if one.fault]
    lines.append(f"{_counted(kept)}, {decimal(sum(one.size for one in kept))}, in {store}")
    beside = leftovers(Store(store))
    if beside:
        lines.append(f"beside them {_counted(beside)}, {decimal(sum(one.size for one in beside))}")
    if damaged:
        lines.append(f"{len(damaged)} damaged: the next run that needs them says so and computes them again")
    for line in lines:
        console.print(line, soft_wrap=True)
    return 1 if check and damaged else 0


def _row(one: Kept, now: float, *, check: bool) -> tuple[str, ...]:
    cells = (
        one.task or "?",
        one.study or "-",
        duration_text(now - one.stored_at),
        decimal(one.size),
        f"{one.wall_s:.1f} s",
    )
    state = f"damaged: {one.fault}" if one.fault else "whole" if check else ""
    return (*cells, one.name[:_PREFIX], state)


def _aligned(rows: Sequence[tuple[str, ...]], *, check: bool) -> list[str]:
    """Lines of a table of which no cell is cut, however narrow the terminal; numbers to the right."""
    table = [("task", "study", "age", "size", "wall time", "key", "state" if check else ""), *rows] if rows else []
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    form = "  ".join(f"{{:{'>' if i in (2, 3, 4) else '<'}{width}}}" for i, width in enumerate(widths))
    return [form.format(*cells).rstrip() for cells in table]


def run_prune(store: Path, older_than: str | None, larger_than: str | None, task: str | None, *, dry_run: bool) -> int:
    """Remove results by age, total size and task name, and say what was removed."""
    if older_than is None and larger_than is None and task is None:
        rule = "says nothing to remove by"
        raise InputError("prune", "no option", rule, 'give --older-than "30 d", --larger-than "2 GB" or --task NAME')
    rule_of = Rule(
        older_than=None if older_than is None else _quantity("--older-than", older_than, "s"),
        larger_than=None if larger_than is None else _quantity("--larger-than", larger_than, "byte"),
        task=task,
    )
    found = prune(_existing(store), rule_of, dry_run=dry_run)
    now = time.time()
    for one in found.removed:
        what = f"{one.task or '?'} {one.name[:_PREFIX]}" if one.kind == "result" else f"{one.kind} {one.name[:40]}"
        did = "would remove" if dry_run else "removed"
        text = f"{did} {what}, {duration_text(now - one.stored_at)}, {decimal(one.size)}"
        console.print(text, soft_wrap=True)
    freed = sum(one.size for one in found.removed)
    verb = "would be removed" if dry_run else "removed"
    held = f"; {found.in_use} kept, because a run that lives uses them" if found.in_use else ""
    total = f"{_counted(found.removed)} {verb}, {decimal(freed)} of {decimal(found.size)}{held}"
    console.print(total, soft_wrap=True)
    return 0


def run_show(store: Path, key: str) -> int:
    """Print everything recorded with one result, as JSON."""
    kept = _existing(store)
    matching = [one for one in results(kept) if one.name.startswith(key.lower())] if key else []
    if len(matching) != 1:
        rule = f"is the beginning of {len(matching)} keys" if matching else "is the beginning of no key in the store"
        raise InputError("key", key or "nothing", rule, "workbench results lists them; more digits tell two apart")
    manifest, fault = examined(matching[0].path, matching[0].name)
    shown = {"state": f"damaged: {fault}" if fault else "whole", "folder": str(matching[0].path), **_told(manifest)}
    print(for_json(json.dumps(shown, indent=2, ensure_ascii=False)))
    return 0


def _told(manifest: Mapping[str, Any]) -> dict[str, Any]:
    """The manifest in the order in which it is read: what, from what, by what, files; time as a date."""
    order = ("key", "task", "study", "function", "stored_at", "wall_s", "dofs", "inputs", "needs", "origin")
    told = {name: manifest[name] for name in order if name in manifest}
    if "stored_at" in told:
        told["stored_at"] = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(told["stored_at"]))
    sizes = manifest.get("sizes", {})
    files = manifest.get("files", {})
    return told | {"files": {name: {"bytes": sizes.get(name), "sha256": digest} for name, digest in files.items()}}


def _existing(root: Path) -> Store:
    """The store, which must be there: looking at one does not make it."""
    if not holds_a_store(root):
        rule = "is no store of results" if root.exists() else "is not there"
        raise InputError("result store", root, rule, "give its folder with --store or WORKBENCH_STORE")
    return Store(root)


def _quantity(option: str, text: str, unit: str) -> float:
    value = number_in_si(option, text if any(c.isalpha() for c in text) else f"{text} ", unit, repr(text))
    if value < 0.0:
        raise InputError(option, repr(text), "must not be negative", "give an age or a size, e.g. '30 d' or '2 GB'")
    return value


def _counted(kept: tuple[Kept, ...] | list[Kept]) -> str:
    """``"3 results, 1 log"``."""
    names = {"result": "result", "checkpoint": "checkpoint", "scratch": "scratch folder", "log": "log"}
    counts = {kind: sum(one.kind == kind for one in kept) for kind in names}
    words = [f"{n} {names[kind]}{'s' if n != 1 else ''}" for kind, n in counts.items() if n]
    return ", ".join(words) or "nothing"
