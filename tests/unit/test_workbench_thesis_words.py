"""The thesis' sentences as findings: a wheel that satisfies them, and one for each sentence that does not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.model_curves import ModelCurves, RunNumbers, mean_curve
from workbench.questions.words.checks import verdicts, words_checks
from workbench.questions.words.graph import asked, hoops, hoops_tasks, in_phase, twin_tasks
from workbench.questions.words.plausible import Plausible, PlausibleWheel
from workbench.questions.words.readings import READINGS
from workbench.questions.words.results import Words, follows, spread
from workbench.study.model import stated
from workbench.study.reading import built_in_study, read_study

Array = NDArray[np.float64]
DEFLECTION = np.linspace(0.0, 0.04, 81)
SOFTENING = 8250.0 * DEFLECTION * (1.0 - 2.5 * DEFLECTION)
"""Starts with the brush line, 6.3 N below it at 160 N, 18.9 N at 250 N."""


def _curve(load: Array, orientation: float, stress: float = 3e6, negative: float = 0.0) -> StiffnessCurve:
    columns = {"max_linearised_tire_Pa": stress * load, "negative_pivots": np.where(load > 200.0, negative, 0.0)}
    return StiffnessCurve(model="x", orientation_deg=orientation, deflection=DEFLECTION, load=load, columns=columns)


def _model(loads: dict[float, Array], **changes: float) -> ModelCurves:
    curves = {o: _curve(load, o, **changes) for o, load in loads.items()}
    runs = dict.fromkeys(curves, RunNumbers())
    return ModelCurves(model="x", by_orientation=curves, average=mean_curve(list(curves.values())), runs=runs)


def _words(share: float = 0.1, **changes: float) -> Words:
    fe = _model({0.0: (1.0 + share) * SOFTENING, 30.0: SOFTENING, 60.0: (1.0 - share) * SOFTENING}, **changes)
    twin = _model({0.0: (1.0 + 2.0 * share) * SOFTENING, 60.0: (1.0 - 2.0 * share) * SOFTENING})
    return Words(
        fe=fe,
        average=fe.average,
        ancf=_model({0.0: 1.2 * SOFTENING, 45.0: 1.0 * SOFTENING}),
        readings={
            READINGS[0]: _model({0.0: 1.3 * SOFTENING, 45.0: 1.1 * SOFTENING}),
            READINGS[1]: _model({0.0: 1.1 * SOFTENING, 45.0: 0.9 * SOFTENING}),
        },
        brush=replace(_curve(8250.0 * DEFLECTION, 0.0), orientation_deg=None),
        section=fe,
        twin=twin,
        yield_strength={"tire": 880e6},
        plausible=_set(),
    )


def _set() -> Plausible:
    """Two wheels 4 % to both sides of the curve."""
    at = DEFLECTION[1:]
    wheels = [
        PlausibleWheel(
            point=i,
            values={},
            misses={"tire": 0.5},
            chosen={"tire": READINGS[1].name},
            numbers={},
            deflection=at,
            orientation_deg=np.array([0.0]),
            load=np.array([share * SOFTENING[1:]]),
            average=share * SOFTENING[1:],
        )
        for i, share in enumerate((0.96, 1.04))
    ]
    numbers = {"searched": 2, "confirmed": 2, "annealed": 0, "strength": 1.1e9}
    return Plausible(study={}, empty=False, wheels=tuple(wheels), stale=False, **numbers)  # type: ignore[arg-type]


def _status(words: Words) -> dict[str, str]:
    return {check.id.removeprefix("words."): check.status for check in words_checks(words)}


def test_a_wheel_that_satisfies_every_sentence() -> None:
    assert set(_status(_words()).values()) == {"pass"}
    assert all(check.role == "finding" and check.claim and check.why for check in words_checks(_words()))


def _stiff(words: Words) -> Words:
    """An average that follows the brush line to the end."""
    return replace(words, average=replace(words.average, load=8250.0 * words.average.deflection))


@pytest.mark.parametrize(
    ("words", "failed"),
    [
        (_stiff(_words()), {"brush_fails", "average_20mm", "average_30mm", "average_35mm", "band"}),
        (_words(share=0.02), {"follows_0deg", "follows_45deg"}),
        (replace(_words(), twin=_words().section, section=_words().twin), {"out_of_phase"}),
        (_words(stress=4e6), {"no_yielding"}),
        (_words(negative=1.0), {"stable"}),
        (
            replace(_words(), average=replace(_words().average, load=1.06 * _words().average.load)),
            {"small.slope", "average_20mm", "average_30mm", "average_35mm", "brush_fails"},  # 1.9 % outside the band
        ),
    ],
)
def test_each_sentence_fails_where_it_is_not_so(words: Words, failed: set[str]) -> None:
    status = _status(words)
    assert {name for name, found in status.items() if found != "pass"} == failed


def test_verdicts_of_the_statements() -> None:
    """One reading of the first statement is enough; a curve that ends early leaves what it does not reach undecided."""
    assert set(verdicts(_words()).values()) == {"holds"}
    high = replace(_words(), average=replace(_words().average, load=1.04 * _words().average.load))
    assert _status(high)["small.slope"] == "fail"
    assert verdicts(high)["small"] == "holds"
    assert verdicts(_words(stress=4e6))["ours"] == "does not hold"
    average = _words().average
    kept = average.deflection < 0.025
    short = replace(
        _words(), average=replace(average, deflection=average.deflection[kept], load=average.load[kept], columns={})
    )
    assert verdicts(short)["averages"] == "not decided"
    assert verdicts(short)["small"] == "holds"
    off = replace(short, average=replace(short.average, load=0.8 * short.average.load))
    assert verdicts(off)["averages"] == "does not hold"
    assert verdicts(off)["small"] == "does not hold"


def test_the_hoops_are_their_own_study_with_their_own_twin() -> None:
    tasks = {task.name: task for task in hoops_tasks()}
    assert hoops().name == "exomars_hoops"
    assert [name for name in tasks if name.startswith("words_hoops_phi")] == [
        f"words_hoops_phi{angle:03d}" for angle in (0, 15, 30, 45, 60)
    ]
    assert dict(hoops().wheel.springs[1])["phase"] == pytest.approx(np.pi / 3.0)
    assert dict(in_phase(hoops()).wheel.springs[1])["phase"] == 0.0
    assert tasks["words_hoops_phi015"].inputs["wheel"] != tasks["words_hoops_twin_phi015"].inputs["wheel"]


def test_numbers_of_the_sentences() -> None:
    """At 250 N / 8.25 N/mm = 30.3 mm the average lies 2.5 * 30.3 mm = 7.6 % below the line."""
    words = _words()
    assert words.brush_slope == pytest.approx(8250.0)
    assert words.brush_misses(250.0) == pytest.approx(-2.5 * 250.0 / 8250.0, rel=1e-3)
    assert words.reading == READINGS[1]
    assert words.average_over(words.tire, 0.02) == pytest.approx(1.0)
    assert words.average_over(words.ancf, 0.02) == pytest.approx(1.0 / 1.1)
    assert follows(words.fe, words.tire.by_orientation[45.0]) == (60.0, pytest.approx(0.0, abs=1e-12))
    assert spread(words.section, 0.02) == pytest.approx(0.2)
    assert words.stress(250.0) == pytest.approx(750.0 / 880.0)
    assert words.shown["spread"] == "20 % as it is, 40 % in phase"
    assert words.shown["followed"] == "0° by 0° within 0.0 %, 45° by 60° within 0.0 %"


def test_a_curve_that_ends_early_is_an_error_and_no_verdict() -> None:
    words = _words()
    short = {
        o: replace(c, deflection=c.deflection[:40], load=c.load[:40], columns={k: v[:40] for k, v in c.columns.items()})
        for o, c in words.fe.by_orientation.items()
    }
    fe = replace(words.fe, by_orientation=short)
    ended = replace(words, fe=fe, average=replace(fe.by_orientation[30.0], orientation_deg=None))
    assert ended.shown["large"] == "not reached"
    assert ended.shown["averages"].count("not reached") == 3
    status = _status(replace(words, fe=fe))
    assert {name for name, found in status.items() if found == "error"} == {
        "follows_0deg",
        "follows_45deg",
        "no_yielding",
        "stable",
    }


def test_the_twin_is_the_wheel_with_its_springs_in_phase() -> None:
    study = read_study(built_in_study())
    assert asked(study)
    assert [springs.phase for springs in in_phase(study).wheel.springs] == [0.0, 0.0]
    tasks = twin_tasks(study)
    assert len(tasks) == len(study.fe.orientations)
    assert not asked(study.model_copy(update={"brush": None}))
    other = stated(study.ancf, "ancf").model_copy(update={"thesis_preset": False})
    assert not asked(study.model_copy(update={"ancf": other}))


def test_the_band_is_what_the_set_spans() -> None:
    """Of two wheels 4 % to both sides; a curve 10 % high leaves it by 1.10 / 1.04 - 1."""
    found, curve = _set(), _curve(SOFTENING, 0.0)
    np.testing.assert_allclose(found.band.load, SOFTENING)
    np.testing.assert_allclose(found.band.columns["load_high_N"], 1.04 * SOFTENING)
    assert found.outside(curve) == 0.0
    with pytest.raises(InputError, match="ends before the band's first point"):
        found.outside(replace(curve, deflection=1e-4 * DEFLECTION / 0.04, columns={}))
    assert found.outside(replace(curve, load=1.1 * curve.load)) == pytest.approx(1.1 / 1.04 - 1.0)
    assert found.outside(replace(curve, load=0.9 * curve.load)) == pytest.approx(1.0 - 0.9 / 0.96)


def test_what_the_mesh_does_not_know_well_enough_is_not_decided() -> None:
    """Where the mesh's uncertainty reaches across a limit; negative control: a mesh that is sure decides."""
    near, sure = (replace(_words(), mesh=mesh) for mesh in (0.2, 1e-9))
    assert {s for n, s in _status(near).items() if n.startswith(("average_", "follows_", "small."))} == {"undecided"}
    assert (verdicts(near)["averages"], verdicts(near)["follows"]) == ("not decided", "not decided")
    assert (verdicts(sure)["averages"], verdicts(sure)["follows"]) == ("holds", "holds")
