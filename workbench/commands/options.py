"""Options that several commands have, and who computes by them."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

from contracts.errors import InputError
from contracts.text import for_terminal

if TYPE_CHECKING:
    from workbench.execution.runner import Computing

__all__ = [
    "DEFAULT_STORE",
    "DefaultCommand",
    "LongCommand",
    "Ranks",
    "Scheduler",
    "StoreOption",
    "StudyArgument",
    "StudyOrBuiltIn",
    "Workers",
    "computing",
    "require_folders",
]

StudyArgument = Annotated[Path, typer.Argument(help="Study file (TOML).", show_default=False)]
StudyOrBuiltIn = Annotated[
    Path | None, typer.Argument(help="Study file (TOML); the built-in ExoMars study if left out.", show_default=False)
]
StoreOption = Annotated[
    Path, typer.Option(envvar="WORKBENCH_STORE", help="Folder where results are kept and found again.")
]
Workers = Annotated[
    int | None,
    typer.Option(
        min=1, max=256, help="Tasks that run at once. Default: 2, or as many as the cores hold.", show_default=False
    ),
]
Ranks = Annotated[int, typer.Option(min=1, max=256, help="MPI processes for each finite element task.")]
Scheduler = Annotated[
    str | None,
    typer.Option(help="Address of a Dask scheduler, tcp://host:port; its workers compute.", show_default=False),
]
DEFAULT_STORE = Path("build/store")
_FOLDERS = ("--out", "--store")


def require_folders(arguments: Sequence[str]) -> None:
    """Raise InputError for an option that names a folder and is given none: a path of no characters is the current
    folder to Python, which nobody asked for by ``--out "$UNSET"``."""
    for option in _FOLDERS:
        if f"{option}=" in arguments or any(a == option and not b.strip() for a, b in pairwise(arguments)):
            raise InputError(option, "''", "is empty", "name a folder; '.' is the current one")


class DefaultCommand(TyperGroup):
    """A group whose first word may be left out: the command named ``default`` is meant then."""

    default = ""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Put the default command in front where no command of the group is named."""
        if not args or (args[0] not in self.commands and args[0] != "--help"):
            args = [self.default, *args]
        return super().parse_args(ctx, args)


class LongCommand(TyperCommand):
    """A command that takes a while to begin: on a terminal it says at once what it is about, before anything is loaded.

    An option that counts once and is given twice is refused: of two soils or loads the last one alone would count.
    Nothing is said where standard error is no terminal: what reads it there gets warnings and errors alone.
    Verified by tests/unit/test_workbench_commands.py.
    """

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Refuse what is given twice."""
        options = [one for one in self.params if one.param_type_name == "option"]
        for names in (one.opts for one in options if not (one.multiple or getattr(one, "is_flag", False))):
            given = [place for place, word in enumerate(args) if word.partition("=")[0] in names]
            if len(given) > 1:
                raise InputError(names[0], "", "is given twice, and counts once", "leave one of them out")
        return super().parse_args(ctx, args)

    def invoke(self, ctx: Any) -> Any:
        """Say so, then do it."""
        if sys.stderr.isatty():
            about = ctx.params.get("study") or ctx.params.get("scenario")
            words = " ".join(str(one) for one in (ctx.info_name, about) if one)
            sys.stderr.write(f"{for_terminal(words)}: loading and planning\n")
            sys.stderr.flush()
        return super().invoke(ctx)


def computing(workers: int | None, ranks: int, scheduler: str | None) -> Computing:
    """Who computes, by the options of a command."""
    from workbench.execution.runner import Computing

    return Computing(workers=workers or max(1, min(2, os.cpu_count() or 1) // ranks), ranks=ranks, scheduler=scheduler)
