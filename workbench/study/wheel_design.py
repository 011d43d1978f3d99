"""From the wheel's sections of a study to geometry's wheel: the only place where the two vocabularies meet.

Verified by tests/unit/test_workbench_study.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any

from contracts.errors import InputError
from contracts.material_laws import MooneyRivlin, Ogden, elastic_constants, law_from
from contracts.materials import Material
from workbench.study.section import Section
from workbench.study.wheel import MaterialSection, WheelStudy

if TYPE_CHECKING:
    from geometry.wheel import WheelDesign

__all__ = ["SectionInputError", "design_from", "in_section", "materials", "part_materials", "wheel_design"]


class SectionInputError(InputError):
    """An InputError and the study section it came from, so that the message can name file and key."""

    def __init__(self, section: str, error: InputError) -> None:
        super().__init__(error.what, error.value, error.rule, error.hint, key=error.key)
        self.section = section


def in_section[T](section: str, build: Callable[[], T]) -> T:
    """What ``build`` gives; an InputError of its own is told of with the section, unless it names a smaller one."""
    try:
        return build()
    except SectionInputError:
        raise
    except InputError as error:
        raise SectionInputError(section, error) from error


def materials(study: WheelStudy) -> dict[str, Material]:
    """Materials of the study by name, SI."""
    return {name: _material(name, section) for name, section in study.materials.items()}


def _material(name: str, section: MaterialSection) -> Material:
    values, law = section.model_dump(exclude={"law"}), None
    if section.law is not None:
        law = in_section(f"materials.{name}.law", partial(law_from, section.law.model_dump()))
    if isinstance(law, MooneyRivlin | Ogden):
        values["young_modulus"], values["poisson_ratio"] = elastic_constants(law)
    return in_section(f"materials.{name}", partial(Material, name=name, law=law, **values))


def part_materials(study: WheelStudy) -> dict[str, str]:
    """Material name of each part of the mesh."""
    wheel = study.parametric
    single = ("tire", "tread", "grousers", "lattice", "outer_hub", "cone", "impact_springs", "inner_hub")
    parts = {name: getattr(wheel, name) for name in single} | {s.name: s for s in wheel.springs}
    parts["lattice_joints"] = wheel.lattice
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
    return _built(_Sections(study))


@dataclass(frozen=True, slots=True, eq=False)
class _Sections:
    """A study, equal to others of its name whose wheel and materials are the same objects: sections are never changed,
    and to compare them takes longer than to build the wheel.
    """

    study: WheelStudy

    @property
    def _key(self) -> tuple[int, int, str]:
        return id(self.study.wheel), id(self.study.materials), self.study.name

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Sections) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)


@lru_cache(maxsize=16)
def _built(sections: _Sections) -> WheelDesign:
    """Kept, for the plan of a report asks a hundred times."""
    parts = in_section("wheel", lambda: _WheelParts(sections.study)).build()
    return in_section("wheel", lambda: _of_parts(sections.study.name, tuple(parts.items())))


@lru_cache(maxsize=16)
def _of_parts(name: str, parts: tuple[tuple[str, Any], ...]) -> WheelDesign:
    """Kept apart, for twins of a wheel are made anew and are the same wheels."""
    from geometry.wheel import WheelDesign

    return WheelDesign(name=name, **dict(parts))


def design_from(wheel: Mapping[str, Any]) -> WheelDesign:
    """The design from the JSON of a study's wheel, all values SI; words that it leaves out are made up."""
    materials = {name: {"source": "the study"} | values for name, values in wheel["materials"].items()}
    whole = {"name": "wheel", **wheel, "materials": materials}
    return wheel_design(WheelStudy.model_validate(whole, context={"si": True}))


class _WheelParts:
    """Turns each part's section into geometry's class."""

    def __init__(self, study: WheelStudy) -> None:
        self.wheel, self.known = study.parametric, materials(study)

    def build(self) -> dict[str, Any]:
        """Keyword arguments of WheelDesign."""
        from geometry.lattice import Lattice
        from geometry.parts import Cone, Grousers, HubRing, SpringSet, Tire, Tread
        from geometry.sidewall import SidewallSprings

        wheel = self.wheel
        impact, sidewall = wheel.impact_springs, wheel.sidewall_springs
        return {
            "tire": self._part(Tire, "tire", wheel.tire),
            "tread": wheel.tread and self._part(Tread, "tread", wheel.tread),
            "grousers": wheel.grousers and self._part(Grousers, "grousers", wheel.grousers),
            "spring_sets": tuple(self._part(SpringSet, f"springs[{i}]", s) for i, s in enumerate(wheel.springs)),
            "sidewall_springs": sidewall and self._part(SidewallSprings, "sidewall_springs", sidewall),
            "lattice": wheel.lattice and self._part(Lattice, "lattice", wheel.lattice),
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
            hint = f"add [materials.{material}] or correct the name"
            error = InputError("material", material, rule, hint, key="material")
            raise SectionInputError(f"wheel.{key}", error)
        return in_section(f"wheel.{key}", lambda: kind(**values, **more, material=self.known[material]))
