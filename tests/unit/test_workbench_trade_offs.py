"""Trade-offs: what a table tells of a wheel, which rows are alike, and an optimiser that must find known answers."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from contracts.errors import StudyError
from contracts.hub_travel import Way
from workbench.commands.optimise import _sentences
from workbench.commands.optimise_search import Optimised, search_and_confirm
from workbench.commands.point_batches import PointBatches
from workbench.questions.model_curves import mean_curve
from workbench.questions.optimise.judging import Assessed, Limit, assess, best, corrected, front, limits_of, nearest
from workbench.questions.optimise.words import told_limits, told_point, told_verdict
from workbench.questions.sweep.graph import SweepRun, sweep_graph
from workbench.questions.sweep.likeness import alike, unlike
from workbench.questions.sweep.results import Outcome, measured, pivots_up_to
from workbench.questions.sweep.wheel_facts import WheelFacts, wheel_facts
from workbench.study.optimise import OptimiseSection
from workbench.study.reading import read_study, read_study_table, study_of
from workbench.study.rewrite import written_point
from workbench.study.sweep import SweepSection, SweptModel, Value
from workbench.study.sweep_points import Point, study_point

LEAVES = Path(__file__).parents[2] / "studies" / "leaf_optimise.toml"
STUDY = read_study(LEAVES)
FACTS = wheel_facts(STUDY)
SWEEP = SweepSection.model_validate({"strip_thickness": ["0.5 mm"], "loads": ["150 N"]})


def _line(stiffness: float, orientation: float, stress: float = 2e6, end: float = 300.0) -> StiffnessCurve:
    """A straight line in steps of 5 N up to an end, with a stress in proportion to the load."""
    load = np.arange(0.0, end + 1.0, 5.0)
    columns = {"max_linearised_leaves_Pa": stress * load, "max_von_mises_leaves_Pa": 2.0 * stress * load}
    return StiffnessCurve(
        model="section",
        orientation_deg=orientation,
        deflection=load / stiffness,
        load=load,
        columns=columns,
        partial=end < 300.0,
    )


def _outcome(curves: Sequence[StiffnessCurve], number: int = 1, model: SweptModel = "section", **more: Any) -> Outcome:
    point = Point(number=number, values=more.get("values", {}), study=more.get("study", STUDY))
    run = SweepRun(point=point, model=model, curves={}, tasks=())
    curve = curves[0] if len(curves) == 1 else mean_curve(list(curves))
    return Outcome(run=run, by_orientation=tuple(curves), curve=curve, wheel=more.get("wheel", FACTS))


def test_a_table_tells_mass_stiffness_strength_and_room() -> None:
    """8 and 12 N/mm: 18.75 and 12.5 mm at 150 N; mean load 10 N/mm. 880 MPa yield, stress 2 and 3 MPa a newton."""
    found = measured(_outcome([_line(8e3, 0.0), _line(12e3, 15.0, 3e6)]), SWEEP, 0.005)
    rim = math.pi * (142.5**2 - 141.7**2) * 100.0 * 1e-9 * 4430.0
    hub = math.pi * (40.0**2 - 38.0**2) * 100.0 * 1e-9 * 4430.0
    assert found["mass_kg"] == pytest.approx(found["mass_off_hub_kg"] + hub)  # type: ignore[operator]
    assert rim < found["mass_off_hub_kg"] < 3.0 * rim  # type: ignore[operator]
    assert found["stiffness_at_150N_N_per_m"] == pytest.approx(10e3)
    assert found["lowest_stiffness_at_150N_N_per_m"] == pytest.approx(8e3)
    assert found["highest_stiffness_at_150N_N_per_m"] == pytest.approx(12e3)
    assert found["utilisation_at_150N"] == pytest.approx(450.0 / 880.0)
    assert found["weakest_at_150N_deg"] == 15.0
    assert found["gap_at_150N_m"] == pytest.approx(0.1417 - 0.040 - 0.150 / 8.0)


def test_rows_of_other_meshes_models_and_stresses_are_not_alike() -> None:
    coarse = STUDY.model_copy(update={"mesh": STUDY.mesh.model_copy(update={"element_size": 0.02})})
    bare = _line(8e3, 0.0)
    peak = StiffnessCurve(
        model="section",
        orientation_deg=0.0,
        deflection=bare.deflection,
        load=bare.load,
        columns={"max_von_mises_leaves_Pa": bare.load},
    )
    rows = [_outcome([bare]), _outcome([bare], 2, study=coarse), _outcome([peak], 3), _outcome([bare], 4)]
    assert alike(rows) == [1, 2, 3, 1]
    told = unlike(rows)
    assert "mesh.element_size (10 mm; 20 mm)" in told
    assert "leaves linearised; leaves von Mises" in told
    assert unlike([rows[0], rows[3]]) == ""  # negative control
    wide = STUDY.model_copy(update={"mesh": STUDY.mesh.model_copy(update={"axial_size": 0.05})})
    assert alike([_outcome([bare]), _outcome([bare], 2, study=wide)]) == [1, 1]  # no width in a section
    assert alike([_outcome([bare]), _outcome([bare], 2, "fe"), Outcome(run=rows[0].run)]) == [1, 2, None]


def test_what_resists_a_turn_is_a_moment() -> None:
    sweep = SWEEP.model_copy(update={"travels": tuple(Way)})
    names = [name for name in measured(_outcome([_line(8e3, 0.0)]), sweep, 0.005) if name.split("_stiff")[0] in Way]
    assert {name.split("_stiff")[0]: name.partition("150N_")[2] for name in names} == {
        **dict.fromkeys(("fore_aft", "lateral", "radial"), "N_per_m"),
        **dict.fromkeys(("turning", "leaning", "wind_up"), "N_m_per_rad"),
    }


def test_a_sweep_that_moves_the_hub_has_its_tasks() -> None:
    """Only models with a hub to move, each way at each orientation; without the key nothing is added."""
    point = study_point(LEAVES, {k: v for k, v in read_study_table(LEAVES).items() if k != "optimise"}, 1, {})
    bare, moved = (sweep_graph([point], ("section", "fe"), (w, 150.0)) for w in ((), (Way.LATERAL, Way.FORE_AFT)))
    assert {name: bare.keys[name] for name in bare.keys} == {name: moved.keys[name] for name in bare.keys}
    (_, run) = moved.runs
    assert {way: len(tasks) for way, tasks in run.travels.items()} == {Way.LATERAL: 3, Way.FORE_AFT: 3}
    assert not moved.runs[0].travels


class _ClosedForm(PointBatches):
    """Wheels of two springs in series, k_i = b_i t_i^3, mass t_1 + t_2 (or one spring): what the models would find.

    The solid model is ``softer`` times as stiff.
    """

    softer: float = 1.0
    b: tuple[float, ...] = (8e12,)

    def run(
        self,
        values: Sequence[Mapping[str, Value]],
        sweep: SweepSection,
        first: int,
        models: Sequence[SweptModel] = (),
        *,
        shown: bool = False,
    ) -> list[Outcome]:
        found = []
        for number, chosen in enumerate(values, start=first):
            t = [float(str(v).split()[0]) * 1e-3 for k, v in chosen.items() if k.startswith("wheel")] or [1.6e-3] * len(
                self.b
            )
            k = 1.0 / sum(1.0 / (b * one**3) for b, one in zip(self.b, t, strict=False))
            for model in models or ("section",):
                line = _line(k * (self.softer if model == "fe" else 1.0), 0.0)
                facts = WheelFacts(masses={"tire": 1e3 * sum(t)}, room=0.1, strengths={"leaves": 880e6})
                found.append(_outcome([line], number, model, values=chosen, wheel=facts))
        self.computed = len(found)
        return found


def _found(
    b: tuple[float, ...], band: Mapping[str, str], *, softer: float = 1.0, seed: int = 1, **more: Any
) -> tuple[Optimised, OptimiseSection]:
    keys = ("wheel.tire.thickness", "wheel.springs[0].thickness")[: len(b)]
    variables = {key: {"low": "0.4 mm", "high": "2 mm"} for key in keys}
    table = {"variables": variables, "load": "150 N", "stiffness": band, "samples": 60, "seed": seed} | more
    section = OptimiseSection.model_validate(table)
    batches = _ClosedForm(path=LEAVES, base={}, study=STUDY, section="optimise")
    batches.b, batches.softer = b, softer
    return search_and_confirm(batches, section), section


def _thickness(found: Optimised) -> list[float]:
    """Of the answer [mm]."""
    assert found.answer is not None
    values = found.answer.outcome.run.point.values.values()
    return [float(str(value).split()[0]) for value in values]


def test_one_thickness_is_the_root_of_the_bands_lower_end() -> None:
    """Mass goes with t, stiffness with t^3: the lightest wheel has b t^3 = 8 N/mm, t = 1 mm."""
    found, _ = _found((8e12,), {"low": "8 N/mm", "high": "9 N/mm"})
    assert _thickness(found) == [pytest.approx(1.0, rel=1e-3)]
    assert found.answer is not None
    assert found.answer.numbers["stiffness_at_150N_N_per_m"] >= 8e3  # type: ignore[operator]
    assert len(found.confirmed) == 1
    most, _ = _found((8e12,), {"low": "8 N/mm", "high": "9 N/mm"}, objective={"most": "mass_kg"})
    assert _thickness(most) == [pytest.approx((9.0 / 8.0) ** (1.0 / 3.0), rel=1e-3)]


def test_two_springs_in_series_share_as_the_multiplier_says() -> None:
    """least t1 + t2 at 1/k1 + 1/k2 = 1/k: b1 t1^4 = b2 t2^4."""
    b1, b2, k = 64e12, 16e12, 8e3
    found, _ = _found((b1, b2), {"low": "8 N/mm"}, samples=120)
    ratio = (b1 / b2) ** 0.25
    t1 = (k * (1.0 / b1 + 1.0 / (b2 * ratio**3))) ** (1.0 / 3.0) * 1e3
    assert sum(_thickness(found)) == pytest.approx(t1 * (1.0 + ratio), rel=2e-3)
    assert _thickness(found)[1] / _thickness(found)[0] == pytest.approx(ratio, rel=0.1)


def test_the_same_seed_goes_the_same_way_and_another_comes_to_the_same_wheel() -> None:
    one, again, other = (_found((8e12,), {"low": "8 N/mm"}, seed=seed)[0] for seed in (1, 1, 2))
    asked = [[dict(o.run.point.values) for o, _ in found.searched] for found in (one, again, other)]
    assert asked[0] == asked[1] != asked[2]
    assert _thickness(other) == [pytest.approx(_thickness(one)[0], rel=2e-3)]


def test_limits_are_corrected_by_what_the_solid_model_finds(capsys: pytest.CaptureFixture[str]) -> None:
    """A solid model 10 % softer: the first wheel breaks the limit, the next has 0.9 b t^3 = 8 N/mm."""
    found, section = _found((8e12,), {"low": "8 N/mm", "high": "9 N/mm"}, softer=0.9)
    assert [one.solid.feasible for one in found.confirmed] == [False, True]
    assert _thickness(found) == [pytest.approx((1.0 / 0.9) ** (1.0 / 3.0), rel=2e-3)]
    assert told_limits(found.limits[1]).startswith("stiffness at 150 N 8.889 to 10 N/mm")
    assert "the solid model breaks a limit" in capsys.readouterr().out
    kept, _ = _found((8e12,), {"low": "8 N/mm", "high": "9 N/mm"}, softer=0.9, rounds=0)
    assert kept.answer is None  # negative control: without a second round nothing holds
    assert len(front(found.assessed(section), section)) >= 1


def test_a_band_that_no_wheel_has_is_told_with_the_nearest(capsys: pytest.CaptureFixture[str]) -> None:
    """At most b (2 mm)^3 = 64 N/mm."""
    found, section = _found((8e12,), {"low": "80 N/mm"})
    assert found.answer is None
    assert not found.confirmed
    close = nearest(found.assessed(section))
    assert close.misses["stiffness"] == pytest.approx(0.2, abs=0.01)
    assert f"no point is within the limits; nearest: {told_point(close, section)}" in " ".join(
        capsys.readouterr().out.split()
    )


def test_the_nearest_is_a_wheel_of_which_something_is_known() -> None:
    """One far off before one without a curve, which misses each limit by less here; alone it is the nearest."""
    far, section = _judged([_line(8e5, 0.0)])
    nothing = Outcome(run=far.outcome.run, note="could not be meshed")
    blind = replace(far, outcome=nothing, objective=None, misses={"stiffness": 10.0, "stability": 0.0})
    assert far.missed > blind.missed
    assert nearest([blind, far]) is far
    assert nearest([blind]) is blind
    assert "could not be meshed" in told_point(blind, section)
    assert told_verdict(replace(far, objective=None, misses={"stability": 0.0})) == "has no objective"


def test_an_objective_without_a_value_ends_the_search_with_a_message() -> None:
    with pytest.raises(
        StudyError, match=r"optimise.objective: relative_l2 has no value at any of the first \d+ wheels"
    ):
        _found((8e12,), {"low": "8 N/mm", "high": "9 N/mm"}, objective={"least": "relative_l2"})


def test_a_gain_is_that_of_one_model() -> None:
    """Solid 10 % softer: the deflection at 150 N of the searched wheel against that of the study, not of the solid."""
    wish = {"most": "deflection_at_150N_m"}
    found, section = _found((8e12,), {"low": "8 N/mm", "high": "9 N/mm"}, softer=0.9, objective=wish)
    points = found.assessed(section)
    assert found.answer is not None
    (told,) = [one for one in _sentences(section, found, points) if one.startswith("best")]
    searched = next(p for p in points if p.number == found.confirmed[-1].found)
    change = 100.0 * (searched.objective / points[0].objective - 1.0)  # type: ignore[operator]
    assert f"; {change:+.3g} % against the study as it is (not within the limits), both by the section model" in told
    assert found.answer.objective == pytest.approx(searched.objective / 0.9)  # type: ignore[operator]


def test_ends_of_ranges_that_make_no_wheel_are_told_beforehand() -> None:
    table = read_study_table(LEAVES)
    base = {key: value for key, value in table.items() if key != "optimise"}
    batches = PointBatches(path=LEAVES, base=base, study=STUDY, section="optimise")
    section = STUDY.optimise
    assert section is not None
    assert batches.unusable_ends(section.as_sweep) == []
    wide = {"wheel.springs[0].points[0][1]": {"low": "12 deg", "high": "170 deg"}}
    changed = study_of(LEAVES, table | {"optimise": table["optimise"] | {"variables": wide}}).optimise
    assert changed is not None
    (told,) = batches.unusable_ends(changed.as_sweep)
    assert told.startswith("optimise: wheel.springs[0].points[0][1] = 170 deg makes no wheel: wheel.springs[0].points")
    assert "crosses the hub or the rim" in told


def _judged(curves: Sequence[StiffnessCurve], **more: Any) -> tuple[Assessed, OptimiseSection]:
    """A band of 8 to 9 N/mm at 150 N."""
    variables = {"wheel.tire.thickness": {"low": "0.4 mm", "high": "2 mm"}}
    band = {"low": "8 N/mm", "high": "9 N/mm"}
    section = OptimiseSection.model_validate({"variables": variables, "load": "150 N", "stiffness": band} | more)
    outcome = _outcome(curves)
    return assess(outcome, measured(outcome, section.as_sweep, 0.005), section, limits_of(section)), section


@pytest.mark.parametrize("end", [0.0, 130.0])
def test_an_orientation_that_never_bears_the_load_misses_by_what_lacks(end: float) -> None:
    """The mean of the others, or of both up to 130 N of the softer, 185 of the stiffer, lies within the band."""
    curves = [_line(10e3, 0.0), _line(7e3, 15.0)] if end else [_line(8.5e3, 0.0), _line(8.5e3, 15.0)]
    whole, section = _judged(curves)
    assert whole.feasible  # negative control
    cut, _ = _judged([curves[0], _line(7e3, 15.0, end=end)])
    mean = measured(cut.outcome, section.as_sweep, 0.005)["stiffness_at_150N_N_per_m"]
    assert mean == pytest.approx(8.5e3)
    assert not cut.feasible
    assert cut.misses == {"stiffness": pytest.approx(2.0 - end / 150.0), "stability": 0.0}
    assert "stiffness at 150 N unknown; misses stiffness by" in told_point(cut, section)


def test_a_wheel_that_buckles_below_the_load_is_not_feasible() -> None:
    """A negative pivot from 100 N on: 95 N are borne stably. Past the load, or with friction, none counts."""
    found = {}
    for begins in (0.0, 100.0, 155.0, math.inf):
        line = _line(8.5e3, 15.0)
        pivots = np.where(line.load >= begins, 2.0, 0.0)
        curve = replace(line, columns={**line.columns, "negative_pivots": pivots})
        found[begins], section = _judged([_line(8.5e3, 0.0), curve], utilisation=1.0, gap="50 mm")
    assert [found[begins].feasible for begins in found] == [False, False, True, True]
    assert found[100.0].misses["stability"] == pytest.approx(55.0 / 150.0)
    assert found[0.0].misses["stability"] == 1.0
    assert told_point(found[100.0], section).endswith("; buckles past 95 N")
    assert told_verdict(found[100.0]) == "buckles"
    assert best(list(found.values()), section.objective) in (found[155.0], found[math.inf])


def test_pivots_count_up_to_where_a_load_is_first_borne() -> None:
    """A curve that snaps through: 160 N at the second point, 50 N at the third."""
    load = np.array([0.0, 160.0, 50.0, 300.0])
    columns = {"negative_pivots": np.array([0.0, 0.0, 1.0, 0.0])}
    curve = StiffnessCurve(
        model="section", orientation_deg=0.0, deflection=1e-3 * np.arange(4.0), load=load, columns=columns
    )
    counts = [pivots_up_to(curve, wanted) for wanted in (150.0, 200.0, 400.0)]
    assert [None if count is None else count.tolist() for count in counts] == [[0, 0], [0, 0, 1, 0], [0, 0, 1, 0]]


def test_limits_are_relative_and_corrected_by_what_both_models_make_of_a_point() -> None:
    limit = Limit(name="gap", column="gap_at_150N_m", low=0.08)
    assert limit.miss(0.06) == pytest.approx(0.25)
    assert limit.miss(0.09) == 0.0
    ends = (Limit(name="stiffness", column="s", low=8.0, high=9.0),)
    assert corrected(ends, {"s": 10.0}, {"s": 8.0}) == (Limit(name="stiffness", column="s", low=10.0, high=11.25),)
    assert corrected(ends, {"s": None}, {"s": 8.0}) == ends


def test_the_best_point_is_written_as_a_study_of_its_own() -> None:
    """Comments and order stay, [optimise] goes; read again it is the point's study."""
    values: dict[str, Value] = {
        "wheel.tire.thickness": "0.7123 mm",
        "wheel.springs[0].thickness = wheel.springs[0].thickness_middle": "0.41 mm",
        "wheel.springs[0].points[0][1]": "21.5 deg",
        "orientation_step": "15 deg",
    }
    base = {k: v for k, v in read_study_table(LEAVES).items() if k != "optimise"}
    text = written_point(LEAVES.read_text(encoding="utf-8"), values, "the note", LEAVES)
    assert text.startswith("# the note\n")
    assert "[optimise" not in text
    assert "# half way," in text
    import tomllib

    written = study_of(LEAVES, tomllib.loads(text))
    wanted = study_point(LEAVES, base, 1, values).study
    same = {"wheel", "materials", "mesh", "full"}
    assert written.model_dump(include=same) == wanted.model_dump(include=same)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"variables": {}}, "variables"),
        ({"variables": {"mesh.element_size": ["8 mm", "9 mm"]}}, "neither dimension nor material"),
        ({"variables": {"samples": [1, 2]}}, "variables.samples.*is no key of the study"),
        ({"variables": {"wheel.tire.thickness": {"low": "2 mm", "high": "1 mm"}}}, "low less than high"),
        ({"stiffness": None, "utilisation": None, "gap": None}, "has no limit"),
        ({"stiffness": {"low": "9 N/mm", "high": "8 N/mm"}}, "must exceed low"),
        ({"stiffness": {}}, "or high must be given"),
        ({"objective": {"least": "mass_kg", "most": "mass_kg"}}, "or most must be given, and not both"),
        ({"load": "250 N"}, "lies beyond fe.max_load, 200 N"),
        ({"samples": 6}, "less than one batch"),
        ({"model": "fe"}, "model"),
        ({"seed": -1}, "seed"),
    ],
)
def test_a_bad_optimisation_is_one_message(change: dict[str, Any], message: str) -> None:
    table = read_study_table(LEAVES)
    given = {key: value for key, value in (table["optimise"] | change).items() if value is not None}
    with pytest.raises(StudyError, match=message):
        study_of(LEAVES, table | {"optimise": given})
