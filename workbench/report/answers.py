"""The report's three answers: is the computation sound, does the wheel do its job, which model may stand in for it.

A check that is undecided or was not evaluated never counts as passed. Verified by tests/unit/test_workbench_answers.py.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from contracts.curves import StiffnessCurve
from contracts.records import Check
from workbench.questions.comparison import Comparison
from workbench.questions.models.question import MODELS
from workbench.report.stand_ins import StandIn, stand_ins
from workbench.study.model import Study
from workbench.study.reference import (
    INITIAL,
    NO_EVIDENCE,
    NO_REFERENCE,
    THESIS_KIND,
    THESIS_WORDS,
    ReferenceSection,
    kind_of,
)
from workbench.verdict.decision import Decision, decided, together
from workbench.verdict.number_format import displayed, displayed_reference

__all__ = ["Answer", "Answers", "Part", "answers", "computation", "wheel"]

_SHOWN = 3
"""Parts of an answer on the first page where there are many."""
_SUFFIX = re.compile(r"(\d)(mm|C)\b")
_JOB = {
    "stiffness": ("fe.initial_tangent", "fe.deflection_at_", "fe.band", "user_", "words.band"),
    "reach": ("fe.reach",),
    "evenness": ("fe.spread_",),
    "strength": ("fe.first_yield_load", "fe.yield"),
    "heat and cold": ("environment.first_yield_",),
    "mission": ("rover_mission.fe", "rover_mission.ancf_wheel"),
}
"""Part of the wheel's job -> how the identifiers of its checks begin; those a study does not ask for are not there."""
_SHORT = {
    "fe.initial_tangent": "slope",
    "fe.spread_": "largest spread around the wheel, at {},",
    "fe.reach": "share of the way that the shortest curve comes",
    "fe.first_yield_load": "no part yields below",
    "fe.yield": "stress over yield strength",
    "environment.first_yield_": "no part yields, at {}, below",
    "rover_mission.fe": "requirements that the rover meets on it",
    "rover_mission.ancf_wheel": "requirements that the rover meets on its ANCF model",
    "words.band": "distance from the band of the plausible set",
}
"""How an identifier begins -> what its number is called on the first page, with the rest of it; else the check's title.
A load at first yield is one below which nothing yields even where the curve ends before.
"""
_NO_YIELD = "the alloy's strength is inferred, and the wheel chosen not to pass it"


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """One thing asked: what it is called, the answer, the check that decides it in words, the section with more, and
    the check's identifier."""

    name: str
    decision: Decision
    text: str
    section: str
    check: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """An answer in one sentence, and what it is made of."""

    question: str
    decision: Decision
    sentence: str
    parts: Sequence[Part] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Answers:
    """All three; ``models`` in the order in which the report shows them."""

    computation: Answer
    wheel: Answer
    models: Sequence[StandIn]

    @property
    def stand_in(self) -> Answer:
        """The third in one sentence."""
        may, open_ = ([m for m in self.models if m.decision == d] for d in ("yes", "undecided"))
        average = [m for m in self.models if m.decision == "no" and m.on_average == "yes"]
        told = [f"{m.name}, {m.range}" for m in may]
        told += [
            f"{words}: {_listed(found)}"
            for words, found in (("not decided", open_), ("on average alone", average))
            if found
        ]
        sentence = "; ".join(told) or "none of those compared"
        decision: Decision = "yes" if may else "undecided" if open_ else "no"
        question = "May a reduced model stand in for it?"
        return Answer(question=question, decision=decision, sentence=f"{sentence[0].upper()}{sentence[1:]}.")

    @property
    def summary(self) -> dict[str, Any]:
        """``verdict`` of ``summary.json``, schema 2."""
        return {
            "computation": self.computation.decision,
            "wheel": self.wheel.decision,
            "models": {model.key: model.decision for model in self.models},
        }


def answers(study: Study, found: Comparison) -> Answers:
    """Of a comparison."""
    return Answers(
        computation=computation(found.checks, found.question_of),
        wheel=wheel(study, found.checks, found.question_of, found.answers[MODELS.name].continuum.fe.average),
        models=stand_ins(found),
    )


def computation(checks: Sequence[Check], question_of: Mapping[str, str]) -> Answer:
    """Whether every gate holds."""
    gates = [check for check in checks if check.role == "gate"]
    bad = [check for check in gates if check.status != "pass"]
    sentence = f"All {len(gates)} gates hold{_by_three_meshes(checks)}."
    if bad:
        sentence = f"{len(bad)} of {len(gates)} gates {'does' if len(bad) == 1 else 'do'} not hold."
    return Answer(
        question="Is the computation sound?",
        decision=together(decided(check) for check in gates) if gates else "undecided",
        sentence=sentence if gates else "The study asks for no gate.",
        parts=[_part(_title(c), [c], question_of, None) for c in bad[:_SHOWN]],
    )


