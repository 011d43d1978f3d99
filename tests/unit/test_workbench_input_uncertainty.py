"""Input uncertainty: what is drawn, what is kept, and its statistics on closed forms.

Claim: of outputs that are known functions of the inputs, percentiles and rank correlations come out as they must.
Sources: a uniform distribution's percentiles; a^3 with a uniform in [1, 2]; ranks do not change under a monotone
function; a normal distribution's quantiles. Tolerances: a Latin hypercube of n samples has one in each of n equally
likely pieces, so that the percentile of a monotone function of one input is off by no more than one piece.
"""

from __future__ import annotations

import json
import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.special import ndtri
from scipy.stats import qmc

from contracts.curves import StiffnessCurve
from contracts.errors import InputError, StudyError
from workbench.questions.input_uncertainty.keeping import found_of
from workbench.questions.input_uncertainty.question import INPUT_UNCERTAINTY, inputs_checks
from workbench.questions.input_uncertainty.results import Sampled, solid_over_section
from workbench.questions.input_uncertainty.samples import RECORD, Samples, record_task, require_inputs, samples_of
from workbench.questions.input_uncertainty.statistics import (
    at_most_of_all,
    percentiles,
    rank_correlations,
    told_apart,
)
from workbench.questions.kept import keep
from workbench.questions.sweep.graph import SweepRun
from workbench.questions.sweep.results import Outcome
from workbench.study.input_points import as_sampled, input_points, input_values, normal_places
from workbench.study.input_uncertainty import CUT
from workbench.study.model import Study
from workbench.study.reading import built_in_study, study_of
from workbench.study.sweep_points import Point

PATH = built_in_study()
TABLE = tomllib.loads(PATH.read_text(encoding="utf-8"))
RUNS = {"samples": 40, "seed": 3, "orientations": ["0 deg"], "max_deflection": "40 mm", "max_load": "300 N"}
THICKNESS, FRICTION = "wheel.tire.thickness", "fe.friction"
TWO: dict[str, Any] = {
    THICKNESS: {"deviation": "0.03 mm", "source": "a tolerance"},
    FRICTION: {"low": 0, "high": 0.6, "source": "smooth to rough"},
}


def _study(inputs: dict[str, Any] = TWO, **runs: Any) -> Study:
    return study_of(PATH, TABLE | {"input_uncertainty": RUNS | runs | inputs})


def _values(inputs: dict[str, Any] = TWO, **runs: Any) -> list[dict[str, Any]]:
    section = _study(inputs, **runs).input_uncertainty
    assert section is not None
    return input_values(PATH, section, TABLE)


def _sampled(load: Any, values: Any, solid: Any = None, **more: Any) -> Sampled:
    """Samples with these loads (n, m) at 0, 10, ... 40 mm; the wheel as it is has 5 N/mm, by the solid model too."""
    at = 0.010 * np.arange(5)
    straight = 5000.0 * at
    n = len(values)
    samples = Samples(
        keys=tuple(f"wheel.{i}" for i in range(values.shape[1])),
        units=("mm",) * values.shape[1],
        values=values,
        deflection=at,
        nominal_load=straight,
        load=load,
        nominal_stress=800e6,
        stress=more.pop("stress", np.full(n, 800e6)),
        nominal_used=0.8,
        used=more.pop("used", np.full(n, 0.8)),
        early=0,
        notes={},
    )
    curve = StiffnessCurve(model="fe", orientation_deg=None, deflection=at, load=straight if solid is None else solid)
    settings = {"solid_stress": 800e6, "solid_used": 0.8, "up_to": 0.005, "deflections": (0.020,), "loads": (60.0,)}
    return Sampled(samples=samples, solid=curve, judged_load=60.0, **(settings | more))


def _hypercube(n: int, d: int) -> Any:
    return qmc.LatinHypercube(d=d, rng=np.random.default_rng(7)).random(n)


