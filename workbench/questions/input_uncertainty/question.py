"""Question: how far the curves vary with what is not exactly known of the wheel, by the samples that are kept.

Nothing is sampled here: `workbench sample` does that, and keeps its record beside the study.
Verified by tests/unit/test_workbench_input_uncertainty.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.questions.input_uncertainty.figures import in_words, inputs_figures
from workbench.questions.input_uncertainty.results import Output, Sampled
from workbench.questions.input_uncertainty.samples import RECORD, drawn_of, record_task, samples_of
from workbench.questions.kept import Kept, State, kept
from workbench.questions.model_curves import ModelCurves, model_curves
from workbench.questions.question import Question
from workbench.questions.section.graph import without_planar_model
from workbench.questions.strength.yielding import largest_utilisation, peak_stresses
from workbench.study.full import around
from workbench.study.input_uncertainty import UncertainInput
from workbench.study.model import Study, stated
from workbench.study.strengths import yield_strengths
from workbench.verdict.rules import Claim, at_most

__all__ = ["INPUT_UNCERTAINTY", "InputUncertainty", "inputs_checks"]

_STRONGEST = 3


@dataclass(frozen=True, slots=True, kw_only=True)
class InputUncertainty:
    """The record and what is made of it.

    Attributes
    ----------
    kept : None where there is no record
    state : of the record; "missing" without one
    sampled : None without a record, and where it is stale
    names : of the inputs, in words, by key
    inputs : what is drawn of them, by key
    """

    kept: Kept | None
    state: State | str
    sampled: Sampled | None
    names: Mapping[str, str]
    inputs: Mapping[str, UncertainInput]

    def strongest(self, output: Output) -> list[tuple[str, float]]:
        """Names and rank correlations of the inputs that move a number most, as far as they are told from none."""
        pairs = [(name, float(r)) for name, r in zip(self.names.values(), output.rank, strict=True)]
        told = [pair for pair in pairs if abs(pair[1]) >= output.limit]
        return sorted(told, key=lambda pair: -abs(pair[1]))[:_STRONGEST]


def _read(study: Study, folders: Mapping[str, Path]) -> InputUncertainty:
    section = stated(study.input_uncertainty, "input_uncertainty")
    record = kept(study, RECORD, samples_of)
    state = "missing" if record is None else record.state([record_task(study, section)])
    if record is not None and not drawn_of(samples_of(record.found), section):
        state = "stale"
    sampled = None
    if record is not None and state != "stale":
        fe = model_curves("fe", folders, around(study))
        stress, used = _solid_stress(study, fe)
        sampled = Sampled(
            samples=samples_of(record.found),
            solid=fe.average,
            solid_stress=stress,
            solid_used=used,
            up_to=study.tangent_up_to,
            deflections=section.deflections,
            loads=section.loads,
            judged_load=study.judged_load,
        )
    return InputUncertainty(
        kept=record,
        state=state,
        sampled=sampled,
        names={key: in_words(study, key) for key in section.inputs},
        inputs=section.inputs,
    )


def _solid_stress(study: Study, fe: ModelCurves) -> tuple[float | None, float | None]:
    """Largest judged stress [Pa] and stress over yield strength [-] of any orientation at the judged load."""
    strengths, load = yield_strengths(study), study.judged_load
    with suppress(InputError, ValueError):  # a curve ends below the load, or there is none
        stress = max(max(p.stress for p in peak_stresses(c, strengths, load)) for c in fe.loaded.values())
        return stress, max(largest_utilisation(c, strengths, load) for c in fe.loaded.values())
    return None, None


def inputs_checks(found: Sampled, limit: float) -> list[Check]:
    """Half width of the band of 90 % at the first deflection, against what models may differ by."""
    d = found.deflections[0]
    claim = Claim(
        id=f"inputs.half_width_{1e3 * d:g}mm",
        title=f"Input uncertainty: half width of the band of 90 % of the samples at {1e3 * d:g} mm, over their mean",
        quantity="spread",
        unit="-",
        role="finding",
        source="our own samples of what [input_uncertainty] states; the limit is that of models against each other",
    )
    return [at_most(claim, lambda: found.half_width(d), limit)]


def _asked(study: Study) -> bool:
    """A record that cannot be read is told here, before anything is computed."""
    if study.input_uncertainty is None or without_planar_model(study) is not None:
        return False
    kept(study, RECORD, samples_of)
    return True


def _checks(study: Study, results: InputUncertainty) -> Sequence[Check]:
    return [] if results.sampled is None else inputs_checks(results.sampled, study.tolerances.model_agreement)


def _figures(study: Study, results: InputUncertainty) -> dict[str, str]:
    return {} if results.sampled is None else inputs_figures(study, results.sampled)


def _curves(study: Study, results: InputUncertainty) -> Sequence[StiffnessCurve]:
    with suppress(InputError):
        return [] if results.sampled is None else [results.sampled.band]
    return []


INPUT_UNCERTAINTY: Question = Question(
    name="input_uncertainty",
    title="Input uncertainty",
    group="Wheel",
    read=_read,
    checks=_checks,
    figures=_figures,
    curves=_curves,
    budget=1000,
    applies=_asked,
)
