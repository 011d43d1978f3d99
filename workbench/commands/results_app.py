"""Arguments of ``workbench results``. Verified by tests/end_to_end/test_results_command.py."""

from __future__ import annotations

from typing import Annotated

import typer

from workbench.commands.options import DEFAULT_STORE, DefaultCommand, StoreOption

__all__ = ["results_app"]


class _ListByDefault(DefaultCommand):
    default = "list"


results_app = typer.Typer(cls=_ListByDefault, help="What the store holds (the default), one result, or make room.")


@results_app.command("list")
def list_results(
    store: StoreOption = DEFAULT_STORE,
    check: Annotated[bool, typer.Option("--check", help="Read every file and compare its checksum.")] = False,
) -> None:
    """A line for each result: task, study, age, size, wall time, key; the newest first. The default."""
    from workbench.commands.results import run_list

    raise typer.Exit(run_list(store, check=check))


@results_app.command("show")
def show_result(
    key: Annotated[str, typer.Argument(help="Key of a result, or its first digits.", show_default=False)],
    store: StoreOption = DEFAULT_STORE,
) -> None:
    """Everything recorded with one result: inputs, what it needs, versions, files."""
    from workbench.commands.results import run_show

    raise typer.Exit(run_show(store, key))


@results_app.command("prune")
def prune_results(
    older_than: Annotated[
        str | None, typer.Option(help="Only what is older, e.g. '30 d' or '12 h'.", show_default=False)
    ] = None,
    larger_than: Annotated[
        str | None,
        typer.Option(help="Only as much, the oldest first, as leaves a store of this size, e.g. '2 GB'."),
    ] = None,
    task: Annotated[
        str | None, typer.Option(help="Only results of tasks with such a name, e.g. 'fe_*'.", show_default=False)
    ] = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Remove nothing, say what would be.")] = False,
    store: StoreOption = DEFAULT_STORE,
) -> None:
    """Remove results, and checkpoints, scratch and logs of runs that ended; nothing that a living run uses."""
    from workbench.commands.results import run_prune

    raise typer.Exit(run_prune(store, older_than, larger_than, task, dry_run=dry_run))
