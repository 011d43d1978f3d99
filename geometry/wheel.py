"""The wheel as numbers: ``WheelDesign`` and the default, an ExoMars wheel."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from contracts.materials import TI_6AL_4V, TI_6AL_4V_AGED, Material
from geometry.lattice import JOINTS, LATTICE, Lattice
from geometry.parts import Cone, Grousers, HubRing, SpringSet, Tire, Tread
from geometry.sidewall import SidewallSprings
from geometry.validation import validate_wheel

__all__ = ["WheelDesign", "exomars", "exomars_hoops"]

_WELD = 12.0e-3


def _tire() -> Tire:
    return Tire(outer_radius=142.5e-3, width=120.0e-3, thickness=0.9235e-3, material=TI_6AL_4V_AGED)


def _grousers() -> Grousers:
    phase = math.radians(0.97)
    return Grousers(count=12, height=3.0e-3, thickness=1.0e-3, phase=phase, material=TI_6AL_4V_AGED)


def _spring_sets() -> tuple[SpringSet, ...]:
    outer = SpringSet(
        name="springs_outer",
        count=6,
        bands=((-60.0e-3, -25.65e-3), (25.65e-3, 60.0e-3)),
        thickness=0.5903e-3,
        shape="spline",
        points=((0.33, math.radians(26.82)), (0.67, math.radians(35.51))),
        weld_length=_WELD,
        material=TI_6AL_4V_AGED,
    )
    inner = SpringSet(
        name="springs_inner",
        count=3,
        phase=math.radians(50.14),
        bands=((-22.08e-3, 22.08e-3),),
        thickness=0.4198e-3,
        shape="spline",
        direction=-1,
        points=((0.33, math.radians(22.46)), (0.67, math.radians(40.0))),
        weld_length=_WELD,
        material=TI_6AL_4V_AGED,
    )
    return (outer, inner)


def _outer_hub() -> HubRing:
    return HubRing(outer_radius=31.24e-3, thickness=2.0e-3, width=120.0e-3, material=TI_6AL_4V_AGED)


def _cone() -> Cone:
    return Cone(thickness=1.5e-3, outer_position=36.0e-3, inner_position=18.0e-3, material=TI_6AL_4V_AGED)


def _impact_springs() -> SpringSet:
    return SpringSet(
        name="impact_springs",
        count=6,
        phase=math.radians(30.0),
        bands=((-15.0e-3, 15.0e-3),),
        thickness=1.0e-3,
        shape="arc",
        weld_length=6.0e-3,
        material=TI_6AL_4V_AGED,
    )


def _inner_hub() -> HubRing:
    return HubRing(outer_radius=20.0e-3, thickness=3.0e-3, width=60.0e-3, material=TI_6AL_4V_AGED)


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelDesign:
    """An airless wheel: rim, springs and hub. The default is the ExoMars rover's wheel as the thesis' words allow it.

    Published (thesis, theory notes 8): outside size 285 x 120 mm; 12 grousers at 30 degrees; 6 outer springs; 3 inner
    springs, out of phase with them; outer hub, cone, impact springs and inner hub as parts.

    **Inferred, not published**: springs as leaves bowed one way (splines through two points), the inner ones the other
    way; six stations of outer leaves, each in two halves at the lateral faces; their points, bands, welds and phases,
    the thicknesses of rim and leaves and the outer hub's radius, all from the search for wheels that satisfy what the
    thesis says of its reference (docs/theory/words.md, studies/words_search.toml); height and thickness of the
    grousers; the outer hub's thickness 2 mm and width 120 mm; everything of the cone (a mirrored pair, 1.5 mm, from
    y = 36 mm at the outer to y = 18 mm at the inner hub), of the impact springs (6 semicircles of 1 mm strip,
    y = -15..15 mm, weld 6 mm, phase 30 degrees) and of the inner hub (radius 20 mm, thickness 3 mm, width 60 mm);
    Ti-6Al-4V, solution treated and aged, for every part.

    Attributes
    ----------
    name : name in reports
    tire : the rim
    tread : a layer on the rim, or None
    grousers : the fins, or None
    spring_sets : any number of sets between rim and outer hub; at least one where there is nothing else there
    sidewall_springs : strips at the sides of the wheel, or None
    lattice : cells between rim and outer hub in place of springs, or None
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
    tread: Tread | None = None
    grousers: Grousers | None = field(default_factory=_grousers)
    spring_sets: tuple[SpringSet, ...] = field(default_factory=_spring_sets)
    sidewall_springs: SidewallSprings | None = None
    lattice: Lattice | None = None
    outer_hub: HubRing = field(default_factory=_outer_hub)
    cone: Cone | None = field(default_factory=_cone)
    impact_springs: SpringSet | None = field(default_factory=_impact_springs)
    inner_hub: HubRing | None = field(default_factory=_inner_hub)

    def __post_init__(self) -> None:
        validate_wheel(self)

    @property
    def ground_radius(self) -> float:
        """Radius of the surface on which the wheel stands, grousers apart [m]."""
        return self.tire.outer_radius + (self.tread.thickness if self.tread is not None else 0.0)

    @property
    def materials(self) -> Mapping[str, Material]:
        """Part name -> material, in the order of the mesh's parts."""
        optional = {
            "tread": self.tread,
            "grousers": self.grousers,
            **{springs.name: springs for springs in self.spring_sets},
            **({self.sidewall_springs.name: self.sidewall_springs} if self.sidewall_springs else {}),
            LATTICE: self.lattice,
            JOINTS: self.lattice,
            "outer_hub": self.outer_hub,
            "cone": self.cone,
            "impact_springs": self.impact_springs,
            "inner_hub": self.inner_hub,
        }
        return {"tire": self.tire.material} | {name: part.material for name, part in optional.items() if part}


def exomars() -> WheelDesign:
    """Return the default design: the ExoMars rover's wheel (see ``WheelDesign`` for what is inferred)."""
    return WheelDesign()


def exomars_hoops() -> WheelDesign:
    """Return the wheel that the project had before: hoops of one thickness.

    Three stations of two outer and three inner hoops, each of two mirrored semicircles; 0.609 mm, chosen so that the
    solid model's average curve starts at 8.25 N/mm; hub radius 50 mm. It is its own mirror image, and its springs touch
    the rim. ``studies/exomars_hoops.toml`` has 0.6173 mm, by the average weighted by arc. Verified by
    tests/unit/test_geometry_validation.py.
    """
    strip, weld = 0.609e-3, 8.0e-3
    inner = SpringSet(
        name="springs_inner",
        count=3,
        phase=math.radians(60.0),
        bands=((-20.0e-3, 20.0e-3),),
        thickness=strip,
        shape="hoop",
        weld_length=weld,
    )
    sides = ((-60.0e-3, -40.0e-3), (40.0e-3, 60.0e-3))
    return WheelDesign(
        name="exomars_hoops",
        tire=Tire(outer_radius=142.5e-3, width=120.0e-3, thickness=strip),
        grousers=Grousers(count=12, height=3.0e-3, thickness=1.0e-3),
        spring_sets=(replace(inner, name="springs_outer", phase=0.0, bands=sides), inner),
        outer_hub=HubRing(outer_radius=50.0e-3, thickness=2.0e-3, width=120.0e-3),
        cone=replace(_cone(), inner_position=22.0e-3, material=TI_6AL_4V),
        impact_springs=replace(_impact_springs(), material=TI_6AL_4V),
        inner_hub=replace(_inner_hub(), material=TI_6AL_4V),
    )
