"""From study sections to the models' own parameters: the only place where the two vocabularies meet.

Verified by tests/unit/test_workbench_study.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contracts.errors import InputError
from contracts.materials import Material
from workbench.study.fit import FittedTireSection
from workbench.study.model import Study, WheelStudy
from workbench.study.sections import Section
from workbench.tasks.ancf_tire import tire_values

if TYPE_CHECKING:
    from ancf_reduced.plates.mesh import PlateMesh
    from ancf_reduced.tire.preset import TirePreset
    from geometry.wheel import WheelDesign
    from rover_dynamics.tires.brush_tire import BrushTireParameters

__all__ = [
    "SectionInputError",
    "ancf_mesh",
    "ancf_preset",
    "ancf_tire",
    "brush_parameters",
    "design_from",
    "fit_start",
    "materials",
    "part_materials",
    "wheel_design",
]


class SectionInputError(InputError):
    """An InputError and the study section it came from, so that the message can name file and key."""

    def __init__(self, section: str, error: InputError) -> None:
        super().__init__(error.what, error.value, error.rule, error.hint)
        self.section = section


def _in_section[T](section: str, build: Callable[[], T]) -> T:
    try:
        return build()
    except InputError as error:
        raise SectionInputError(section, error) from error


def materials(study: WheelStudy) -> dict[str, Material]:
    """Materials of the study by name, SI."""
    return {
        name: _in_section(f"materials.{name}", partial(Material, name=name, **section.model_dump()))
        for name, section in study.materials.items()
    }


def part_materials(study: WheelStudy) -> dict[str, str]:
    """Material name of each part of the mesh."""
    wheel = study.wheel
    single = ("tire", "grousers", "outer_hub", "cone", "impact_springs", "inner_hub")
    parts = {name: getattr(wheel, name) for name in single} | {s.name: s for s in wheel.springs}
    if wheel.sidewall_springs is not None:
        parts[wheel.sidewall_springs.name] = wheel.sidewall_springs
    return {name: part.material for name, part in parts.items() if part is not None}


def wheel_design(study: WheelStudy) -> WheelDesign:
    """Build the wheel, so that geometry checks whether its parts fit together.

    Raises
    ------
    SectionInputError
        If a part breaks a rule or names a material the study does not have; its section is the part's key.
    """
    from geometry.wheel import WheelDesign

    parts = _WheelParts(study).build()
    return _in_section("wheel", lambda: WheelDesign(name=study.name, **parts))


def design_from(wheel: Mapping[str, Any]) -> WheelDesign:
    """The design from the JSON of a study's wheel, all values SI; words that it leaves out are made up."""
    materials = {name: {"source": "the study"} | values for name, values in wheel["materials"].items()}
    whole = {"name": "wheel", **wheel, "materials": materials}
    return wheel_design(WheelStudy.model_validate(whole, context={"si": True}))


class _WheelParts:
    """Turns each part's section into geometry's class."""

    def __init__(self, study: WheelStudy) -> None:
        self.wheel, self.known = study.wheel, materials(study)

    def build(self) -> dict[str, Any]:
        """Keyword arguments of WheelDesign."""
        from geometry.parts import Cone, Grousers, HubRing, SpringSet, Tire
        from geometry.sidewall import SidewallSprings

        wheel = self.wheel
        impact, sidewall = wheel.impact_springs, wheel.sidewall_springs
        return {
            "tire": self._part(Tire, "tire", wheel.tire),
            "grousers": wheel.grousers and self._part(Grousers, "grousers", wheel.grousers),
            "spring_sets": tuple(self._part(SpringSet, f"springs[{i}]", s) for i, s in enumerate(wheel.springs)),
            "sidewall_springs": sidewall and self._part(SidewallSprings, "sidewall_springs", sidewall),
            "outer_hub": self._part(HubRing, "outer_hub", wheel.outer_hub),
            "cone": wheel.cone and self._part(Cone, "cone", wheel.cone),
            "impact_springs": impact and self._part(SpringSet, "impact_springs", impact, name="impact_springs"),
            "inner_hub": wheel.inner_hub and self._part(HubRing, "inner_hub", wheel.inner_hub),
        }

    def _part[T](self, kind: Callable[..., T], key: str, section: Section, **more: object) -> T:
        values = section.model_dump()
        material = values.pop("material")
        if material not in self.known:
            rule = f"is not in [materials], which has {', '.join(self.known) or 'none'}"
            error = InputError("material", material, rule, f"add [materials.{material}] or correct the name")
            raise SectionInputError(f"wheel.{key}", error)
        return _in_section(f"wheel.{key}", lambda: kind(**values, **more, material=self.known[material]))


def ancf_preset(study: Study) -> TirePreset:
    """Parameters of the ANCF tire; raises SectionInputError if they do not fit together."""
    from ancf_reduced.tire.preset import TirePreset

    exclude = {"orientations", "max_deflection", "points", "thesis_preset", "surfaces"}
    return _in_section("ancf", lambda: TirePreset(**study.ancf.model_dump(exclude=exclude)))


def ancf_mesh(study: Study) -> PlateMesh | None:
    """Plates of the ANCF tire on the surfaces of [ancf]; None if it has none and is built from its numbers.

    Raises
    ------
    SectionInputError
        Of the section ``ancf.surfaces``, for a file or surfaces that make no tire of [ancf].
    """
    path = study.ancf.surfaces
    if path is None:
        return None
    from ancf_reduced.tire.from_surfaces import surface_mesh
    from geometry.step_surfaces import read_surfaces_step

    preset = ancf_preset(study)
    return _in_section("ancf.surfaces", lambda: surface_mesh(read_surfaces_step(Path(path)), preset))


def ancf_tire(study: Study) -> dict[str, Any]:
    """The ANCF tire as inputs of a task, see ``workbench.tasks.ancf_tire``."""
    return tire_values(ancf_preset(study), ancf_mesh(study))


def fit_start(study: Study, tire: FittedTireSection) -> TirePreset:
    """Where the fit of a tire begins: that of [ancf] with the fitted one's mesh and start.

    The contact stiffness per area stays that of [ancf] unless the start says otherwise. Raises SectionInputError if
    the numbers do not fit together.
    """
    own = ancf_preset(study)
    stiffness = own.contact_stiffness * own.circumferential_plates / tire.circumferential_plates
    changes: dict[str, Any] = {"contact_stiffness": stiffness} | tire.start.model_dump(exclude_none=True)
    changes["datum_radius"] = own.zero_radius  # a free outer radius does not move zero deflection
    changes |= {"spokes": tire.spokes, "circumferential_plates": tire.circumferential_plates}
    return _in_section("ancf_fit.tires", lambda: replace(own, **changes))


def brush_parameters(study: Study) -> BrushTireParameters:
    """Parameters of the brush tire; raises SectionInputError if they break a rule."""
    from rover_dynamics.tires.brush_tire import BrushTireParameters

    values = study.brush.model_dump()
    values["cornering_stiffness"] = values.pop("cornering_stiffness_per_degree") * 180.0 / math.pi
    return _in_section("brush", lambda: BrushTireParameters(**values))
