"""``workbench calibrate``: its three commands. Verified by tests/end_to_end/test_calibrate.py."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from workbench.commands.options import (
    DEFAULT_STORE,
    DefaultCommand,
    LongCommand,
    Ranks,
    Scheduler,
    StoreOption,
    StudyOrBuiltIn,
    Workers,
    computing,
)

__all__ = ["calibrate_app"]


class _ThicknessByDefault(DefaultCommand):
    """``workbench calibrate STUDY`` means ``workbench calibrate thickness STUDY``."""

    default = "thickness"


calibrate_app = typer.Typer(
    cls=_ThicknessByDefault,
    help="Strip thickness for an initial tangent (the default), fit of the ANCF tire, brush numbers of the wheel.",
)


@calibrate_app.command("thickness", cls=LongCommand)
def calibrate_thickness(
    study: StudyOrBuiltIn = None,
    target: Annotated[
        str | None, typer.Option(help="Initial tangent, e.g. '8.25 N/mm'; that of the study's reference if left out.")
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder of calibration.json and the study.")] = Path("build/calibration"),
    store: StoreOption = DEFAULT_STORE,
    workers: Workers = None,
    ranks: Ranks = 1,
    scheduler: Scheduler = None,
) -> None:
    """Find the strip thickness for an initial tangent: section model first, confirmed by the solid one. The default."""
    from workbench.commands.calibrate import run_calibrate

    raise typer.Exit(run_calibrate(study, target, out, store, computing(workers, ranks, scheduler)))


@calibrate_app.command("ancf", cls=LongCommand)
def calibrate_ancf(
    study: StudyOrBuiltIn = None,
    tire: Annotated[
        str | None, typer.Option(help=r"One tire of \[ancf_fit]; all of them if left out.", show_default=False)
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder of ancf_fit.json, the curves and the study.")] = Path(
        "build/calibration"
    ),
    store: StoreOption = DEFAULT_STORE,
    workers: Workers = None,
    ranks: Ranks = 1,
    scheduler: Scheduler = None,
) -> None:
    """Fit the ANCF tire to the finite element curves of every orientation."""
    from workbench.commands.calibrate_ancf import run_calibrate_ancf

    raise typer.Exit(run_calibrate_ancf(study, tire, out, store, computing(workers, ranks, scheduler)))


@calibrate_app.command("brush", cls=LongCommand)
def calibrate_brush(
    study: StudyOrBuiltIn = None,
    model: Annotated[str, typer.Option(help="fe or ancf_wheel.")] = "fe",
    load: Annotated[float, typer.Option(help="Load in newtons at which the two are alike.")] = 200.0,
    out: Annotated[Path, typer.Option(help="Folder of brush_of_wheel.csv.")] = Path("build/calibration"),
    store: StoreOption = DEFAULT_STORE,
    workers: Workers = None,
    ranks: Ranks = 1,
    scheduler: Scheduler = None,
) -> None:
    """Brush numbers of the wheel beside Table II, from its curves and its load cases along the ground."""
    from workbench.commands.calibrate_brush import run_calibrate_brush

    raise typer.Exit(run_calibrate_brush(study, (model, load), out, store, computing(workers, ranks, scheduler)))
