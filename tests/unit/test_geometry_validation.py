"""Every rule of a wheel design: what breaks it raises InputError with a message that names it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.materials import SPRING_STEEL, TI_6AL_4V
from geometry.clearance import bends_one_way, overlaps_itself
from geometry.parts import Cone, Grousers, HubRing, SpringSet, Tire
from geometry.springs import Leg, spring_leg
from geometry.wheel import WheelDesign, exomars, exomars_hoops

WHEEL = exomars_hoops()
OUTER, INNER = WHEEL.spring_sets


def springs(**changes: Any) -> WheelDesign:
    """Wheel whose outer springs have the given changes."""
    return replace(WHEEL, spring_sets=(replace(OUTER, **changes), INNER))


def impact(**changes: Any) -> WheelDesign:
    assert WHEEL.impact_springs is not None
    return replace(WHEEL, impact_springs=replace(WHEEL.impact_springs, **changes))


def cone(thickness: float, outer: float, inner: float) -> WheelDesign:
    return replace(WHEEL, cone=Cone(thickness=thickness, outer_position=outer, inner_position=inner))


def spline(*points: tuple[float, float]) -> WheelDesign:
    return springs(shape="spline", points=points)


BROKEN: dict[str, tuple[Callable[[], object], str]] = {
    "tire radius negative": (lambda: Tire(outer_radius=-0.1, width=0.1, thickness=1e-3), "tire outer radius"),
    "tire width nan": (lambda: Tire(outer_radius=0.1, width=math.nan, thickness=1e-3), "tire width"),
    "tire thickness infinite": (lambda: Tire(outer_radius=0.1, width=0.1, thickness=math.inf), "tire thickness"),
    "tire thicker than its radius": (lambda: Tire(outer_radius=0.1, width=0.1, thickness=0.1), "smaller than"),
    "no grouser": (lambda: Grousers(count=0, height=1e-3, thickness=1e-3), "grouser count"),
    "grouser height zero": (lambda: Grousers(count=2, height=0.0, thickness=1e-3), "grouser height"),
    "grouser phase nan": (lambda: Grousers(count=2, height=1e-3, thickness=1e-3, phase=math.nan), "grouser phase"),
    "grousers overlap": (
        lambda: replace(WHEEL, grousers=Grousers(count=900, height=3e-3, thickness=1e-3)),
        "grousers overlap",
    ),
    "hub larger than rim": (
        lambda: replace(WHEEL, outer_hub=HubRing(outer_radius=0.15, thickness=2e-3, width=0.12)),
        "hub radius",
    ),
    "hub thicker than its radius": (lambda: HubRing(outer_radius=0.05, thickness=0.05, width=0.1), "hub thickness"),
    "spring thickness zero": (lambda: springs(thickness=0.0), "thickness"),
    "spring thicker than the gap": (lambda: springs(thickness=0.05), "do not fit the gap"),
    "spring count zero": (lambda: springs(count=0), "count"),
    "spring count not whole": (lambda: springs(count=2.5), "count"),
    "hoops of one set overlap": (lambda: springs(count=7), "overlap each other"),
    "sets cross in a shared band": (lambda: springs(bands=((-60e-3, 60e-3),), phase=math.radians(40.0)), "cross"),
    "sets cross in touching bands": (lambda: springs(bands=((20e-3, 60e-3),), phase=math.radians(40.0)), "cross"),
    "band outside the width": (lambda: springs(bands=((-61e-3, -40e-3), (40e-3, 60e-3))), "leaves the rings"),
    "bands overlap": (lambda: springs(bands=((-60e-3, 10e-3), (0.0, 60e-3))), "-60..10 and 0..60 mm: must not"),
    "band turned round": (lambda: springs(bands=((60e-3, 40e-3),)), "end after it begins"),
    "band not finite": (lambda: springs(bands=((math.nan, 40e-3),)), "finite"),
    "no band": (lambda: springs(bands=()), r'at least one.*\[\["-20 mm", "20 mm"\]\]'),
    "weld length zero": (lambda: springs(weld_length=0.0), "weld length"),
    "weld longer than the spacing": (lambda: springs(weld_length=0.3), "spacing of the welds"),
    "direction zero": (lambda: springs(direction=0), "direction"),
    "shape unknown": (lambda: springs(shape="helix"), "shape"),
    "spline without points": (lambda: springs(shape="spline"), "points"),
    "arc with points": (lambda: springs(points=((0.5, 0.5),)), "points"),
    "spline point not finite": (lambda: spline((0.5, math.inf)), "finite"),
    "spline crosses the hub": (lambda: spline((1.2, 0.5)), "crosses the hub or the rim"),
    "spline crosses the rim": (lambda: spline((-0.2, 0.3)), "crosses the hub or the rim"),
    "spline overlaps itself": (lambda: spline((0.5, 0.5), (0.3, 0.0), (0.3, 0.5), (0.8, 0.3)), "overlaps itself"),
    "name of another part": (lambda: springs(name="tire"), "another part"),
    "name of another part in capitals": (lambda: springs(name="Tread"), "part, tread, in capitals alone"),
    "name used twice": (lambda: springs(name="springs_inner"), "used twice"),
    "name with a space": (lambda: springs(name="outer springs"), "letters, digits"),
    "no spring set": (lambda: replace(WHEEL, spring_sets=()), "needs springs"),
    "cone without inner hub": (lambda: replace(WHEEL, inner_hub=None), "inner hub"),
    "inner hub not joined": (lambda: replace(WHEEL, cone=None, impact_springs=None), "joins it"),
    "inner hub too large": (
        lambda: replace(WHEEL, inner_hub=HubRing(outer_radius=48e-3, thickness=2e-3, width=0.06)),
        "inner hub radius",
    ),
    "impact set misnamed": (lambda: impact(name="bumper"), "impact_springs"),
    "impact springs meet the cone": (lambda: impact(bands=((-25e-3, 25e-3),)), "meets the cone"),
    "impact springs outside the inner hub": (lambda: impact(bands=((-31e-3, 31e-3),)), "leaves the rings"),
    "cone outside the hub": (lambda: cone(1.5e-3, 60e-3, 22e-3), "cone outer position"),
    "cone joints overlap": (lambda: cone(1.5e-3, 22.5e-3, 22e-3), "overlap along the axle"),
    "cone thickness negative": (lambda: cone(-1e-3, 36e-3, 22e-3), "cone thickness"),
}


@pytest.mark.parametrize("case", BROKEN)
def test_broken_design_is_refused(case: str) -> None:
    build, says = BROKEN[case]
    with pytest.raises(InputError, match=says):
        build()


@pytest.mark.parametrize("wheel", [exomars(), WHEEL], ids=["leaves", "hoops"])
def test_both_wheels_have_what_is_published(wheel: WheelDesign) -> None:
    """285 x 120 mm, 12 grousers, six outer springs at the faces and three inner ones out of phase (theory notes 8)."""
    assert 2.0 * wheel.tire.outer_radius == pytest.approx(0.285)
    assert wheel.tire.width == pytest.approx(0.120)
    assert wheel.grousers is not None
    assert wheel.grousers.count == 12
    outer, inner = wheel.spring_sets
    pairs = 2 if outer.count == 3 else 1  # three stations of two, or six
    assert outer.count * pairs == 6
    assert inner.count * len(inner.bands) == 3
    pitch = 2.0 * math.pi / outer.count
    assert min((inner.phase - outer.phase) % pitch, (outer.phase - inner.phase) % pitch) > math.radians(5.0)


def test_default_is_the_exomars_wheel() -> None:
    assert WheelDesign() == exomars()


def test_each_part_has_its_material() -> None:
    steel = replace(WHEEL, spring_sets=(replace(OUTER, material=SPRING_STEEL), INNER), cone=None)
    expected = ["tire", "grousers", "springs_outer", "springs_inner", "outer_hub", "impact_springs", "inner_hub"]
    assert list(steel.materials) == expected
    assert steel.materials["springs_outer"] is SPRING_STEEL
    assert steel.materials["tire"] is TI_6AL_4V


def test_arcs_of_equal_direction_may_stand_closer_than_hoops() -> None:
    """32 curved springs, as in the wheel of theory notes 8, fit as arcs and not as hoops."""
    arcs = replace(WHEEL, spring_sets=(replace(INNER, count=16, shape="arc"),))
    assert arcs.spring_sets[0].count == 16
    with pytest.raises(InputError, match="overlap each other"):
        replace(WHEEL, spring_sets=(replace(INNER, count=16),))


def test_spring_sets_of_separate_bands_may_share_positions() -> None:
    same = replace(WHEEL, spring_sets=(OUTER, replace(INNER, phase=0.0)))
    assert isinstance(same.spring_sets[0], SpringSet)


@pytest.mark.parametrize(("radius", "thickness"), [(142.5, 0.609e-3), (0.1425, 1e-9), (1e6, 1e-6)])
def test_looking_for_clearance_costs_the_same_whatever_the_dimensions(
    radius: float, thickness: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Points made on the centrelines; once they lay a quarter of the thickness apart, so that millimetres read as
    metres, a thousandfold wheel of the same strips, took minutes."""
    made, interp = 0, np.interp

    def counted(x: Any, *rest: Any) -> Any:
        nonlocal made
        made += len(x)
        assert made < 100_000
        return interp(x, *rest)

    monkeypatch.setattr(np, "interp", counted)
    scale = radius / WHEEL.tire.outer_radius
    hub = replace(WHEEL.outer_hub, outer_radius=scale * WHEEL.outer_hub.outer_radius)
    sets = tuple(replace(one, thickness=thickness) for one in WHEEL.spring_sets)
    replace(WHEEL, tire=replace(WHEEL.tire, outer_radius=radius), outer_hub=hub, spring_sets=sets)
    turned = replace(sets[0], bands=((-60e-3, 60e-3),), phase=math.radians(40.0))
    with pytest.raises(InputError, match="cross"):
        replace(WHEEL, tire=replace(WHEEL.tire, outer_radius=radius), outer_hub=hub, spring_sets=(turned, sets[1]))


