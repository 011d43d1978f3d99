"""The wheel as numbers: ``WheelDesign`` and the default, an ExoMars wheel."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from contracts.materials import Material
from geometry.parts import Cone, Grousers, HubRing, SpringSet, Tire
from geometry.sidewall import SidewallSprings
from geometry.validation import validate_wheel

__all__ = ["WheelDesign", "exomars"]

_STRIP = 0.609e-3
_WELD = 8.0e-3


def _tire() -> Tire:
    return Tire(outer_radius=142.5e-3, width=120.0e-3, thickness=_STRIP)


def _grousers() -> Grousers:
    return Grousers(count=12, height=3.0e-3, thickness=1.0e-3)


def _spring_sets() -> tuple[SpringSet, ...]:
    outer = SpringSet(
        name="springs_outer",
        count=3,
        bands=((-60.0e-3, -40.0e-3), (40.0e-3, 60.0e-3)),
        thickness=_STRIP,
        shape="hoop",
        weld_length=_WELD,
    )
    inner = SpringSet(
        name="springs_inner",
        count=3,
        phase=math.radians(60.0),
        bands=((-20.0e-3, 20.0e-3),),
        thickness=_STRIP,
        shape="hoop",
        weld_length=_WELD,
    )
    return (outer, inner)


def _impact_springs() -> SpringSet:
    return SpringSet(
        name="impact_springs",
        count=6,
        phase=math.radians(30.0),
        bands=((-15.0e-3, 15.0e-3),),
        thickness=1.0e-3,
        shape="arc",
        weld_length=6.0e-3,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelDesign:
    """An airless wheel: rim, springs and hub. The default is the ExoMars rover's wheel with hoop springs of Ti-6Al-4V.

    Published (thesis, theory notes 8): outside size 285 x 120 mm; 12 grousers at 30 degrees; 6 outer springs as 3
    stations of two at the lateral faces; 3 inner springs at mid-width; outer hub, cone, impact springs and inner hub as
    parts.

    **Inferred, not published**: the inner springs' turn of 60 degrees against the outer ones; that a spring is a hoop
    of two mirrored semicircles; the strip thickness 0.609 mm, one for rim and springs (chosen so that the solid
    model's average curve starts at 8.25 N/mm with hub radius 50 mm); the spring bands -60..-40, -20..20 and
    40..60 mm; a weld of 8 mm; height 3 mm, thickness 1 mm and phase 0 of the grousers; the outer hub's radius 50 mm,
    thickness 2 mm and width 120 mm; everything of the cone (a mirrored pair, 1.5 mm, from y = 36 mm at the outer to
    y = 22 mm at the inner hub), of the impact springs (6 semicircles of 1 mm strip, y = -15..15 mm, weld 6 mm, phase 30
    degrees) and of the inner hub (radius 20 mm, thickness 3 mm, width 60 mm); Ti-6Al-4V for every part.

    Attributes
    ----------
    name : name in reports
    tire : the rim
    grousers : the fins, or None
    spring_sets : any number of sets between rim and outer hub; at least one where there are no sidewall springs
    sidewall_springs : strips at the sides of the wheel, or None
    outer_hub : ring that carries the springs; of a wheel with sidewall springs only their clamped ends are meshed
    cone : shell between the hubs, or None
    impact_springs : spring set between the hubs, or None
    inner_hub : ring inside, or None (then neither cone nor impact springs)

    Raises
    ------
    InputError
        If parts do not fit together (see ``geometry.validation``).

    Verified by tests/unit/test_geometry_validation.py and tests/verification/test_mesh_volume.py.
    """

    name: str = "exomars"
    tire: Tire = field(default_factory=_tire)
    grousers: Grousers | None = field(default_factory=_grousers)
    spring_sets: tuple[SpringSet, ...] = field(default_factory=_spring_sets)
    sidewall_springs: SidewallSprings | None = None
    outer_hub: HubRing = field(default_factory=lambda: HubRing(outer_radius=50.0e-3, thickness=2.0e-3, width=120.0e-3))
    cone: Cone | None = field(
        default_factory=lambda: Cone(thickness=1.5e-3, outer_position=36.0e-3, inner_position=22.0e-3)
    )
    impact_springs: SpringSet | None = field(default_factory=_impact_springs)
    inner_hub: HubRing | None = field(
        default_factory=lambda: HubRing(outer_radius=20.0e-3, thickness=3.0e-3, width=60.0e-3)
    )

    def __post_init__(self) -> None:
        validate_wheel(self)

    @property
    def materials(self) -> Mapping[str, Material]:
        """Part name -> material, in the order of the mesh's parts."""
        optional = {
            "grousers": self.grousers,
            **{springs.name: springs for springs in self.spring_sets},
            **({self.sidewall_springs.name: self.sidewall_springs} if self.sidewall_springs else {}),
            "outer_hub": self.outer_hub,
            "cone": self.cone,
            "impact_springs": self.impact_springs,
            "inner_hub": self.inner_hub,
        }
        return {"tire": self.tire.material} | {name: part.material for name, part in optional.items() if part}


def exomars() -> WheelDesign:
    """Return the default design: the ExoMars rover's wheel (see ``WheelDesign`` for what is inferred)."""
    return WheelDesign()
