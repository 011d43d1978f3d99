"""``workbench rover``: one scenario of the rover on the tires and the ground asked for, its series, a short table.

Verified by tests/end_to_end/test_rover.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from contracts.errors import ConvergenceError, InputError
from contracts.series import write_series
from contracts.text import one_line
from rover_dynamics.rover.planets import gravity_named
from rover_dynamics.rover.rover_file import EXOMARS_ROVER, RoverDesign, read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS, scenario_named
from rover_dynamics.rover.scenarios.ground import on_terrain, rocks_on_the_way
from rover_dynamics.rover.scenarios.outcome import Outcome
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun, run_scenario
from rover_dynamics.rover.scenarios.scenario_series import scenario_series
from rover_dynamics.rover.scenarios.walking import walked
from workbench.commands.computing import read_and_warn, warn
from workbench.commands.rover_soil import SoilChoice, on_chosen_soil, ruts_npz
from workbench.commands.rover_tires import TireSource, check_tire, file_name, on_tires
from workbench.execution.errors import RunError
from workbench.execution.terminal import console, empty_table
from workbench.report.folders import check_folder, check_targets
from workbench.report.placing import new_files
from workbench.report.series import MOTIONS_FOLDER, RUTS_FOLDER, SERIES_FOLDER
from workbench.study.ancf_tire import tire_values
from workbench.verdict.number_format import displayed

__all__ = ["RoverChoices", "chosen_soil", "list_scenarios", "run_rover"]


def list_scenarios() -> int:
    """Print every scenario's name, what it is and its source."""
    columns = ("scenario", "what happens", "source")
    table = empty_table("scenarios of the rover", columns, texts=columns, folded=columns)
    for scenario in SCENARIOS.values():
        table.add_row(scenario.name, scenario.title, scenario.source)
    console.print(table)
    return 0


@dataclass(frozen=True, slots=True, kw_only=True)
class RoverChoices:
    """What a user may choose beside the scenario.

    Attributes
    ----------
    tire : name of `workbench.commands.rover_tires.TIRES`, or a fitted tire's behind ``ancf_fit:``
    study : file whose tires and ground are the rover's, or None for the thesis'
    rover : rover file, or None for the thesis' rover
    gravity : mars or earth, or None for the rover file's
    terrain : file of a height field to drive on, or None
    start : where on it the rover starts, x and y in the file's coordinates [m]; None for its origin
    rocks : seed of random rocks to drive on, or None
    walk : whether legs and drives walk it, see `rover_dynamics.rover.walking`
    soil : that it drives on instead, or None
    animate : whether to write a page that plays the motion
    """

    tire: str = "brush"
    study: Path | None = None
    rover: Path | None = None
    gravity: str | None = None
    terrain: Path | None = None
    start: tuple[float, float] | None = None
    rocks: int | None = None
    walk: bool = False
    soil: SoilChoice | None = None
    animate: bool = False


def chosen_soil(soil: str | None, cell: str | None) -> SoilChoice | None:
    """What ``--soil`` and ``--cell`` say; InputError for cells of no soil."""
    if soil is None and cell is not None:
        raise InputError("cell of the soil", cell, "is of no soil", "give --soil, or leave it out")
    return None if soil is None else SoilChoice(soil=soil, cell=cell)


def run_rover(name: str | None, out: Path, choices: RoverChoices, store: Path) -> int:
    """Run one scenario, write its series and, if wanted, a page that plays it; print what it ends with.

    Raises
    ------
    InputError
        For a scenario, study, tire, rover or ground that cannot be used.
    RunError
        If the motion stops early; its series is written, marked partial.
    """
    scenario, design = _chosen(name, choices, store)
    check_folder(out)
    stem = f"{scenario.name}_{file_name(choices.tire)}"
    page, ruts = f"{scenario.name}.html", tuple(f"{RUTS_FOLDER}/{stem}.{ending}" for ending in ("npz", "png"))
    targets = [f"{SERIES_FOLDER}/{stem}.csv", f"{MOTIONS_FOLDER}/{stem}.npz"]
    targets += [page] * choices.animate + [*ruts] * (choices.soil is not None)
    check_targets(out, targets)
    if scenario.tire_model.startswith("ancf") and scenario.tire_model != "ancf_wheel":
        scenario = _resumed(scenario, design, store)
    with console.status(f"{scenario.name}: {scenario.title}"):
        run = run_scenario(scenario, design)
        series = scenario_series(run)
        file, motion = targets[:2]
        with new_files(out, "rover", targets) as new:
            write_series(series, new.folder / file)
            _record(scenario, run, new.folder / motion)
            if choices.soil is not None and (left := run.motion.ruts) is not None:
                from workbench.charts.still_charts import ground_png

                (new.folder / ruts[0]).write_bytes(ruts_npz(left))
                (new.folder / ruts[1]).write_bytes(ground_png(left.x, left.y, left.depth, scenario.title))
            if choices.animate:
                _animate(scenario, design, run, new.folder / page)
        if run.stopped is None:
            outcomes = [*scenario.judge(run), *_more(scenario, design)]
    for sentence in new.told:
        console.print(sentence, soft_wrap=True)
    if run.stopped is not None:
        raise RunError(f"{scenario.name}: {run.stopped}; {out / file} is partial")
    _print_outcomes(f"{design.name}: {scenario.title} ({scenario.source})", outcomes)
    told = [("series", out / file)] + [("animation", out / page)] * choices.animate
    for what, path in told + [("ruts", out / ruts[1])] * (choices.soil is not None):
        console.print(f"{what}: {path}", soft_wrap=True)
    return 0


