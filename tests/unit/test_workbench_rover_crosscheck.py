"""The fitted tire under the rover against the FE curves: symmetry, differences, tasks, section."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import jinja2
import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.mesh_study.results import MeshFamily, MeshRun, MeshStudy
from workbench.questions.model_curves import RunNumbers
from workbench.questions.rover_crosscheck.question import ROVER_CROSSCHECK, SWEEP
from workbench.questions.rover_crosscheck.results import (
    CrossCheck,
    StoodTire,
    Warmth,
    WheelPoint,
    image,
    lattice,
    unsolved,
)
from workbench.questions.rover_crosscheck.task import stand
from workbench.report.page import TEMPLATES
from workbench.study.reading import built_in_study, read_study

D = np.linspace(0.0, 0.04, 41)
STUDY = read_study(built_in_study())
STATIC = 198.0


def stiffness(orientation: float) -> float:
    """Of the FE wheel here [N/m]: a wave of 30 degrees and one of 120, mirrored about zero."""
    phi = np.radians(orientation)
    return float(8000.0 * (1.0 + 0.05 * np.cos(12.0 * phi) + 0.02 * np.cos(3.0 * phi)))


def curve(orientation: float | None, k: float, model: str = "fe") -> StiffnessCurve:
    return StiffnessCurve(model=model, orientation_deg=orientation, deflection=D, load=k * D)


def tire(name: str, spokes: int, factor: float = 1.0, wave: float = 0.05) -> StoodTire:
    """On springs `factor` times as stiff as the mean FE wheel, with the wave of 30 degrees."""
    points = []
    for o in lattice(360.0 / spokes):
        k = 8000.0 * factor * (1.0 + wave * np.cos(12.0 * np.radians(o)))
        points += [WheelPoint(mean_load=f, orientation=o, load=f, deflection=f / k) for f in (STATIC, 250.0)]
    return StoodTire(name=name, period=360.0 / spokes, points=tuple(points))


def results(factor: float = 1.0) -> CrossCheck:
    runs = [
        MeshRun(
            factor=x, curve=curve(0.0, 8000.0 * (1.0 + 1e-4 * i * i)), numbers=RunNumbers(cells=1000 * 4 ** (2 - i))
        )
        for i, x in enumerate((2.0, 1.5, 1.0))
    ]
    return CrossCheck(
        stood=(tire("four_spokes", 4, factor), tire("six_spokes", 6, factor)),
        kept="six_spokes",
        solid={o: curve(o, stiffness(o)) for o in (0.0, 15.0, 30.0, 45.0, 60.0)},
        section={o: curve(o, stiffness(o)) for o in unsolved([0.0, 15.0, 30.0, 45.0, 60.0], 120.0, True)},
        average=curve(None, 8000.0),
        period=120.0,
        mirrored=True,
        mesh_study=MeshStudy(
            families=(
                MeshFamily(
                    orientation_deg=0.0, deflections=(0.02,), runs=(runs[0], runs[1], runs[2]), curves_factor=1.0
                ),
            )
        ),
        static_load=STATIC,
        warmth=(Warmth(temperature=130.15, modulus_ratio=1.1, deflection=0.0225),),
    )


def test_equal_orientations_of_a_mirrored_wheel() -> None:
    assert [image(o, 120.0, True) for o in (0.0, 45.0, 75.0, 120.0, 345.0)] == [0.0, 45.0, 45.0, 0.0, 15.0]
    assert image(75.0, 120.0, False) == 75.0
    assert len(lattice(120.0)) == 24
    assert lattice(90.0)[-1] == 85.0
    assert unsolved([0.0, 15.0, 30.0, 45.0, 60.0], 120.0, True) == [5.0, 10.0, 20.0, 25.0, 35.0, 40.0, 50.0, 55.0]
    assert 75.0 in unsolved([0.0, 15.0, 30.0, 45.0, 60.0], 120.0, False)


def test_differences_are_those_of_the_springs() -> None:
    found = results(1.04)
    mean = found.on_average(found.best, STATIC)
    stiff = np.array([1.04 * (1.0 + 0.05 * np.cos(12.0 * np.radians(o))) for o in lattice(120.0)])
    assert mean.in_load == pytest.approx(stiff.mean() - 1.0, abs=1e-9)
    assert mean.in_deflection == pytest.approx((1.0 / stiff).mean() - 1.0, abs=1e-9)
    single = found.around(found.best, STATIC)[1]
    assert (single.orientation, single.model) == (5.0, "section")
    assert single.in_load == pytest.approx(8000.0 * stiff[1] / stiffness(5.0) - 1.0)
    assert single.allowed == pytest.approx(0.05 + found.mesh_study.index(0.02))
    assert found.reference(105.0)[1] is found.solid[15.0]


def test_a_tire_as_the_wheel_is_inside_and_a_stiffer_one_is_not() -> None:
    def statuses(factor: float) -> list[str]:
        checks = ROVER_CROSSCHECK.checks(STUDY, results(factor))
        assert [c.role for c in checks] == ["finding"] * 4
        return [c.status for c in checks]

    assert statuses(1.0) == ["pass"] * 4
    assert statuses(1.3) == ["fail"] * 4


def test_a_tire_that_folds_is_not_evaluated() -> None:
    found = results()
    folded = StoodTire(name="six_spokes", period=60.0, points=(), failure="a tire folded")
    checks = ROVER_CROSSCHECK.checks(STUDY, replace(found, stood=(found.stood[0], folded)))
    assert {c.status for c in checks} == {"error"}
    with pytest.raises(InputError, match="a tire folded"):
        _ = replace(found, stood=(folded,)).best


def test_what_a_period_can_hold() -> None:
    """Deflections go as 1 - 0.05 cos 12 phi - 0.02 cos 3 phi: 4 and 6 spokes can have the first wave only."""
    found = results()
    share = 0.05**2 / (0.05**2 + 0.02**2)
    assert [found.shared(t) for t in found.stood] == pytest.approx([share] * 2, abs=0.02)
    assert found.shared(tire("three", 3)) == pytest.approx(1.0)
    assert found.correlation(found.best) == pytest.approx(np.sqrt(share), abs=0.02)
    assert found.spread(found.best)[0] == pytest.approx(0.05 / np.sqrt(2.0), rel=0.02)


def test_a_colder_wheel_is_stiffer_by_its_modulus() -> None:
    found = results()
    assert found.fe_deflection(1.1) == pytest.approx(STATIC / 8000.0 / 1.1)
    tasks = {task.name: task for task in ROVER_CROSSCHECK.tasks(STUDY)}
    ratios = tasks["rover_stands_six_spokes"].inputs["modulus_ratios"]
    assert ratios[2] == pytest.approx(1.0)
    assert ratios[0] > ratios[1] > 1.0 > ratios[3]


def test_tasks_of_the_built_in_study() -> None:
    tasks = {task.name: task for task in ROVER_CROSSCHECK.tasks(STUDY)}
    assert (
        sum(name.startswith("crosscheck_phi") for name in tasks) == 16
    )  # of the 24 by 5 deg, those that the section model has not
    assert tasks["rover_stands_six_spokes"].inputs["loads"] == list(SWEEP)
    assert tasks["rover_stands_four_spokes"].inputs["loads"] == []
    assert tasks["rover_stands_four_spokes"].needs == ("ancf_fit_four_spokes",)
    assert not ROVER_CROSSCHECK.applies(STUDY.model_copy(update={"ancf_fit": None}))


def test_a_fit_without_a_result_is_passed_on(tmp_path: Path) -> None:
    (tmp_path / "fit").mkdir()
    (tmp_path / "fit" / "result.json").write_text(json.dumps({"failure": "no start"}), encoding="utf-8")
    (tmp_path / "out").mkdir()
    stand({"fit": "f", "loads": [], "modulus_ratios": []}, {"f": tmp_path / "fit"}, tmp_path / "out", lambda _: None)
    assert json.loads((tmp_path / "out" / "result.json").read_text()) == {"points": [], "failure": "no start"}


def test_the_section_says_what_was_found() -> None:
    found = results(1.04)
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
    )
    figures = ROVER_CROSSCHECK.figures(STUDY, found)
    names = ("section", "evidence")
    parts = [
        environment.get_template(f"rover_crosscheck/{n}.html.j2").render(results=found, figures=figures) for n in names
    ]
    text = "".join(parts)
    assert "5 orientations are solved by the solid model; the 8 others" in " ".join(text.split())
    assert text.count("crosscheck-sweep") > 1
    assert text.count("<td>section</td>") == 16
    assert "-143 °C" in text
