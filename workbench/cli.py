"""The command line ``workbench``. Heavy libraries are imported by the command that needs them, never on ``--help``.

Exit status: 0 every gate passed, 1 a gate failed, 2 bad input, a failed run or one ended by Ctrl-C. Verified by
tests/end_to_end/test_commands.py and tests/end_to_end/test_interrupt.py.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Annotated

import typer
from typer.exceptions import TyperException

from contracts.errors import InputError, WorkbenchError
from contracts.hub_travel import Way
from contracts.text import for_terminal
from workbench.commands.calibrate_app import calibrate_app
from workbench.commands.ending import complain, flushed, full_disk
from workbench.commands.options import (
    DEFAULT_STORE,
    LongCommand,
    Ranks,
    Scheduler,
    StoreOption,
    StudyArgument,
    StudyOrBuiltIn,
    Workers,
    computing,
    require_folders,
)
from workbench.commands.results_app import results_app
from workbench.execution.interrupts import came, hear_no_more, interrupt_safely
from workbench.execution.standard_streams import quieten

__all__ = ["app", "main"]

_INTERRUPTED = "interrupted; finished results are kept, start again to go on"
_TYPER_INTERRUPTED = 130
"""What Typer makes of Ctrl-C within a command."""
app = typer.Typer(
    name="workbench",
    no_args_is_help=True,
    invoke_without_command=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
)

app.add_typer(calibrate_app, name="calibrate")
app.add_typer(results_app, name="results")


@app.callback()
def whole(
    version: Annotated[bool, typer.Option("--version", help="Show the version.", is_eager=True)] = False,
) -> None:
    """Verify the airless wheel of a Mars rover: continuum finite elements against ANCF and brush tires."""
    if version:
        from importlib.metadata import version as installed

        typer.echo(f"workbench {installed('wheel-workbench')}")
        raise typer.Exit


@app.command(cls=LongCommand)
def report(
    study: StudyOrBuiltIn = None,
    out: Annotated[Path, typer.Option(help="Folder of report.html, summary.json, junit.xml and curves.")] = Path(
        "build/report"
    ),
    store: StoreOption = DEFAULT_STORE,
    workers: Workers = None,
    ranks: Ranks = 1,
    scheduler: Scheduler = None,
    full: Annotated[
        bool, typer.Option("--full", help="Every orientation until the wheel repeats itself, on a finer mesh: hours.")
    ] = False,
    require_wheel: Annotated[
        bool, typer.Option("--require-wheel", help="Exit with 1 unless the wheel does its job.")
    ] = False,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="List the tasks: which are reused, which would be computed; no more.")
    ] = False,
    ci: Annotated[bool, typer.Option("--ci", help="Plain lines for a log; summary to GITHUB_STEP_SUMMARY.")] = False,
    baseline: Annotated[
        Path | None,
        typer.Option(help="Folder of the report accepted last: what changed since may fail, too.", show_default=False),
    ] = None,
) -> None:
    """Compute everything a study asks for, compare, and write the report."""
    from workbench.commands.gate import GateChoices
    from workbench.commands.report import ReportChoices, run_report

    choices = ReportChoices(
        full=full, require_wheel=require_wheel, dry_run=dry_run, gate=GateChoices(ci=ci, baseline=baseline)
    )
    raise typer.Exit(run_report(study, out, store, computing(workers, ranks, scheduler), choices))


@app.command()
def accept(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder that workbench report wrote.")],
    baseline: Annotated[Path, typer.Option(help="Folder that keeps what was accepted.")] = Path("baseline"),
) -> None:
    """Accept a report: later ones are held against it by `workbench report --baseline`."""
    from workbench.commands.accept import run_accept

    raise typer.Exit(run_accept(folder, baseline))


@app.command()
def new(
    file: Annotated[Path, typer.Argument(help="Study file to write; it must not exist yet.", show_default=False)],
    like: Annotated[str, typer.Option("--from", help="exomars, amalia, first or strip_sweep.")] = "first",
) -> None:
    """Write a commented study file to begin with."""
    from workbench.commands.studies import run_new

    raise typer.Exit(run_new(file, like))


@app.command()
def check(study: StudyArgument) -> None:
    """Say whether a study can be used, what is unusual about it, and how many tasks its report takes."""
    from workbench.commands.studies import run_check

    raise typer.Exit(run_check(study))


@app.command()
def mesh(
    study: StudyArgument,
    model: Annotated[str, typer.Option(help="fe, or ancf: the reduced tire's surfaces as STEP.")] = "fe",
    deflection: Annotated[
        list[str] | None,
        typer.Option(help="ancf: the loaded tire too, e.g. '10 mm'; may be given several times.", show_default=False),
    ] = None,
    orientation: Annotated[float, typer.Option(help="ancf: what faces the ground, in degrees.")] = 0.0,
    out: Annotated[Path, typer.Option(help="Folder of the mesh files.")] = Path("build/mesh"),
    store: StoreOption = DEFAULT_STORE,
) -> None:
    """Build and check the mesh; write .msh, .vtu, .step, a summary and a picture. Of the ANCF tire: .step."""
    from workbench.commands.mesh import run_mesh_of

    raise typer.Exit(run_mesh_of(study, model, orientation, tuple(deflection or ()), out, store))


@app.command(cls=LongCommand)
def stiffness(
    study: StudyArgument,
    model: Annotated[
        str, typer.Option(help="fe, section (planar), ancf_wheel (the wheel as plates), ancf (the tire) or brush.")
    ] = "fe",
    orientation: Annotated[
        list[float] | None, typer.Option(help="Degrees; may be given several times. Default: those of the study.")
    ] = None,
    travel: Annotated[
        list[str] | None,
        typer.Option(
            help=f"Move the pressed hub (fe, ancf_wheel): {', '.join(Way)} or all; may be given several times."
        ),
    ] = None,
    path: Annotated[
        str | None,
        typer.Option(
            help="Move it along a path (fe, ancf_wheel): 'radial 10 mm, lateral 5 mm + leaning 1 deg, radial 8 mm'."
        ),
    ] = None,
    load: Annotated[
        float | None,
        typer.Option(
            help="With --travel or --matrix: load in newtons at which the hub moves; 200 if left out.",
            show_default=False,
        ),
    ] = None,
    matrix: Annotated[
        bool, typer.Option("--matrix", help="Stiffness of the standing wheel, six by six (fe, ancf_wheel).")
    ] = False,
    obstacle: Annotated[
        str | None,
        typer.Option(
            help="Press on a step, cleat or half_round in place of the study's ground (fe, section, ancf_wheel)."
        ),
    ] = None,
    height: Annotated[str | None, typer.Option(help="Of the obstacle, e.g. '20 mm'.")] = None,
    width: Annotated[str | None, typer.Option(help="Of a cleat, along the wheel's way.")] = None,
    edge_radius: Annotated[str | None, typer.Option(help="Of a step or cleat; 5 mm if left out.")] = None,
    offset: Annotated[str | None, typer.Option(help="Of the obstacle ahead of the hub; none if left out.")] = None,
    soil: Annotated[
        str | None, typer.Option(help="Press into soil (fe, ancf_wheel): a known one, or a soil's file.")
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder of the curves.")] = Path("build/stiffness"),
    store: StoreOption = DEFAULT_STORE,
    workers: Workers = None,
    ranks: Ranks = 1,
    scheduler: Scheduler = None,
) -> None:
    """Stiffness curves of one model."""
    from workbench.commands.obstacle import chosen_obstacle
    from workbench.commands.stiffness import run_stiffness
    from workbench.study.soil_file import soil_of

    who = computing(workers, ranks, scheduler)
    ground = chosen_obstacle(obstacle, height=height, width=width, edge_radius=edge_radius, offset=offset)
    moves = [name for name, given in (("--travel", travel), ("--path", path), ("--matrix", matrix)) if given]
    if ground is not None and moves:
        raise InputError("--obstacle", ground["shape"], "is pressed on, not moved over", f"leave out {moves[0]}")
    if soil is not None and (moves or ground is not None):
        raise InputError("--soil", soil, "is pressed into, level", f"leave out {moves[0] if moves else '--obstacle'}")
    if len(moves) > 1:
        raise InputError(moves[1], "", f"moves the hub its own way, beside {moves[0]}", f"leave out {moves[0]}")
    if path is not None and load is not None:
        raise InputError("load", f"{load:g} N", "does not go with --path, which says how deep", "leave it out")
    if path is not None:
        from workbench.commands.hub_path import run_path

        raise typer.Exit(run_path(study, model, path, tuple(orientation or ()), out, store, who))
    if matrix:
        from workbench.commands.travel import run_matrix

        raise typer.Exit(run_matrix(study, model, load, tuple(orientation or ()), out, store, who))
    if travel:
        from workbench.commands.travel import run_travel

        raise typer.Exit(run_travel(study, model, (tuple(travel), load), tuple(orientation or ()), out, store, who))
    if load is not None:
        raise InputError("load", f"{load:g} N", "is where the hub's travel begins", "give --travel or --matrix")
    earth = None if soil is None else soil_of(soil)
    raise typer.Exit(run_stiffness(study, model, tuple(orientation or ()), out, store, who, ground, earth))


@app.command(cls=LongCommand)
def modes(
    study: StudyOrBuiltIn = None,
    model: Annotated[str, typer.Option(help="fe, ancf_wheel (the wheel as plates), or both, held together.")] = "fe",
    state: Annotated[str, typer.Option(help="free, held (at its hub) or standing (held, on the ground).")] = "held",
    load: Annotated[
        float | None, typer.Option(help="On a wheel that stands, in N; 200 if left out.", show_default=False)
    ] = None,
    orientation: Annotated[
        float | None,
        typer.Option(
            help="What faces the ground of one that stands, in degrees; the study's first if left out.",
            show_default=False,
        ),
    ] = None,
    grip: Annotated[
        bool, typer.Option("--grip", help="Points that touch the ground stick to it; else they slide freely.")
    ] = False,
    count: Annotated[int, typer.Option(help="Modes, besides those of a rigid body; whole pairs.")] = 10,
    out: Annotated[Path, typer.Option(help="Folder of the tables and fields.")] = Path("build/modes"),
    store: StoreOption = DEFAULT_STORE,
    workers: Workers = None,
) -> None:
    """Natural frequencies and modes of the wheel: free, held at its hub, or standing under a load."""
    from workbench.commands.modes import ModeChoices, run_modes

    choices = ModeChoices(model=model, state=state, load=load, orientation=orientation, count=count, grip=grip)
    raise typer.Exit(run_modes(study, choices, out, store, computing(workers, 1, None)))


@app.command(cls=LongCommand)
def sweep(
    study: StudyArgument,
    out: Annotated[Path, typer.Option(help="Folder of sweep.csv, sweep.parquet and sweep.html.")] = Path("build/sweep"),
    store: StoreOption = DEFAULT_STORE,
    workers: Workers = None,
    ranks: Ranks = 1,
    scheduler: Scheduler = None,
) -> None:
    """Parameter study: every point of the study's section `sweep`, as one table and one page."""
    from workbench.commands.sweep import run_sweep

    raise typer.Exit(run_sweep(study, out, store, computing(workers, ranks, scheduler)))


