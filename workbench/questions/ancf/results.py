"""Curves and surfaces of the study's ANCF tire. Verified by tests/unit/test_workbench_ancf_surfaces.py."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from contracts.curves import StiffnessCurve
from workbench.execution.result_files import read_result
from workbench.questions.ancf.surfaces import SURFACES
from workbench.questions.model_curves import ModelCurves, model_curves
from workbench.study.model import Study

__all__ = ["AncfTireResults", "read_ancf"]


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfTireResults:
    """The tire's curves, the continuum's average, and how far each STEP file read back lies from the plates [m]."""

    ancf: ModelCurves
    fe_average: StiffnessCurve
    read_back: Mapping[str, float]

    @property
    def surface_distance(self) -> float:
        """The largest of them [m]."""
        return max(self.read_back.values())


def read_ancf(study: Study, folders: Mapping[str, Path]) -> AncfTireResults:
    """The results from the folders of their tasks."""
    return AncfTireResults(
        ancf=model_curves("ancf", folders),
        fe_average=model_curves("fe", folders).average,
        read_back=read_result(folders[SURFACES])["read_back_m"],
    )
