"""Question: how far the ANCF tire's few plates decide its load, and its geometry error.

Verified by tests/unit/test_workbench_ancf_mesh.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from contracts.records import Check
from workbench.execution.result_files import read_result
from workbench.execution.task import Task
from workbench.questions.question import Question
from workbench.study.model import Study, stated
from workbench.study.model_parameters import ancf_preset
from workbench.verdict.rules import Claim, at_most

__all__ = ["ANCF_MESH", "AncfMeshRow", "AncfMeshStudy"]

FACTORS = (1, 2, 4, 8)
"""Plates around the rim, in multiples of the study's: 4, 8, 16, 32 for the thesis' tire."""
DEFLECTIONS = (0.010, 0.020, 0.030)


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfMeshRow:
    """One number of plates.

    Attributes
    ----------
    plates, dofs : around the rim; unknowns
    outer_face_error : how far the unloaded outer face lies inside the nominal circle [m]
    loads : (orientation [deg], loads [N] at the study's deflections, None where there is none)
    """

    plates: int
    dofs: int
    outer_face_error: float
    loads: tuple[tuple[float, tuple[float | None, ...]], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfMeshStudy:
    """Rows from the study's own number of plates upwards."""

    deflections: tuple[float, ...]
    rows: tuple[AncfMeshRow, ...]

    @property
    def largest_excess(self) -> float:
        """Largest |F / F_finest - 1| of the study's own mesh, over orientations and deflections that both have [-]."""
        own, finest = self.rows[0], self.rows[-1]
        pairs = [
            (a, b)
            for (_, ours), (_, theirs) in zip(own.loads, finest.loads, strict=True)
            for a, b in zip(ours, theirs, strict=True)
        ]
        return max(abs(a / b - 1.0) for a, b in pairs if a is not None and b)


def _orientations(study: Study) -> list[float]:
    """On a spoke, and half-way between two."""
    return [0.0, 180.0 / ancf_preset(study).spokes]


def _deflections(study: Study) -> tuple[float, ...]:
    """Those of the table that the study's tire reaches, or its largest [m]."""
    end = stated(study.ancf, "ancf").max_deflection
    return tuple(d for d in DEFLECTIONS if d <= end) or (end,)


def _tasks(study: Study) -> Sequence[Task]:
    preset = ancf_preset(study)
    return [
        Task(
            name=f"ancf_plates_x{factor}",
            function="workbench.questions.ancf_mesh.task:solve_refined",
            inputs={
                "preset": asdict(preset),
                "plates": factor * preset.circumferential_plates,
                "orientations_deg": _orientations(study),
                "deflections": list(_deflections(study)),
            },
            cost=2.0 * factor,
        )
        for factor in FACTORS
    ]


def _read(study: Study, folders: Mapping[str, Path]) -> AncfMeshStudy:
    rows, plates = [], ancf_preset(study).circumferential_plates
    for factor in FACTORS:
        found = read_result(folders[f"ancf_plates_x{factor}"])
        rows.append(
            AncfMeshRow(
                plates=factor * plates,
                dofs=found["dofs"],
                outer_face_error=found["outer_face_error_m"],
                loads=tuple((float(o), tuple(loads)) for o, loads in found["loads"].items()),
            )
        )
    return AncfMeshStudy(deflections=_deflections(study), rows=tuple(rows))


def _checks(study: Study, results: AncfMeshStudy) -> Sequence[Check]:
    claim = Claim(
        id="ancf.mesh_excess",
        title=f"ANCF: largest difference of load between {results.rows[0].plates} plates around the rim, the study's, "
        f"and {results.rows[-1].plates}",
        quantity="difference / load of the finest",
        unit="-",
        role="finding",
        source="our own refinement; the limit is that of the comparison between models",
    )
    return [at_most(claim, lambda: results.largest_excess, study.tolerances.model_agreement)]


def _is_parametric(study: Study) -> bool:
    """A tire drawn in a file is not refined here: its numbers alone would give another one."""
    return study.ancf is not None and study.ancf.surfaces is None


ANCF_MESH = Question(
    name="ancf_mesh",
    title="ANCF mesh",
    group="ANCF tire",
    tasks=_tasks,
    read=_read,
    checks=_checks,
    applies=_is_parametric,
)