def circle(turn: float) -> Leg:
    angle = np.linspace(0.0, turn, 101)
    normals = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return Leg(points=0.05 * normals, normals=normals, length=0.05 * turn, segments=2, centre=np.zeros(2))


def test_a_strip_that_bends_one_way_does_not_overlap_itself() -> None:
    """As thick as its sharpest bend allows; circles of more than half a turn and strips that bend both ways may."""
    numbers, gap = np.random.default_rng(3), (WHEEL.outer_hub.outer_radius, WHEEL.tire.inner_radius)
    one_way = 0
    for _ in range(300):
        middle, bulge = numbers.uniform(0.2, 0.8), numbers.uniform(0.02, 0.9)
        ends = numbers.uniform(0.2, 1.2, 2) * bulge
        points = ((0.5 * middle, ends[0]), (middle, bulge), (0.5 + 0.5 * middle, ends[1]))
        leg = spring_leg(replace(OUTER, shape="spline", points=points), gap, 0.0, OUTER.direction)
        if bends_one_way(leg):
            sharpest = np.linalg.norm(np.diff(leg.normals, axis=0), axis=1).max() * (len(leg.points) - 1) / leg.length
            one_way += 1
            assert not overlaps_itself(leg, 1.99 / sharpest), points
    assert 10 < one_way < 200
    assert bends_one_way(circle(math.pi))
    assert not overlaps_itself(circle(math.pi), 0.09)
    assert not bends_one_way(circle(3.0 * math.pi))
    assert overlaps_itself(circle(3.0 * math.pi), 1e-3)
