"""A study's tires under the rover: those of the built-in study are the thesis', every number reaches every run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.wheel_set import THESIS_LAW
from contracts.errors import InputError
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.tires.brush_tire import THESIS_BRUSH
from workbench.commands.rover_tires import TireSource, check_tire, file_name, on_tires
from workbench.execution.task import Task
from workbench.questions.rover.question import ROVER
from workbench.questions.rover.tires import DISSIPATION, AncfRide, contact_law
from workbench.questions.rover_ancf.question import LONG, ROVER_ANCF, SHORT
from workbench.questions.rover_ancf.runs import FINE_GRID, ancf_run
from workbench.questions.rover_closer.question import ROVER_CLOSER
from workbench.questions.rover_crosscheck.question import ROVER_CROSSCHECK
from workbench.study.ancf_tire import tire_from
from workbench.study.brush_tire import brush_from
from workbench.study.model import Study
from workbench.study.model_parameters import fit_start, fits_rover, rover_ancf, rover_on_ancf, rover_on_brush
from workbench.study.reading import built_in_study, read_study

STUDY, DESIGN = read_study(built_in_study()), read_rover()
ON_BRUSH = {f"rover_{name}" for name in SCENARIOS}
ON_ANCF = {f"rover_ancf_{name}" for name in (*SHORT, *LONG)}
OTHER_BRUSH = {
    "radial_stiffness": 8000.0,
    "radial_damping": 8000.0,
    "longitudinal_slip_stiffness": 8000.0,
    "cornering_stiffness_per_degree": 800.0,
    "friction_min": 0.5,
    "friction_max": 0.8,
    "rolling_resistance": 0.02,
    "lever": "loaded",
}
OTHER_ANCF = {
    "outer_radius": 0.14250001,
    "datum_radius": 0.1424999999,
    "hub_radius": 0.045,
    "width": 0.11,
    "rim_thickness": 0.02,
    "spoke_thickness": 0.02,
    "circumferential_plates": 8,
    "spokes": 2,
    "phase": 0.1,
    "plates_per_spoke": 2,
    "young_modulus": 3e5,
    "poisson_ratio": 0.1,
    "density": 1400.0,
    "contact_stiffness": 1100.0,
    "contact_points": (9, 10),
    "contact_layout": "centres",
    "contact_damping": "none",
    "quadrature": (4, 4, 2),
}


def changed(section: str, **values: Any) -> Study:
    """The built-in study with other numbers of a section, every run of the rover asked for."""
    rover = STUDY.rover.model_copy(update={"on_ancf_tires": "all"})
    other = getattr(STUDY, section).model_copy(update=values)
    return STUDY.model_copy(update={"rover": rover, section: other})


def keys(study: Study) -> dict[str, str]:
    """Of every rover task, as if what it needs stayed the same."""
    questions = (ROVER, ROVER_ANCF, ROVER_CROSSCHECK, ROVER_CLOSER)
    tasks: list[Task] = [task for question in questions for task in question.tasks(study)]
    return {task.name: task.key(dict.fromkeys(task.needs, "")) for task in tasks if task.name.startswith("rover")}


def moved(study: Study) -> set[str]:
    """Tasks that this study computes anew."""
    before, after = keys(changed("brush")), keys(study)
    assert before.keys() == after.keys()
    return {name for name, key in after.items() if key != before[name]}


def test_every_number_of_the_brush_reaches_every_run_on_brush_tires() -> None:
    assert set(OTHER_BRUSH) == set(type(STUDY.brush).model_fields) - {"source"}
    for name, value in OTHER_BRUSH.items():
        assert moved(changed("brush", **{name: value})) == ON_BRUSH | {"rover_closer"}, name
    assert moved(changed("brush", source="elsewhere")) == set()


def test_every_number_of_the_ancf_tire_reaches_every_run_on_it() -> None:
    assert set(OTHER_ANCF) == {one.name for one in fields(thesis_preset())}
    for name, value in OTHER_ANCF.items():
        assert moved(changed("ancf", **{name: value})) == ON_ANCF | {"rover_closer"}, name


def test_friction_of_the_ground_reaches_every_run_of_the_rover() -> None:
    assert moved(changed("ground", friction=0.6)) == ON_BRUSH | ON_ANCF | {"rover_closer"}
    assert moved(changed("fe", friction=0.3)) == set()


def test_the_built_in_studys_brush_tire_is_table_twos() -> None:
    inputs = rover_on_brush(STUDY)
    assert inputs["friction"] is None
    found = brush_from(inputs["brush"])
    for one in fields(found):
        if one.name != "source":
            assert getattr(found, one.name) == getattr(THESIS_BRUSH, one.name), one.name


def test_the_built_in_studys_ancf_tire_and_contact_are_the_thesis() -> None:
    inputs = rover_on_ancf(STUDY)
    assert inputs["friction"] is None
    found, wanted = tire_from(inputs), build_tire(thesis_preset())
    assert asdict(found.preset) == asdict(wanted.preset)
    for name in ("points", "elements", "gradients", "dimensions"):
        np.testing.assert_array_equal(getattr(found.mesh, name), getattr(wanted.mesh, name))
    assert contact_law(found.preset) == replace(THESIS_LAW, damping_depth=1e-3)


def source(study: Study) -> TireSource:
    return TireSource(study=study, path=None, store=Path("nowhere"))


def test_the_scenarios_on_the_built_in_studys_brush_are_those_of_the_catalogue() -> None:
    frictions = {"traction": (0.6, 0.6), "stability": (10.0, 10.0)}
    for name, scenario in SCENARIOS.items():
        driven = on_tires(scenario, "brush", source(STUDY), DESIGN)
        assert replace(driven, tire=scenario.tire) == scenario
        before, after = scenario.vehicle(DESIGN), driven.vehicle(DESIGN)
        assert replace(after.tire, source=before.tire.source) == before.tire
        assert (after.settings, after.model.gravity) == (before.settings, before.model.gravity)
        low, high = frictions.get(name, (0.597, 0.757))
        assert before.tire == replace(THESIS_BRUSH, friction_min=low, friction_max=high)
        np.testing.assert_array_equal(
            [body.position for body in after.model.bodies], [body.position for body in before.model.bodies]
        )


def test_the_runs_on_the_built_in_studys_ancf_tire_are_those_of_the_thesis() -> None:
    """Angle, contact and friction of each, as they were when the numbers stood in the code."""
    tire, law = tire_from(rover_on_ancf(STUDY)), replace(THESIS_LAW, damping_depth=1e-3)
    share = 100.0 / math.prod(FINE_GRID)
    fine = replace(law, stiffness=share * 1000.0, damping=share * 100.0)
    other = {"traction_undamped": law.undamped(), "traction_fine_grid": fine}
    for name in (*SHORT, *LONG):
        ride = ancf_run(name, DESIGN, tire).ride
        assert isinstance(ride, AncfRide)
        assert ride.law == other.get(name, law), name
        assert ride.on_ground(ancf_run(name, DESIGN, tire)) == other.get(name, law), name
        assert ride.turned == (0.25 * math.pi if name == "load_sweep_between" else 0.0)
        if name == "traction_fine_grid":
            wanted = build_tire(replace(thesis_preset(), contact_points=FINE_GRID))
            assert ride.tire.preset == wanted.preset
            np.testing.assert_array_equal(ride.tire.mesh.gradients, wanted.mesh.gradients)
        else:
            assert ride.tire is tire


def test_a_finer_contact_grid_of_as_much_stiffness_has_as_much_damping() -> None:
    law = contact_law(replace(thesis_preset(), contact_points=(20, 20), contact_stiffness=250.0))
    assert (law.stiffness, law.damping, law.friction) == (250.0, 25.0, 0.6)


def test_every_tire_but_the_thesis_has_hunt_and_crossleys_damping() -> None:
    """Without a word of the study; what it states stands, but as printed is no fitted tire's."""
    printed = replace(THESIS_LAW, damping_depth=1e-3)
    law = contact_law(rover_ancf(changed("ancf", thesis_preset=False, contact_damping=None)))
    assert (law.damping, law.damping_depth, law.dissipation, law.friction) == (0.0, 0.0, DISSIPATION, 0.6)
    assert contact_law(rover_ancf(changed("ancf", contact_damping=None))) == printed
    assert contact_law(rover_ancf(changed("ancf", thesis_preset=False))) == printed
    bare = changed("ancf", contact_damping="none")
    assert contact_law(rover_ancf(bare)) == printed.undamped()
    assert STUDY.ancf_fit is not None
    for tire in STUDY.ancf_fit.tires:
        assert fit_start(STUDY, tire).contact_damping == "hunt_crossley"
        assert fit_start(bare, tire).contact_damping == "none"