def test_the_band_of_a_known_function_is_its_own() -> None:
    """Load a^3 times the nominal's, a uniform in [1, 2]; the second input does nothing."""
    n, u = 200, _hypercube(200, 2)
    a = 1.0 + u[:, 0]
    found = _sampled(np.outer(a**3, 5000.0 * 0.010 * np.arange(5)), u)
    low, middle, high = found.outputs[1].band  # load at 20 mm, 100 N times a^3
    piece = 1.0 / n
    for q, value in ((0.05, low), (0.5, middle), (0.95, high)):
        assert 100.0 * (1.0 + q - piece) ** 3 <= value <= 100.0 * (1.0 + q + piece) ** 3
    rank = found.outputs[1].rank
    assert rank[0] == pytest.approx(1.0)
    assert abs(rank[1]) < found.outputs[1].limit
    assert found.outputs[2].rank[0] == pytest.approx(-1.0)  # the deflection at a load falls
    assert found.band.columns["load_p95_N"][-1] == pytest.approx(2.0 * high)
    mean = 100.0 * (2.0**4 - 1.0) / 4.0
    assert found.half_width(0.020) == pytest.approx(0.5 * (1.95**3 - 1.05**3) * 100.0 / mean, rel=0.02)


def test_of_two_inputs_the_one_with_the_larger_power_ranks_higher() -> None:
    u = _hypercube(300, 3)
    a, b = 1.0 + u[:, 0], 1.0 + u[:, 1]
    rank = rank_correlations(u, a**3 * b)
    assert 0.9 < rank[0] < 1.0
    assert told_apart(300) < rank[1] < 0.45
    assert abs(rank[2]) < told_apart(300, 0.001)


def test_negative_control_an_output_of_something_else_has_no_rank_correlation() -> None:
    """Drawn apart from the inputs: 5 % of the correlations are beyond the limit, not more; none is near 1."""
    rng, limit, beyond = np.random.default_rng(11), told_apart(100), 0
    for _ in range(200):
        rank = rank_correlations(rng.random((100, 5)), rng.random(100))
        beyond += int((abs(rank) > limit).sum())
    assert 0.03 < beyond / 1000 < 0.07


@pytest.mark.parametrize(("count", "limit"), [(10, 0.632), (30, 0.361), (100, 0.197)])
def test_the_limit_of_a_correlation_is_that_of_the_tables(count: int, limit: float) -> None:
    """Critical values of a correlation at 5 %, two-sided, n - 2 = 8, 28 and 98 degrees of freedom (any table)."""
    assert told_apart(count) == pytest.approx(limit, abs=1e-3)


def test_statistics_of_too_little_are_not_a_number() -> None:
    assert np.isnan(percentiles(np.full(4, np.nan))).all()
    assert np.isnan(rank_correlations(np.ones((5, 1)), np.arange(5.0))).all()
    assert np.isnan(rank_correlations(np.arange(3.0)[:, None], np.arange(3.0))).all()
    assert math.isnan(told_apart(3))
    with_gaps = np.array([[1.0, np.nan], [3.0, np.nan], [np.nan, np.nan]])
    assert percentiles(with_gaps, (50.0,))[0] == pytest.approx([2.0, np.nan], nan_ok=True)


def test_the_solid_model_corrects_every_curve_and_the_wheel_as_it_is_is_the_solid_one() -> None:
    """Solid loads a tenth larger, and a hump at 20 mm: the corrected nominal is the solid curve, samples follow."""
    at = 0.010 * np.arange(5)
    solid = 1.1 * 5000.0 * at + np.array([0.0, 0.0, 7.0, 0.0, 0.0])
    found = _sampled(np.outer([1.0, 2.0], 5000.0 * at), np.array([[0.0], [1.0]]), solid=solid)
    assert found.outputs[1].nominal == pytest.approx(117.0)
    assert found.outputs[1].values == pytest.approx([117.0, 234.0])
    assert found.band.load == pytest.approx(np.interp(found.band.deflection, at, solid))


def test_beyond_the_solid_curve_its_last_ratio_is_kept() -> None:
    line = [StiffnessCurve(model="x", orientation_deg=None, deflection=np.array(d), load=np.array(f))
            for d, f in (([0.0, 0.01, 0.02], [0.0, 10.0, 24.0]), ([0.0, 0.01, 0.04], [0.0, 10.0, 40.0]))]  # fmt: skip
    ratio = solid_over_section(line[0], line[1], np.array([0.0, 0.01, 0.02, 0.04]))
    assert ratio == pytest.approx([1.0, 1.0, 1.2, 1.2])