@app.command(cls=LongCommand)
def optimise(
    study: StudyArgument,
    out: Annotated[Path, typer.Option(help="Folder of optimise.html, optimise.csv, best.toml.")] = Path(
        "build/optimise"
    ),
    store: StoreOption = DEFAULT_STORE,
    workers: Workers = None,
    ranks: Ranks = 1,
    scheduler: Scheduler = None,
) -> None:
    """Best wheel within limits: the study's section `optimise`, searched by a fast model, confirmed by the solid one.

    Exit status 1: no wheel within the limits was found.
    """
    from workbench.commands.optimise import run_optimise

    raise typer.Exit(run_optimise(study, out, store, computing(workers, ranks, scheduler)))


@app.command(cls=LongCommand)
def sample(
    study: StudyOrBuiltIn = None,
    store: StoreOption = DEFAULT_STORE,
    workers: Workers = None,
    ranks: Ranks = 1,
    scheduler: Scheduler = None,
) -> None:
    r"""Sample what is not exactly known of a wheel, \[input_uncertainty]; the report reads what is kept of it."""
    from workbench.commands.sample import run_sample

    raise typer.Exit(run_sample(study, store, computing(workers, ranks, scheduler)))


@app.command(cls=LongCommand)
def mission(
    study: StudyOrBuiltIn = None,
    tire: Annotated[
        list[str] | None,
        typer.Option(help="rigid, brush, fe, ancf_wheel, ancf; may be given several times.", show_default="all"),
    ] = None,
    store: StoreOption = DEFAULT_STORE,
    workers: Workers = None,
    ranks: Ranks = 1,
    scheduler: Scheduler = None,
) -> None:
    """Drive the mission on every kind of tire, search the torque and friction it needs; the report reads the record."""
    from workbench.commands.mission import run_mission

    raise typer.Exit(run_mission(study, tire or (), store, computing(workers, ranks, scheduler)))


