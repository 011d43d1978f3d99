"""From study sections to the models' own parameters: the only place where the two vocabularies meet.

Verified by tests/unit/test_workbench_study.py.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from workbench.study.ancf_tire import tire_values
from workbench.study.brush_tire import brush_values
from workbench.study.fit import FittedTireSection
from workbench.study.model import Study, stated
from workbench.study.own_mesh import own_mesh
from workbench.study.wheel_design import in_section, wheel_design

if TYPE_CHECKING:
    from ancf_reduced.plates.mesh import PlateMesh
    from ancf_reduced.tire.preset import ContactDamping, TirePreset
    from rover_dynamics.tires.brush_tire import BrushTireParameters

__all__ = [
    "ancf_mesh",
    "ancf_preset",
    "ancf_tire",
    "brush_parameters",
    "fit_start",
    "fits_rover",
    "on_tire_of_thesis",
    "rover_ancf",
    "rover_brush",
    "rover_on_ancf",
    "rover_on_brush",
    "rover_radius",
]


AS_PRINTED: ContactDamping = "as_printed"
OF_OTHERS: ContactDamping = "hunt_crossley"
"""Contact damping of the thesis' tire, and of all others, where [ancf] states none."""


def ancf_preset(study: Study) -> TirePreset:
    """Parameters of the ANCF tire; raises SectionInputError if they do not fit together."""
    from ancf_reduced.tire.preset import TirePreset

    section = stated(study.ancf, "ancf")
    exclude = {"orientations", "max_deflection", "points", "thesis_preset", "surfaces"}
    values = section.model_dump(exclude=exclude)
    values["contact_damping"] = section.contact_damping or (AS_PRINTED if section.thesis_preset else OF_OTHERS)
    return in_section("ancf", lambda: TirePreset(**values))


def ancf_mesh(study: Study) -> PlateMesh | None:
    """Plates of the ANCF tire on the surfaces of [ancf]; None if it has none and is built from its numbers.

    Raises
    ------
    SectionInputError
        Of the section ``ancf.surfaces``, for a file or surfaces that make no tire of [ancf].
    """
    path = stated(study.ancf, "ancf").surfaces
    if path is None:
        return None
    from ancf_reduced.tire.from_surfaces import surface_mesh
    from geometry.step_surfaces import read_surfaces_step

    preset = ancf_preset(study)
    return in_section("ancf.surfaces", lambda: surface_mesh(read_surfaces_step(Path(path)), preset))


def ancf_tire(study: Study) -> dict[str, Any]:
    """The ANCF tire as inputs of a task, see ``workbench.study.ancf_tire``."""
    return tire_values(ancf_preset(study), ancf_mesh(study))


def fit_start(study: Study, tire: FittedTireSection) -> TirePreset:
    """Where the fit of a tire begins: that of [ancf] with the fitted one's mesh and start.

    The contact stiffness per area stays that of [ancf] unless the start says otherwise; damping of the contact as
    printed is that of the thesis' tire alone. Raises SectionInputError if
    the numbers do not fit together.
    """
    own = ancf_preset(study)
    stiffness = own.contact_stiffness * own.circumferential_plates / tire.circumferential_plates
    changes: dict[str, Any] = {"contact_stiffness": stiffness} | tire.start.model_dump(exclude_none=True)
    changes["datum_radius"] = own.zero_radius  # a free outer radius does not move zero deflection
    changes |= {"spokes": tire.spokes, "circumferential_plates": tire.circumferential_plates}
    changes["contact_damping"] = OF_OTHERS if own.contact_damping == AS_PRINTED else own.contact_damping
    return in_section("ancf_fit.tires", lambda: replace(own, **changes))


def brush_parameters(study: Study) -> BrushTireParameters:
    """Parameters of the brush tire; raises SectionInputError if they break a rule."""
    from rover_dynamics.tires.brush_tire import BrushTireParameters

    values = stated(study.brush, "brush").model_dump()
    values["cornering_stiffness"] = values.pop("cornering_stiffness_per_degree") * 180.0 / math.pi
    return in_section("brush", lambda: BrushTireParameters(**values))


def rover_brush(study: Study) -> BrushTireParameters:
    """The rover's brush tire: that of [brush], the thesis' without it; InputError if the wheel is not of its size."""
    from rover_dynamics.tires.brush_tire import THESIS_BRUSH

    return THESIS_BRUSH if study.brush is None and _of_thesis_size(study) else brush_parameters(study)


def rover_ancf(study: Study) -> TirePreset:
    """The rover's ANCF tire: that of [ancf], the thesis' without it; InputError if the wheel is not of its size."""
    from ancf_reduced.tire.preset import thesis_preset

    return thesis_preset() if study.ancf is None and _of_thesis_size(study) else ancf_preset(study)


def _of_thesis_size(study: Study) -> bool:
    """What a study does not state is the thesis' as far as it can be: its tires fit wheels of its size.

    A wheel with a mesh from another program has the rover's size with [rover], by which its mesh is checked.
    """
    from ancf_reduced.tire.preset import thesis_preset

    if own_mesh(study) is not None:
        return study.rover is not None and bool(np.isclose(rover_radius(), thesis_preset().outer_radius))
    return bool(np.isclose(wheel_design(study).tire.outer_radius, thesis_preset().outer_radius))


def on_tire_of_thesis(study: Study) -> bool:
    """Whether the rover's ANCF tire is the thesis'."""
    return study.ancf is None or study.ancf.thesis_preset


def rover_on_brush(study: Study) -> dict[str, Any]:
    """Brush tire and ground of the rover as inputs of a task, see ``workbench.questions.rover.task``."""
    return {"brush": brush_values(rover_brush(study)), "friction": study.ground.friction}


def fits_rover(study: Study) -> bool:
    """Whether the ANCF tire has the radius of the rover's wheels, so that the rover can stand on it."""
    return (study.ancf is not None or _of_thesis_size(study)) and bool(
        np.isclose(rover_ancf(study).zero_radius, rover_radius())
    )


@cache
def rover_radius() -> float:
    """Of the shipped rover's wheels [m]."""
    from rover_dynamics.rover.rover_file import read_rover

    return read_rover().wheel_radius


def rover_on_ancf(study: Study) -> dict[str, Any]:
    """ANCF tire and ground of the rover as inputs of a task, see ``workbench.questions.rover_ancf.task``."""
    mesh = None if study.ancf is None else ancf_mesh(study)
    return tire_values(rover_ancf(study), mesh) | {"friction": study.ground.friction}