def _by_three_meshes(checks: Sequence[Check]) -> str:
    """Numerical uncertainty of load and stress in words, as far as it is known."""
    named = {"fe.mesh_uncertainty": "load", "fe.stress_uncertainty": "stress"}
    known = [f"the {named[c.id]} by {100.0 * c.value:.2g} %" for c in checks if c.id in named and c.value is not None]
    return f"; the mesh may move {' and '.join(known)}" if known else ""


def wheel(
    study: Study,
    checks: Sequence[Check],
    question_of: Mapping[str, str],
    average: StiffnessCurve | None = None,
) -> Answer:
    """Whether the wheel does what the study asks of it: each part of its job that has checks.

    ``average``: of the finite elements; its slope and its deflection at the judged load lead the line on stiffness.
    """
    asked = {name: found for name, begins in _JOB.items() if (found := [c for c in checks if c.id.startswith(begins)])}
    if "orientation_spread" not in study.tolerances.model_fields_set:
        asked.pop("evenness", None)
    parts = [_part(name, found, question_of, study.reference) for name, found in asked.items()]
    if average is not None and not average.unloaded:
        numbers = _stiffness(average, study.judged_load)
        parts = [replace(p, text=f"{numbers}{p.text}") if p.name == "stiffness" else p for p in parts]
    decision = together(part.decision for part in parts)
    named = {d: [part.name for part in parts if part.decision == d] for d in ("yes", "no", "undecided")}
    words = {"yes": "meets", "no": "fails", "undecided": "not decided"}
    told = [f"{words[d]}: {', '.join(names)}" for d, names in named.items() if names]
    sentence = f"{'; '.join(told)}." if told else "The study asks nothing of it."
    sentence += "" if study.reference is not None else f" {NO_REFERENCE}."
    return Answer(
        question="Does the wheel do its job?",
        decision=decision,
        sentence=sentence[0].upper() + sentence[1:],
        parts=parts,
    )


def _stiffness(average: StiffnessCurve, load: float) -> str:
    """``"8.17 N/mm over the first 5 mm, 34.4 mm at 250 N; "``: as far as the average goes."""
    told = []
    if average.deflection[0] <= 0.0 and average.deflection[-1] >= INITIAL:
        slope = float(average.load_at(INITIAL)) / INITIAL / 1e3
        told.append(f"{slope:.3g} N/mm over the first {1e3 * INITIAL:g} mm")
    if average.load[0] < load <= average.load[-1]:
        told.append(f"{1e3 * float(average.deflection_at(load)):.3g} mm at {load:g} N")
    return f"{', '.join(told)}; " if told else ""


def _part(
    name: str, checks: Sequence[Check], question_of: Mapping[str, str], reference: ReferenceSection | None
) -> Part:
    """Told by its first check that is not passed, or by its first, and by the kind of its reference."""
    order = {"no": 0, "undecided": 1, "yes": 2}
    worst = min(checks, key=lambda check: (order[decided(check)], -_used(check)))
    return Part(
        name=name,
        decision=together(decided(check) for check in checks),
        text=_told(worst).removeprefix(f"{name} ").removeprefix(f"{name}: ") + _of_what_kind(worst, reference),
        section=question_of[worst.id],
        check=worst.id,
    )


def _of_what_kind(check: Check, reference: ReferenceSection | None) -> str:
    """Kind of the reference in words, for what is held against ``[reference]`` or was chosen by it."""
    if check.id == "words.band":
        return f"; the reference is {THESIS_KIND}, {THESIS_WORDS}, and {NO_EVIDENCE}"
    if reference is not None and reference.thesis_words and check.id in ("fe.first_yield_load", "fe.yield"):
        return f"; {_NO_YIELD}"
    kind = kind_of(reference, check.id)
    return "" if kind is None else f"; the reference is {kind}"


def _listed(models: Sequence[StandIn]) -> str:
    names = [model.name for model in models]
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _used(check: Check) -> float:
    """How much of its limit a number takes [-]; 0 where it is held against no limit of one side."""
    if check.value is None or not isinstance(check.reference, float | int) or not check.reference:
        return 0.0
    share = check.value / check.reference
    return share if check.tolerance.startswith("at most") else 1.0 / share if check.value else 0.0


def _title(check: Check) -> str:
    return check.title.removeprefix("FE: ")


def _told(check: Check) -> str:
    """Its number and limit."""
    title = _title(check)
    if check.id == "fe.reach" and check.status == "pass":
        return title
    if check.value is None:
        return title if check.status == "undecided" else f"{title}: not evaluated"
    limit = check.tolerance.partition(";")[0]
    if limit == "none" or (check.unit == "-" and limit == "at most 0"):
        limit = "none allowed"
    elif not limit.startswith("at "):
        limit = f"{displayed_reference(check)}{'' if isinstance(check.reference, tuple) else ' ± ' + limit}"
    begins = next((begins for begins in _SHORT if check.id.startswith(begins)), None)
    name = title if begins is None else _SHORT[begins].format(_SUFFIX.sub(r"\1 \2", check.id.removeprefix(begins)))
    return f"{name} {displayed(check.value, check.unit, check.quantity)} ({limit})"