def _resumed(scenario: Scenario, design: RoverDesign, store: Path) -> Scenario:
    """The scenario on ANCF tires with its checkpoint in the store, named after what decides its motion."""
    from workbench.execution.store import Store
    from workbench.execution.task import Task
    from workbench.questions.rover.tires import AncfRide, resuming

    assert isinstance(scenario.ride, AncfRide)
    tire, law = scenario.ride.tire, scenario.ride.on_ground(scenario)
    task = Task(
        name=f"rover_{scenario.name}",
        function="workbench.questions.rover.tires:on_ancf_tires",
        inputs={
            "scenario": scenario.name,
            "title": scenario.title,
            "rover": repr(design),
            "law": asdict(law),
            **tire_values(tire.preset, tire.mesh),
        },
    )
    kept = Store(store)
    return resuming(scenario, kept.checkpoint(task.key({})) if kept.writable else None)


def _more(scenario: Scenario, design: RoverDesign) -> list[Outcome]:
    """What is studied and searched beside the run; says why where it cannot be."""
    found: list[Outcome] = []
    for part in (scenario.study, scenario.search):
        try:
            found += part(scenario, design) if part else ()
        except ConvergenceError as error:
            console.print(f"study of {scenario.name} left out: {error}", soft_wrap=True)
    return found


def _record(scenario: Scenario, run: ScenarioRun, path: Path) -> None:
    """The motion as a file for the viewer."""
    from workbench.questions.rover.motion_file import write_motion
    from workbench.questions.rover.tires import tire_of

    tire = tire_of(scenario)
    write_motion(run, path, None if tire is None else tire_values(tire.preset, tire.mesh))


def _animate(scenario: Scenario, design: RoverDesign, run: ScenarioRun, page: Path) -> None:
    from workbench.questions.rover.animation import write_animation
    from workbench.questions.rover.tires import tire_of

    (x, y, z), ground = scenario.tilt.gravity(1.0), scenario.terrain(design)
    title, tire = scenario.title, tire_of(scenario)
    write_animation(run.motion, design, ground, page, title=title, up=(-x, -y, -z), tire=tire)


def _chosen(name: str | None, choices: RoverChoices, store: Path) -> tuple[Scenario, RoverDesign]:
    """The scenario with the tires and on the ground asked for, and the rover."""
    if choices.soil is None:
        check_tire(choices.tire)
    if name is None:
        raise InputError("scenario", "", "is missing", f"give one of {', '.join(SCENARIOS)}")
    path = choices.rover or EXOMARS_ROVER
    scenario, design = scenario_named(name), read_rover(path)
    warn(path, design.warnings)
    if choices.gravity is not None:
        design = replace(design, gravity=gravity_named(choices.gravity))
    if choices.walk:
        walked(scenario).actuators(design)  # what cannot walk is refused before its tires are computed
    study = None if choices.study is None else read_and_warn(choices.study)
    source = TireSource(study=study, path=choices.study, store=store)
    if choices.soil is not None:
        if choices.terrain is not None or choices.rocks is not None:
            rule = "is level ground: slopes are scenarios of their own"
            raise InputError("soil", f"{choices.soil.soil} and a terrain", rule, "give --soil, --terrain or --rocks")
        _require_no_start(choices)
        driven = walked(scenario) if choices.walk else scenario
        return on_chosen_soil(driven, choices.tire, source, choices.soil), design
    scenario = on_tires(scenario, choices.tire, source, design)
    if choices.walk:
        scenario = walked(scenario)
    return _on_ground(scenario, design, choices), design


def _on_ground(scenario: Scenario, design: RoverDesign, choices: RoverChoices) -> Scenario:
    if choices.terrain is not None and choices.rocks is not None:
        raise InputError("terrain", f"{choices.terrain} and rocks", "are two grounds", "give --terrain or --rocks")
    _require_no_start(choices)
    if choices.rocks is not None:
        rocks = rocks_on_the_way(scenario, design, choices.rocks)
        return on_terrain(scenario, design, rocks, f"random rocks, seed {choices.rocks}")
    if choices.terrain is None:
        return scenario
    from workbench.study.terrain_file import read_height_field

    field = read_height_field(choices.terrain)
    x, y = (place - begin for place, begin in zip(field.origin, choices.start or (0.0, 0.0), strict=True))
    return on_terrain(scenario, design, replace(field, origin=(x, y)), one_line(choices.terrain.name))


def _require_no_start(choices: RoverChoices) -> None:
    if choices.start is not None and choices.terrain is None:
        raise InputError(
            "start", f"{choices.start} m", "is a place on a height field", "give --terrain, or leave it out"
        )


def _print_outcomes(title: str, outcomes: Sequence[Outcome]) -> None:
    columns = ("quantity", "value", "reference", "required", "margin", "verdict")
    table = empty_table(title, columns, texts=["quantity"], folded=["quantity"])
    for one in outcomes:
        sign = ">=" if one.at_least else "<="
        required = "" if one.limit is None else f"{sign} {displayed(one.limit, one.unit)}"
        verdict = {None: "", True: "met", False: "not met"}[one.met]
        numbers = ["" if v is None else displayed(v, one.unit) for v in (one.value, one.reference, one.margin)]
        table.add_row(one.quantity, numbers[0], numbers[1], required, numbers[2], verdict)
    console.print(table)