@app.command(cls=LongCommand)
def traverse(
    study: StudyOrBuiltIn = None,
    tire: Annotated[
        list[str] | None, typer.Option(help="brush, fe; may be given several times.", show_default="brush")
    ] = None,
    distance: Annotated[float, typer.Option(help="Way to drive, in metres.")] = 2000.0,
    abundance: Annotated[float, typer.Option(help="Share of the ground that rocks cover, up to 0.4.")] = 0.06,
    seed: Annotated[int, typer.Option(help="Of the random rocks.")] = 1,
    speed: Annotated[float, typer.Option(help="In metres an hour.")] = 70.0,
    out: Annotated[Path, typer.Option(help="Folder of the counted cycles.")] = Path("build/traverse"),
    store: StoreOption = DEFAULT_STORE,
    workers: Workers = None,
    ranks: Ranks = 1,
    scheduler: Scheduler = None,
) -> None:
    """Drive the 2 km between two samples over rocks, stretch by stretch; the report reads the record."""
    from workbench.commands.traverse import run_traverse
    from workbench.questions.traverse.graph import Asked

    asked = Asked(distance=distance, speed=speed / 3600.0, abundance=abundance, seed=seed)
    raise typer.Exit(run_traverse(study, tire or (), asked, out, store, computing(workers, ranks, scheduler)))