def test_a_sample_that_ends_early_or_failed_is_left_out_where_it_is_missing() -> None:
    at, n = 0.010 * np.arange(5), 6
    load = np.outer(np.linspace(0.9, 1.1, n), 5000.0 * at)
    load[0], load[1, 2:] = np.nan, np.nan
    found = _sampled(load, np.linspace(0.0, 1.0, n)[:, None])
    assert (found.samples.failed, found.outputs[1].missing, found.outputs[0].missing) == (1, 2, 1)
    assert found.band.deflection[-1] == pytest.approx(0.010)
    with pytest.raises(InputError, match="outside the curve"):
        found.half_width(0.020)
    (check,) = inputs_checks(found, 0.1)
    assert (check.status, check.value) == ("error", None)


def test_of_none_among_n_the_share_of_all_is_bounded_as_by_the_binomial() -> None:
    """(1 - p)^n = 0.05 where none is found."""
    assert (1.0 - at_most_of_all(0, 32)) ** 32 == pytest.approx(0.05)
    assert at_most_of_all(1, 32) > at_most_of_all(0, 32) > at_most_of_all(0, 200)
    assert at_most_of_all(5, 5) == 1.0


def test_a_wheel_that_all_samples_lie_to_one_side_of_is_told() -> None:
    """As with friction, whose range begins at the study's value."""
    line = 5000.0 * 0.010 * np.arange(5)
    inside, outside = (
        _sampled(np.outer(factors, line), factors[:, None]).outputs[1]
        for factors in (np.linspace(0.9, 1.1, 20), np.linspace(1.01, 1.1, 20))
    )
    assert (inside.beyond, outside.beyond) == (False, True)


def test_the_share_that_yields_is_corrected_and_counts_only_what_reaches_the_load() -> None:
    used = np.array([0.7, 0.79, 0.81, np.nan])
    found = _sampled(np.ones((4, 5)), np.arange(4.0)[:, None], used=used, solid_used=1.0)
    assert found.yielding == pytest.approx(1.0 / 3.0)  # times 1 / 0.8


@pytest.mark.parametrize(("spread", "status"), [(0.05, "pass"), (0.15, "fail")])
def test_the_band_is_judged_against_what_models_may_differ_by(spread: float, status: str) -> None:
    factors = np.linspace(1.0 - spread, 1.0 + spread, 101)
    found = _sampled(np.outer(factors, 5000.0 * 0.010 * np.arange(5)), factors[:, None])
    (check,) = inputs_checks(found, 0.1)
    assert (check.id, check.role, check.status) == ("inputs.half_width_20mm", "finding", status)
    assert check.value == pytest.approx(0.9 * spread)


def test_the_same_seed_draws_the_same_samples() -> None:
    assert _values() == _values()
    assert _values() != _values(seed=4)


def test_a_normal_input_has_one_sample_in_each_of_as_many_equally_likely_pieces_and_none_beyond_its_cut() -> None:
    drawn = np.array([float(v[THICKNESS].removesuffix(" mm")) for v in _values(samples=400)])
    middle = float(TABLE["wheel"]["tire"]["thickness"].removesuffix(" mm"))
    assert np.max(abs(drawn - middle)) <= CUT * 0.03
    assert drawn.mean() == pytest.approx(middle, abs=1e-4)
    assert drawn.std() == pytest.approx(0.03 * 0.98657, rel=0.01)  # of a normal distribution cut at 3 deviations
    middles = (np.arange(400) + 0.5) / 400
    cut = 0.0013498980316301
    assert np.sort(drawn) == pytest.approx(middle + 0.03 * ndtri(cut + middles * (1.0 - 2.0 * cut)), abs=0.015)
    friction = np.array([v[FRICTION] for v in _values(samples=400)])
    assert np.sort(friction) / 0.6 * 400 == pytest.approx(np.arange(400) + 0.5, abs=0.501)  # six digits


def test_negative_control_places_that_are_not_transformed_are_not_normal() -> None:
    u = (np.arange(400) + 0.5) / 400
    assert normal_places(u).std() == pytest.approx(0.98657 / (2.0 * CUT), rel=0.01)
    assert u.std() > 1.5 * normal_places(u).std()


