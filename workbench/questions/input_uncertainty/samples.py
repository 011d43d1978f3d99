"""What `workbench sample` found: inputs, average curve and stress of every sample; kept as JSON beside the study.

Verified by tests/unit/test_workbench_input_uncertainty.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.errors import StudyError
from workbench.execution.task import Task
from workbench.questions.section.graph import section_tasks
from workbench.study.input_points import as_sampled, input_ends
from workbench.study.input_uncertainty import InputUncertaintySection
from workbench.study.model import Study
from workbench.study.strengths import yield_strengths

__all__ = ["RECORD", "Samples", "drawn_of", "record_task", "require_inputs", "samples_of"]

RECORD = "input_uncertainty"
"""Name of the record, see `workbench.questions.kept`."""

Array = NDArray[np.float64]
_LARGEST, _LONGEST = 1e15, 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Samples:
    """Everything that was drawn, and what became of it; not a number where there is none.

    Attributes
    ----------
    keys : of the inputs, as the study has them
    units : of ``values``, as the study writes them; empty for plain numbers
    values : (n, inputs) float
    deflection : (m,) float [m], from 0
    nominal_load, load : (m,), (n, m) float [N], average curve of the section model
    nominal_stress, stress : float, (n,) float [Pa], largest judged stress of all parts and orientations at the load
        up to which strength is judged
    nominal_used, used : float, (n,) float [-], largest stress over yield strength up to that load
    early : samples whose curve ends before its target at some orientation
    notes : number of a sample -> why it has no curve or an early end; the first few
    """

    keys: tuple[str, ...]
    units: tuple[str, ...]
    values: Array
    deflection: Array
    nominal_load: Array
    load: Array
    nominal_stress: float
    stress: Array
    nominal_used: float
    used: Array
    early: int
    notes: Mapping[str, str]

    @property
    def failed(self) -> int:
        """Samples without a curve."""
        return int(np.isnan(self.load).all(axis=1).sum())


def record_task(study: Study, section: InputUncertaintySection) -> Task:
    """What a record is about: the runs of the wheel as it is, and all that decides which samples are drawn of it."""
    nominal = section_tasks(as_sampled(study, section))
    drawn = section.model_dump(
        mode="json", exclude={"inputs": {"__all__": {"source"}}, "deflections": True, "loads": True}
    )
    inputs = {"nominal": [task.inputs for task in nominal], "drawn": drawn, "judged_load": study.judged_load}
    return Task(name=RECORD, function=nominal[0].function, inputs=inputs)


def require_inputs(path: Path, table: Mapping[str, Any], section: InputUncertaintySection) -> None:
    """Refuse an input that is no key of the study, that cannot have one of its ends, or that changes no result.

    Raises
    ------
    StudyError
        As `input_ends`, and for an input at whose ends the section model is given the same; names it.
    """
    for key, ends in input_ends(path, table, section).items():
        low, high = ([[task.inputs for task in section_tasks(end)], yield_strengths(end)] for end in ends)
        if low == high:
            rule = "changes nothing that the section model computes with"
            raise StudyError(path, f"{RECORD}.{key}", section.inputs[key].words, rule, "leave it out, or name another")


def samples_of(found: Mapping[str, Any]) -> Samples:
    """The samples of a record.

    Raises
    ------
    ValueError, TypeError, LookupError
        For what is no such record: shapes that do not belong together, infinite loads, deflections that do not rise.
    """
    nominal, sampled = found["nominal"], found["samples"]
    samples = Samples(
        keys=tuple(found["inputs"]),
        units=tuple(found["units"]),
        values=np.array(list(found["inputs"].values()), dtype=np.float64).T,
        deflection=np.array(found["deflection_m"], dtype=np.float64),
        nominal_load=np.array(nominal["load_N"], dtype=np.float64),
        load=np.array([one["load_N"] for one in sampled], dtype=np.float64),
        nominal_stress=float(np.array(nominal["stress_Pa"], dtype=np.float64)),
        stress=np.array([one["stress_Pa"] for one in sampled], dtype=np.float64),
        nominal_used=float(np.array(nominal["used"], dtype=np.float64)),
        used=np.array([one["used"] for one in sampled], dtype=np.float64),
        early=int(found["early"]),
        notes=found["notes"],
    )
    n, m = len(sampled), len(samples.deflection)
    shapes = (
        samples.values.shape,
        samples.load.shape,
        samples.nominal_load.shape,
        samples.stress.shape,
        samples.used.shape,
    )
    if not n or m < 2 or shapes != ((n, len(samples.keys)), (n, m), (m,), (n,), (n,)) or not samples.keys:
        raise ValueError("every sample has a value of each input, a load at each deflection and a stress")
    numbers = np.concatenate([samples.load.ravel(), samples.nominal_load, samples.stress, samples.used])
    if (
        samples.deflection[0] != 0.0
        or not (np.diff(samples.deflection) > 0.0).all()
        or not samples.deflection[-1] <= _LONGEST
        or (numbers < 0.0).any()
        or (numbers > _LARGEST).any()
        or not np.isfinite(samples.values).all()
        or not np.nanmax(samples.nominal_load, initial=0.0) > 0.0
        or not 0 <= samples.early <= n
    ):
        raise ValueError(f"deflections rise from 0 to {_LONGEST:g} m at most, numbers from 0 to {_LARGEST:g}")
    if len(samples.units) != len(samples.keys) or not all(isinstance(unit, str) for unit in samples.units):
        raise ValueError("each input has a unit")
    return samples


def drawn_of(samples: Samples, section: InputUncertaintySection) -> bool:
    """Whether a record holds the samples that the section states: its inputs, as many."""
    return samples.keys == tuple(section.inputs) and len(samples.load) == section.samples