@app.command(cls=LongCommand)
def roll(
    study: StudyOrBuiltIn = None,
    case: Annotated[str, typer.Option(help="rolling, drop or half_round.")] = "rolling",
    seconds: Annotated[
        float | None, typer.Option(help="Simulated; 1, 0.3 or 2 s if left out.", show_default=False)
    ] = None,
    speed: Annotated[
        float | None, typer.Option(help="Of the drive, in metres an hour; 70 if left out.", show_default=False)
    ] = None,
    height: Annotated[str | None, typer.Option(help="Of the drop; '10 mm' if left out.", show_default=False)] = None,
    radius: Annotated[
        str | None, typer.Option(help="Of the half-round; '10 mm' if left out.", show_default=False)
    ] = None,
    load: Annotated[
        float | None,
        typer.Option(
            help="Weight on the ground, in N; that of a wheel of the thesis' rover if left out.", show_default=False
        ),
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder of the time series.")] = Path("build/roll"),
    store: StoreOption = DEFAULT_STORE,
) -> None:
    """The wheel as thin ANCF plates in motion on Mars: it rolls, falls, or rolls over a half-round."""
    from workbench.commands.roll import RollChoices, run_roll

    choices = RollChoices(case=case, seconds=seconds, speed=speed, height=height, radius=radius, load=load)
    raise typer.Exit(run_roll(study, choices, out, store))


@app.command(cls=LongCommand)
def rover(
    scenario: Annotated[
        str | None, typer.Argument(help="Name of a scenario; --list shows them.", show_default=False)
    ] = None,
    tire: Annotated[
        str,
        typer.Option(
            help="rigid; brush; fe, ancf_wheel: the study's wheel by that model; ancf, ancf_fit:NAME: flexible."
        ),
    ] = "brush",
    study: Annotated[
        Path | None,
        typer.Option(
            help=r"Study whose \[brush], \[ancf] and \[ground] the rover drives on; the thesis' if left out.",
            show_default=False,
        ),
    ] = None,
    rover_file: Annotated[
        Path | None, typer.Option("--rover", help="Rover file (TOML); the thesis' if left out.", show_default=False)
    ] = None,
    gravity: Annotated[
        str | None, typer.Option(help="mars or earth; the rover file's if left out.", show_default=False)
    ] = None,
    terrain: Annotated[
        Path | None,
        typer.Option(help="Height field to drive on (.npz, .tif), in metres, x ahead.", show_default=False),
    ] = None,
    start: Annotated[
        tuple[float, float] | None,
        typer.Option(
            help="Where the rover starts on the height field, x and y in m; 0 0 if left out.", show_default=False
        ),
    ] = None,
    rocks: Annotated[int | None, typer.Option(help="Seed of random rocks to drive on.", show_default=False)] = None,
    walk: Annotated[bool, typer.Option("--walk", help="Walk by legs and drives, beside the driven run.")] = False,
    soil: Annotated[
        str | None,
        typer.Option(help="Drive on soil that keeps its ruts: a known one, or a soil's file.", show_default=False),
    ] = None,
    cell: Annotated[
        str | None, typer.Option(help="Length of the soil's cells; 10 mm if left out.", show_default=False)
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder of the time series.")] = Path("build/rover"),
    store: StoreOption = DEFAULT_STORE,
    animate: Annotated[bool, typer.Option("--animate", help="Write a page that plays it; about a minute.")] = False,
    names: Annotated[bool, typer.Option("--list", help="Show the scenarios.")] = False,
) -> None:
    """One scenario of the rover: its time series, and what it ends with."""
    from workbench.commands.rover import RoverChoices, chosen_soil, list_scenarios, run_rover

    choices = RoverChoices(
        tire=tire,
        study=study,
        rover=rover_file,
        gravity=gravity,
        terrain=terrain,
        start=start,
        rocks=rocks,
        walk=walk,
        soil=chosen_soil(soil, cell),
        animate=animate,
    )
    raise typer.Exit(list_scenarios() if names else run_rover(scenario, out, choices, store))


@app.command(cls=LongCommand)
def drawbar(
    study: StudyOrBuiltIn = None,
    soil: Annotated[
        str, typer.Option(help="A known soil (ding2011, fjs1, jsc1a, grc1, lunar_nominal) or a soil's file, mine.toml.")
    ] = "ding2011",
    load: Annotated[float, typer.Option(help="On the wheel, in N.")] = 200.0,
    slip: Annotated[
        str | None,
        typer.Option(
            help="A to B by STEP, or a number; 0:0.6:0.1 if left out and the wheel is not towed.", show_default=False
        ),
    ] = None,
    tire: Annotated[
        str, typer.Option(help="rigid, brush, fe (the wheel by its solid model) or ancf_wheel (by plates).")
    ] = "fe",
    towed: Annotated[bool, typer.Option("--towed", help="Tow the wheel too, without torque.")] = False,
    gravity: Annotated[str, typer.Option(help="mars or earth: weight of the soil.")] = "mars",
    out: Annotated[Path, typer.Option(help="Folder of drawbar.csv and drawbar.png.")] = Path("build/drawbar"),
    store: StoreOption = DEFAULT_STORE,
    workers: Workers = None,
) -> None:
    """One wheel on soil: drawbar pull, torque, sinkage and efficiency over slip, rigid beside flexible."""
    from workbench.commands.drawbar import DrawbarChoices, run_drawbar

    choices = DrawbarChoices(soil=soil, load=load, slip=slip, tire=tire, towed=towed, gravity=gravity)
    raise typer.Exit(run_drawbar(study, choices, out, store, computing(workers, 1, None)))


@app.command(cls=LongCommand)
def climb(
    study: StudyOrBuiltIn = None,
    soil: Annotated[
        list[str] | None,
        typer.Option(
            help="A known soil or a soil's file; may be given several times. Those of the study if left out.",
            show_default=False,
        ),
    ] = None,
    tire: Annotated[
        list[str] | None,
        typer.Option(
            help="rigid, brush, fe or ancf_wheel; may be given several times. rigid and fe if left out.",
            show_default=False,
        ),
    ] = None,
    angle: Annotated[
        str | None,
        typer.Option(help="Slopes A to B by STEP, or one, in degrees; 0:25:5 if left out.", show_default=False),
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder of climb.csv and climb.png.")] = Path("build/climb"),
    store: StoreOption = DEFAULT_STORE,
    workers: Workers = None,
) -> None:
    """The rover on slopes of soil, up, down and across: slip, torque, energy a metre; kept for the report."""
    from workbench.commands.climb import ClimbChoices, run_climb

    choices = ClimbChoices(soils=tuple(soil or ()), tires=tuple(tire or ()), angle=angle)
    raise typer.Exit(run_climb(study, choices, out, store, computing(workers, 1, None)))


@app.command()
def compare(
    curve: Annotated[
        Path, typer.Argument(help="CSV such as deflection_m,load_N or deflection_mm,load_kN.", show_default=False)
    ],
    reference: Annotated[Path, typer.Argument(help="CSV it is held against.", show_default=False)],
    max_load: Annotated[
        str | None,
        typer.Option(help="Load of the reference to end at, 250 or '0.25 kN'.", show_default=False),
    ] = None,
    uncertainty: Annotated[
        str | None,
        typer.Option(
            help="Of the reference's load, '3 %' or '5 N'; what its file states if left out.", show_default=False
        ),
    ] = None,
    tolerance: Annotated[
        str | None,
        typer.Option(help="Largest relative L2 difference, '5 %': passed, failed or undecided.", show_default=False),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder of an interactive page, a PNG, JSON and CSV.", show_default=False)
    ] = None,
    rating: Annotated[
        str | None,
        typer.Option(help="iso18571: with the rating of ISO/TS 18571, some seconds more.", show_default=False),
    ] = None,
) -> None:
    """Compare two curves from anywhere: metrics, tangents, energy, a verdict. Exit status 1: failed or undecided."""
    from workbench.commands.compare import CompareChoices, run_compare

    choices = CompareChoices(max_load=max_load, uncertainty=uncertainty, tolerance=tolerance, out=out, rating=rating)
    raise typer.Exit(run_compare(curve, reference, choices))


@app.command()
def view(
    folder: Annotated[Path, typer.Argument(help="Folder of a report, stiffness, modes or rover.", show_default=False)],
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port; 0 takes one that is free.")] = 0,
    open_browser: Annotated[bool, typer.Option("--open", help="Open the page in the browser.")] = False,
) -> None:
    """Look at results in the browser: turn the wheel, probe its stress, play the rover, overlay curves."""
    from workbench.commands.view import run_view

    raise typer.Exit(run_view(folder, port, open_browser=open_browser))


@app.command()
def doctor(
    install: Annotated[
        bool, typer.Option("--install", help="Install the Debian packages that are missing; needs root and apt-get.")
    ] = False,
) -> None:
    """Load what the workbench needs, try it, and say what is missing and how to install it."""
    from workbench.commands.doctor import run_doctor

    raise typer.Exit(run_doctor(mend=install))


def main() -> None:
    """Entry point: turns every error into one message on stderr and an exit status."""
    interrupt_safely()
    quieten()
    status = _run(sys.argv[1:])
    exec(
        ""
    )  # Python forgets that Ctrl-C came while a library ran text as code, and ends with our status, not by signal
    sys.exit(flushed(status))


def _run(arguments: list[str]) -> int:
    """Exit status of one command; says in one line what went wrong: Ctrl-C, if an error is what that left behind."""
    try:
        status, message = _ended(arguments)
        hear_no_more()
    except KeyboardInterrupt:  # here, a second one is on its way already and not raised
        hear_no_more()
        status, message = 2, _INTERRUPTED
    if status == _TYPER_INTERRUPTED or (status == 2 and came()):
        status, message = 2, _INTERRUPTED
    if message:
        complain(message)
    return status


def _ended(arguments: list[str]) -> tuple[int, str]:
    """Exit status of one command, and what is to be said of it."""
    try:
        require_folders(arguments)
        return int(app(arguments, standalone_mode=False) or 0), ""
    except TyperException as error:  # wrong usage of the command line
        show = getattr(error, "show", None)
        text = for_terminal(error.format_message())
        if show is None:
            return 2, text
        error.format_message = lambda: text  # type: ignore[method-assign]
        show()
        return 2, ""
    except typer.Abort:
        return 2, _INTERRUPTED
    except WorkbenchError as error:
        return 2, str(error)
    except OSError as error:
        other = f"{error.filename or 'file system'}: {error.strerror or error}; check path, space and rights"
        return 2, full_disk(error, arguments) or other
    except Exception as error:
        if os.environ.get("WORKBENCH_TRACEBACK"):
            raise
        text = f"{type(error).__name__}: {error}; this is a defect of the workbench, please report it"
        return 2, f"{text} (set WORKBENCH_TRACEBACK=1 to see where)"