def test_points_are_whole_studies_with_the_runs_of_the_section() -> None:
    study = _study(samples=20)
    assert study.input_uncertainty is not None
    first, *sampled = input_points(PATH, TABLE, study.input_uncertainty)
    assert (first.number, first.values, len(sampled)) == (0, {}, 20)
    assert first.study.fe == as_sampled(study, study.input_uncertainty).fe
    for point in sampled:
        assert point.study.fe.friction == point.values[FRICTION]
        assert point.study.fe.max_deflection == 0.040
        assert f"{1e3 * point.study.wheel.tire.thickness:.6g} mm" == point.values[THICKNESS]


@pytest.mark.parametrize(
    ("inputs", "message"),
    [
        ({}, "wheel.tire.thickness.*must be given"),
        ({THICKNESS: {"source": "s"}}, "must have low and high, or a deviation"),
        ({THICKNESS: {"low": "0.8 mm", "high": "1 mm", "deviation": "1 mm", "source": "s"}}, "low and high, or a dev"),
        ({THICKNESS: {"low": "1 mm", "high": "0.8 mm", "source": "s"}}, "low less than high"),
        ({THICKNESS: {"deviation": "-1 mm", "source": "s"}}, "greater than zero"),
        ({THICKNESS: {"deviation": "0.1 mm"}}, "source.*is missing"),
        ({"ancf.young_modulus": {"low": 1, "high": 2, "source": "s"}}, "nothing that the section model computes with"),
        ({"orientation": {"low": "0 deg", "high": "1 deg", "source": "s"}}, "nothing that the section model"),
        (TWO | {f"{THICKNESS} = wheel.springs[0].thickness": TWO[THICKNESS]}, "draws wheel.tire.thickness, as"),
        (TWO | {"wheel..tire.thickness": TWO[THICKNESS]}, "draws wheel..tire.thickness, as"),
        (TWO | {"strip_scale": {"low": 0.9, "high": 1.1, "source": "s"}}, "every strip's thickness"),
        ({"materials.Ti-6Al-4V.density": {"low": 4e3, "high": 5e3, "source": "s"}}, "nothing that the section model"),
        ({"wheel.cone.thickness": {"low": "1 mm", "high": "2 mm", "source": "s"}}, "nothing that the section model"),
        (TWO | {"deflections": ["10 mm", "50 mm"]}, "50 mm.* lies beyond max_deflection = 40 mm"),
        (TWO | {"loads": ["400 N"]}, "400 N.* lies beyond max_load = 300 N"),
    ],
)
def test_what_cannot_be_drawn_is_refused(inputs: dict[str, Any], message: str) -> None:
    with pytest.raises(StudyError, match=message):
        _study(inputs)