def test_a_load_sweep_begins_on_a_spoke_wherever_the_spokes_stand() -> None:
    """Turned about the axle by its phase a tire is the same as one of phase 0."""
    preset = replace(thesis_preset(), phase=0.3)
    ride = ancf_run("load_sweep", DESIGN, build_tire(preset)).ride
    assert isinstance(ride, AncfRide)
    c, s = math.cos(ride.turned), math.sin(ride.turned)
    about_axle = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    wanted = build_tire(thesis_preset()).mesh.points
    found = build_tire(preset).mesh.points @ about_axle.T
    assert np.abs(found[:, None] - wanted).sum(axis=2).min(axis=1).max() < 1e-12


@pytest.mark.parametrize("tire", ["rigid", "brush", "ancf"])
def test_the_ground_reaches_every_tire_of_the_command(tire: str) -> None:
    driven = on_tires(SCENARIOS["traction"], tire, source(changed("ground", friction=0.25)), DESIGN)
    assert (driven.friction, driven.tire_model) == (0.25, tire)
    assert driven.title.endswith("friction 0.25")
    if isinstance(driven.ride, AncfRide):
        assert driven.ride.on_ground(driven).friction == 0.25
    else:
        assert driven.vehicle(DESIGN).tire.friction_max == 0.25


def test_a_study_of_another_wheel_is_refused_and_its_ancf_tire_not_driven() -> None:
    amalia = read_study(built_in_study().parent / "amalia.toml")
    with pytest.raises(InputError, match=r"study's wheel = 90 mm: is not that of the rover's wheels, 142\.5 mm"):
        on_tires(SCENARIOS["static"], "brush", source(amalia), DESIGN)
    small = replace(DESIGN, wheel_radius=0.09)
    for tire in ("brush", "ancf"):  # the thesis' tires are none of a smaller wheel
        with pytest.raises(InputError, match=rf"\[{tire}\]: is not in the study"):
            on_tires(SCENARIOS["static"], tire, source(amalia), small)
    own = amalia.model_copy(update={"brush": changed("brush", radial_stiffness=16500.0).brush})
    assert on_tires(SCENARIOS["static"], "brush", source(own), small).tire.radial_stiffness == 16500.0
    assert (fits_rover(STUDY), fits_rover(amalia)) == (True, False)
    questions: Mapping[str, Any] = {t.name: t for t in (ROVER_ANCF, ROVER_CROSSCHECK, ROVER_CLOSER)}
    assert [t.applies(amalia) for t in questions.values()] == [False] * 3
    assert [t.applies(STUDY) for t in questions.values()] == [True] * 3


def test_a_fitted_tire_is_named_as_the_study_names_it() -> None:
    with pytest.raises(InputError, match=r"'seven_spokes'.*is not one of the study's \(four_spokes, six_spokes\)"):
        on_tires(SCENARIOS["straight"], "ancf_fit:seven_spokes", source(STUDY), DESIGN)
    without = STUDY.model_copy(update={"ancf_fit": None})
    with pytest.raises(InputError, match="it has none"):
        on_tires(SCENARIOS["straight"], "ancf_fit:", source(without), DESIGN)


@pytest.mark.parametrize("name", ["ancf_fits:six_spokes", "Fe", "ancf_wheels", ""])
def test_what_is_no_tire_is_refused(name: str) -> None:
    with pytest.raises(InputError, match="ancf_wheel or ancf_fit:NAME"):
        check_tire(name)
    assert file_name("ancf_fit:six_spokes") == "ancf_fit_six_spokes"
