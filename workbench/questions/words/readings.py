"""Readings of the thesis' tire: what its text leaves open, varied so that the plates keep the mass of Table I.

Open are the radius of the hub and where the 100 contact points of a plate lie; the thickness follows from the mass. The
stiffness curves of these tires are the thesis' own two curves (Fig. 22) as far as anyone can know them.
``python -m workbench.questions.words.readings FOLDER`` writes them for ``make search``, which follows them.
Verified by tests/unit/test_workbench_readings.py.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Literal

import numpy as np

from contracts.curves import read_curve, write_curve
from workbench.execution.task import Task
from workbench.questions.model_curves import CURVE, ModelCurves, model_curves
from workbench.study.model import Study, stated
from workbench.study.model_parameters import ancf_tire
from workbench.study.orientation import orientation_name
from workbench.study.reading import built_in_study, read_study

__all__ = ["ORIENTATIONS", "READINGS", "Reading", "reading_curves", "reading_tasks"]

ORIENTATIONS = 0.0, 45.0
"""Of the tire [deg]: spoke down, and between two spokes."""
_DEFLECTIONS = (np.arange(41) * 1e-3).round(12).tolist()


@dataclass(frozen=True, slots=True, kw_only=True)
class Reading:
    """One tire that the text allows.

    Attributes
    ----------
    hub_radius, thickness : [m]; the thickness of rim and spokes gives plates of 4.44157 kg (Samarini 2020, Table I)
    layout : of the contact points: ``"edges"`` at i/9 of a plate, ``"centres"`` at (i + 1/2)/10
    """

    hub_radius: float
    thickness: float
    layout: Literal["edges", "centres"]

    @property
    def name(self) -> str:
        """``"hub50_edges"``."""
        return f"hub{1e3 * self.hub_radius:.0f}_{self.layout}"

    @property
    def text(self) -> str:
        """For people."""
        where = "at the plates' edges too" if self.layout == "edges" else "at the middles of a grid"
        return f"hub radius {1e3 * self.hub_radius:.0f} mm, {1e3 * self.thickness:.1f} mm thick, contact points {where}"

    def of(self, study: Study) -> Study:
        """A study with this tire."""
        changes = {
            "hub_radius": self.hub_radius,
            "rim_thickness": self.thickness,
            "spoke_thickness": self.thickness,
            "contact_layout": self.layout,
            "surfaces": None,
        }
        return study.model_copy(update={"ancf": stated(study.ancf, "ancf").model_copy(update=changes)})


_THICKNESS = {40: 24.000, 45: 24.535, 50: 25.098, 55: 25.692, 60: 26.318}
"""Radius of the hub -> thickness [mm] at which the plates weigh what Table I says."""
READINGS = tuple(
    Reading(hub_radius=1e-3 * hub, thickness=1e-3 * thickness, layout=layout)
    for hub, thickness in _THICKNESS.items()
    for layout in ("edges", "centres")
)


def reading_tasks(study: Study) -> list[Task]:
    """Curves of every reading, ``words_hub50_edges_phi000``."""
    return [
        Task(
            name=orientation_name(f"words_{reading.name}", orientation),
            function="workbench.questions.ancf.task:solve_orientation",
            inputs=ancf_tire(reading.of(study)) | {"orientation_deg": orientation, "deflections": _DEFLECTIONS},
            cost=1.0,
        )
        for reading in READINGS
        for orientation in ORIENTATIONS
    ]


def reading_curves(folders: Mapping[str, Path]) -> dict[Reading, ModelCurves]:
    """What those tasks found."""
    return {reading: model_curves(f"words_{reading.name}", folders) for reading in READINGS}


def _write(folder: Path) -> None:
    """Both curves of every reading as CSV, ``hub50_edges_0deg.csv``."""
    from workbench.questions.ancf.task import solve_orientation

    for task in reading_tasks(read_study(built_in_study())):
        name, _, orientation = task.name.removeprefix("words_").partition("_phi")
        with TemporaryDirectory() as scratch:
            solve_orientation(task.inputs, {}, Path(scratch), lambda fraction: None)
            curve = read_curve(Path(scratch) / CURVE)
        write_curve(replace(curve, columns={}), folder / f"{name}_{float(orientation):.0f}deg.csv")


if __name__ == "__main__":
    _write(Path(sys.argv[1]))