@pytest.mark.parametrize(
    ("inputs", "message"),
    [
        ({THICKNESS: {"low": "1 mm", "high": "2 mm", "source": "s"}}, "misses the study's value.*0.9235 mm"),
        ({THICKNESS: {"low": "0.095 cm", "high": "0.1 cm", "source": "s"}}, "misses the study's value.*0.9235 mm"),
        ({THICKNESS: {"low": 0.00095, "high": 0.001, "source": "s"}}, "misses the study's value.*0.9235 mm"),
        ({THICKNESS: {"deviation": "1e-30 mm", "source": "s"}}, "is too small beside the value"),
        ({THICKNESS: {"deviation": "0.1 cm", "source": "s"}}, "must be in the unit of the value"),
        ({"wheel.tyre.thickness": {"low": "1 mm", "high": "2 mm", "source": "s"}}, "wheel.tyre.*is not a known key"),
        ({"fe.friction": {"low": -0.5, "high": 0.6, "source": "s"}}, "fe.friction.*-0.5.*cannot be: .*narrow what is"),
        ({"materials.Ti-6Al-4V.poisson_ratio": {"low": 0.3, "high": 0.6, "source": "s"}}, "poisson_ratio.*cannot be"),
        ({THICKNESS: {"deviation": "0.4 mm", "source": "s"}}, "tire.thickness.*cannot be: .*narrow"),
        ({THICKNESS: {"deviation": "1e308 mm", "source": "s"}}, "is far larger than the value it is about"),
        ({"wheel.grousers.count": {"deviation": 1, "source": "s"}}, "counts something; give low and high as whole"),
        ({"wheel.grousers.count": {"low": 11.5, "high": 12.5, "source": "s"}}, "counts something"),
        ({"wheel.springs[1].direction": {"low": -1, "high": 1, "source": "s"}}, "direction.*cannot be"),
        (
            {f"{THICKNESS} = wheel.springs[0].thickness": {"low": "0.5 mm", "high": "1 mm", "source": "s"}},
            "drawn as one and the study has 0.9235 mm, 0.5903 mm",
        ),
        (
            {
                "max_deflection": "90 mm",
                "wheel.outer_hub.outer_radius": {"low": "30 mm", "high": "60 mm", "source": "s"},
            },
            "outer_radius.*cannot be: .*less than the gap",
        ),
        ({"fe.points": {"low": 10, "high": 30, "source": "s"}}, "fe.points.*changes nothing that the section model"),
        ({"fe.max_deflection": {"low": "30 mm", "high": "50 mm", "source": "s"}}, "max_deflection.*changes nothing"),
        ({"materials.AISI 301.young_modulus": {"low": "180 GPa", "high": "200 GPa", "source": "s"}}, "changes nothing"),
    ],
)
def test_what_does_not_fit_the_study_is_refused_by_its_key(inputs: dict[str, Any], message: str) -> None:
    section = _study(inputs).input_uncertainty
    assert section is not None
    with pytest.raises(StudyError, match=message):
        require_inputs(PATH, TABLE, section)


def _outcome(number: int, study: Study, values: dict[str, Any], factor: float | None) -> Outcome:
    """A curve of 5 N/mm times a factor to 30 mm; none without a factor."""
    run = SweepRun(point=Point(number=number, values=values, study=study), model="section", curves={}, tasks=())
    if factor is None:
        return Outcome(run=run, note="did not converge")
    at = np.array([0.0, 0.010, 0.020, 0.030, 0.060])
    load = factor * 5000.0 * at
    columns = {f"max_{kind}_springs_outer_Pa": 3e6 * load for kind in ("von_mises", "linearised")}
    curve = StiffnessCurve(model="section", orientation_deg=0.0, deflection=at, load=load, columns=columns)
    return Outcome(run=run, by_orientation=(curve,), curve=curve)


def _found(study: Study) -> dict[str, Any]:
    assert study.input_uncertainty is not None
    values = [{THICKNESS: f"{0.9 + 0.01 * i:g} mm", FRICTION: 0.1 * i} for i in range(4)]
    factors = (1.1, 0.9, None, 0.5)
    sampled = [_outcome(i + 1, study, v, f) for i, (v, f) in enumerate(zip(values, factors, strict=True))]
    return found_of(study, study.input_uncertainty, [_outcome(0, study, {}, 1.0), *sampled])


@pytest.mark.parametrize(
    "damage",
    [
        {"samples": []},
        {"inputs": {}},
        {"inputs": {THICKNESS: [1.0]}},
        {"deflection_m": []},
        {"deflection_m": [0.01 * k for k in range(7)][::-1]},
        {"early": -3},
        {"early": "x"},
        {"units": None},
        {"nominal": {"load_N": [1e308] * 7, "stress_Pa": 1.0, "used": 0.5}},
    ],
)
def test_a_record_that_cannot_be_one_is_refused(damage: dict[str, Any]) -> None:
    with pytest.raises((ValueError, TypeError, LookupError)):
        samples_of(_found(_study(max_deflection="60 mm", points=6)) | damage)


def test_a_record_comes_back_as_it_was_found() -> None:
    study = _study(max_deflection="60 mm", points=6)
    samples = samples_of(json.loads(json.dumps(_found(study), allow_nan=False)))
    assert (samples.keys, samples.units) == ((THICKNESS, FRICTION), ("mm", ""))
    assert samples.values[:, 0] == pytest.approx([0.90, 0.91, 0.92, 0.93])
    assert samples.deflection == pytest.approx(0.010 * np.arange(7))
    assert samples.load[0] == pytest.approx(55.0 * np.arange(7))
    assert (samples.failed, samples.early, samples.notes) == (1, 0, {"3": "did not converge"})
    assert samples.nominal_stress == pytest.approx(3e6 * 250.0)
    assert samples.used[:2] == pytest.approx(3e6 * 250.0 / 1100e6)
    assert np.isnan(samples.used[2:]).all()  # one failed, one does not reach 250 N


def test_without_a_curve_of_the_wheel_as_it_is_there_is_no_record() -> None:
    study = _study()
    assert study.input_uncertainty is not None
    with pytest.raises(InputError, match="the study as it is"):
        found_of(study, study.input_uncertainty, [_outcome(0, study, {}, None)])


def test_a_record_is_stale_once_wheel_or_inputs_change_and_not_by_words_or_where_it_is_read() -> None:
    def key(study: Study) -> Any:
        assert study.input_uncertainty is not None
        return record_task(study, study.input_uncertainty).inputs

    wider = TWO | {THICKNESS: TWO[THICKNESS] | {"deviation": "0.04 mm"}}
    reworded = TWO | {THICKNESS: TWO[THICKNESS] | {"source": "another"}}
    assert key(_study()) == key(_study(reworded)) == key(_study(deflections=["10 mm"]))
    assert key(_study()) != key(_study(wider))
    assert key(_study()) != key(_study(samples=41))
    table = TABLE | {"input_uncertainty": RUNS | TWO}
    table["wheel"] = table["wheel"] | {"tire": table["wheel"]["tire"] | {"thickness": "0.93 mm"}}
    assert key(_study()) != key(study_of(PATH, table))


def _read(study: Study, tmp_path: Path) -> Any:
    """Of a study with a solid curve at 0 degrees."""
    folder = tmp_path / "fe_phi000"
    folder.mkdir(exist_ok=True)
    text = "deflection_m,load_N,max_von_mises_springs_outer_Pa,max_linearised_springs_outer_Pa\n"
    rows = "".join(f"{d},{5500.0 * d},{1.65e10 * d},{1.65e10 * d}\n" for d in (0.0, 0.02, 0.05))
    (folder / "curve.csv").write_text(text + rows, encoding="utf-8")
    (folder / "result.json").write_text("{}", encoding="utf-8")
    return INPUT_UNCERTAINTY.read(study, {"fe_phi000": folder})


def test_the_report_says_whether_its_record_is_there_and_of_this_study(tmp_path: Path) -> None:
    study = _study(max_deflection="60 mm", points=6).kept_in(tmp_path / "own.kept")
    assert study.input_uncertainty is not None
    missing = _read(study, tmp_path)
    assert (missing.state, missing.sampled, list(INPUT_UNCERTAINTY.checks(study, missing))) == ("missing", None, [])
    keep(study, RECORD, "make sample", [record_task(study, study.input_uncertainty)], 1.0, _found(study))
    assert _read(study, tmp_path).state == "stale"  # of fewer samples than the study states
    found = _found(study)
    keep(
        study,
        RECORD,
        "make sample",
        [record_task(study, study.input_uncertainty)],
        1.0,
        found
        | {
            "samples": [found["samples"][k % len(found["samples"])] for k in range(40)],
            "inputs": {key: [values[k % len(values)] for k in range(40)] for key, values in found["inputs"].items()},
        },
    )
    current = _read(study, tmp_path)
    assert current.state == "current"
    assert current.sampled.outputs[1].nominal == pytest.approx(110.0)
    assert current.sampled.stress_factor == pytest.approx(1.0)
    assert set(INPUT_UNCERTAINTY.figures(study, current)) == {"input_band", "input_ranks"}
    (curve,) = INPUT_UNCERTAINTY.curves(study, current)
    assert {"load_p5_N", "load_p50_N", "load_p95_N"} == set(curve.columns)
    other = _study(max_deflection="60 mm", points=6, seed=9).kept_in(tmp_path / "own.kept")
    stale = _read(other, tmp_path)
    assert (stale.state, stale.sampled, list(INPUT_UNCERTAINTY.curves(other, stale))) == ("stale", None, [])
