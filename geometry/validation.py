"""Whether the parts of a wheel fit together: nested radii, bands inside the width, springs clear of each other.

Every rule raises InputError. Verified by tests/unit/test_geometry_validation.py.
"""

from __future__ import annotations

import math
from typing import Protocol

from contracts.errors import InputError
from geometry.clearance import require_clear_of_rings, require_clear_sets
from geometry.lattice import JOINTS, LATTICE, Lattice, require_lattice_fits
from geometry.parts import Cone, Grousers, HubRing, SpringSet, Tire, Tread
from geometry.sidewall import SidewallSprings, weld_half_angle
from geometry.springs import weld_angle

__all__ = ["RESERVED_NAMES", "validate_wheel"]

RESERVED_NAMES = ("tire", "tread", "grousers", LATTICE, JOINTS, "outer_hub", "cone", "impact_springs", "inner_hub")


class _Parts(Protocol):
    """What a `geometry.wheel.WheelDesign` is made of; that module imports this one."""

    @property
    def tire(self) -> Tire: ...
    @property
    def tread(self) -> Tread | None: ...
    @property
    def grousers(self) -> Grousers | None: ...
    @property
    def spring_sets(self) -> tuple[SpringSet, ...]: ...
    @property
    def sidewall_springs(self) -> SidewallSprings | None: ...
    @property
    def lattice(self) -> Lattice | None: ...
    @property
    def outer_hub(self) -> HubRing: ...
    @property
    def cone(self) -> Cone | None: ...
    @property
    def impact_springs(self) -> SpringSet | None: ...
    @property
    def inner_hub(self) -> HubRing | None: ...


def validate_wheel(design: _Parts) -> None:
    """Check a design as a whole; raises InputError naming the first rule it breaks."""
    _check_names(design)
    tire, hub = design.tire, design.outer_hub
    if design.tread is not None:
        _check_tread(design.tread, tire.width)
    if design.grousers is not None:
        radius = tire.outer_radius + (design.tread.thickness if design.tread is not None else 0.0)
        _check_grousers(design.grousers, radius)
    _check_nested(
        "outer hub radius", "outer_hub.outer_radius", hub.outer_radius, "tire's inner radius", tire.inner_radius
    )
    half_width = 0.5 * min(tire.width, hub.width)
    keys = [f"spring_sets[{i}]" for i in range(len(design.spring_sets))]
    for springs, key in zip(design.spring_sets, keys, strict=True):
        _check_springs(springs, (hub.outer_radius, tire.inner_radius), half_width, key)
    require_clear_sets(design.spring_sets, (hub.outer_radius, tire.inner_radius), keys)
    if design.lattice is not None:
        _check_lattice(design.lattice, design, half_width)
    if design.sidewall_springs is not None:
        _check_sidewall(design.sidewall_springs, design)
    if design.inner_hub is None:
        if design.cone is not None or design.impact_springs is not None:
            rule = "cone and impact springs need an inner hub"
            raise InputError("inner hub", "none", rule, "give an inner hub or leave both out", key="inner_hub")
    else:
        _check_inner_hub(design, design.inner_hub)


def _check_names(design: _Parts) -> None:
    sidewall = [design.sidewall_springs.name] if design.sidewall_springs else []
    names = [springs.name for springs in design.spring_sets] + sidewall
    if not names and design.lattice is None:
        hint = "give springs, sidewall springs or a lattice"
        raise InputError("spring sets", "none", "the rim needs springs", hint, key="spring_sets")
    places = [f"spring_sets[{i}].name" for i in range(len(design.spring_sets))] + ["sidewall_springs.name"]
    for name, place in zip(names, places, strict=False):
        if name in RESERVED_NAMES:
            raise InputError("spring set name", name, "is the name of another part", "choose another name", key=place)
        if name.lower() in RESERVED_NAMES:
            rule = f"differs from the name of another part, {name.lower()}, in capitals alone"
            raise InputError("spring set name", name, rule, "choose another name", key=place)
        if names.count(name) > 1:
            raise InputError("spring set name", name, "is used twice", "give each spring set its own name", key=place)
    if design.impact_springs is not None and design.impact_springs.name != "impact_springs":
        rule = "the set between the hubs is called impact_springs"
        raise InputError("impact spring set name", design.impact_springs.name, rule, "set name='impact_springs'")


def _check_grousers(grousers: Grousers, radius: float) -> None:
    spacing = 2.0 * radius * math.sin(math.pi / grousers.count) if grousers.count > 1 else 2.0 * radius
    if grousers.thickness >= spacing:
        text = f"{grousers.thickness * 1e3:g} mm"
        rule = f"{grousers.count} grousers overlap: their feet are {spacing * 1e3:.4g} mm apart"
        raise InputError("grouser thickness", text, rule, "use fewer or thinner grousers", key="grousers.thickness")


def _check_nested(what: str, key: str, inner: float, other: str, outer: float) -> None:
    if inner >= outer:
        rule = f"must be smaller than the {other}, {outer * 1e3:g} mm"
        raise InputError(what, f"{inner * 1e3:g} mm", rule, "use a smaller hub or a larger wheel", key=key)


def _check_tread(tread: Tread, width: float) -> None:
    if tread.width is not None and tread.width > width + 1e-12:
        rule = f"must not exceed the tire's width, {width * 1e3:g} mm"
        raise InputError("tread width", f"{tread.width * 1e3:g} mm", rule, "narrow the tread", key="tread.width")


def _check_lattice(lattice: Lattice, design: _Parts, half_width: float) -> None:
    """A lattice is alone between rim and hub, lies within them along the axle, and fits."""
    if design.spring_sets or design.sidewall_springs is not None:
        rule = "cannot be combined with springs between rim and hub"
        raise InputError("lattice", lattice.kind, rule, "leave out the one or the other", key="lattice")
    for y0, y1 in lattice.bands:
        _check_band("lattice band", (y0, y1), half_width, "lattice.bands")
    require_lattice_fits(lattice, (design.outer_hub.outer_radius, design.tire.inner_radius))


def _check_band(what: str, band: tuple[float, float], half_width: float, key: str) -> None:
    y0, y1 = band
    if y0 < -half_width - 1e-12 or y1 > half_width + 1e-12:
        rule = f"leaves the rings it joins, which reach from {-half_width * 1e3:g} to {half_width * 1e3:g} mm"
        raise InputError(what, f"{y0 * 1e3:g}..{y1 * 1e3:g} mm", rule, "move the band inwards", key=key)


def _check_springs(springs: SpringSet, gap: tuple[float, float], half_width: float, key: str) -> None:
    hub, rim = gap
    if springs.thickness + springs.hub_thickness >= rim - hub:
        rule = f"strip and two welds do not fit the gap of {(rim - hub) * 1e3:.4g} mm between the rings"
        raise InputError(
            f"{springs.name} thickness",
            f"{springs.thickness * 1e3:g} mm",
            rule,
            "use a thinner strip",
            key=f"{key}.thickness",
        )
    for band in springs.bands:
        _check_band(f"{springs.name} band", band, half_width, f"{key}.bands")
    if weld_angle(springs, rim) >= 2.0 * math.pi / springs.count:
        spacing = 2.0 * math.pi * rim / springs.count
        rule = f"must be smaller than the spacing of the welds, {spacing * 1e3:.4g} mm"
        raise InputError(
            f"{springs.name} weld length",
            f"{springs.weld_length * 1e3:g} mm",
            rule,
            "shorten the weld",
            key=f"{key}.weld_length",
        )
    require_clear_of_rings(springs, gap, key)


def _check_sidewall(springs: SidewallSprings, design: _Parts) -> None:
    rim, hub = design.tire.inner_radius, design.outer_hub.outer_radius
    if design.spring_sets or design.inner_hub is not None:
        rule = "cannot be combined with springs in the wheel's plane or an inner hub"
        raise InputError(
            "sidewall springs",
            springs.name,
            rule,
            "leave the other springs and the inner hub out",
            key="sidewall_springs",
        )
    if springs.weld_length > 0.5 * design.tire.width + 1e-12:
        rule = f"must not exceed half the tire's width, {0.5e3 * design.tire.width:g} mm"
        raise InputError(
            f"{springs.name} weld length",
            f"{springs.weld_length * 1e3:g} mm",
            rule,
            "shorten the weld",
            key="sidewall_springs.weld_length",
        )
    if springs.width >= 2.0 * rim or 2.0 * weld_half_angle(springs, rim) >= 2.0 * math.pi / springs.count:
        spacing = 2.0e3 * math.pi * rim / springs.count
        rule = f"must be smaller than the spacing of the strips on the rim, {spacing:.4g} mm"
        raise InputError(
            f"{springs.name} width",
            f"{springs.width * 1e3:g} mm",
            rule,
            "use narrower or fewer strips",
            key="sidewall_springs.width",
        )
    centre = rim - 0.5 * springs.thickness - 2.0 * springs.curl_radius - springs.arc_radius
    lowest = centre + springs.arc_radius * math.cos(springs.sweep)
    clamp = lowest - springs.clamp_length * math.sin(springs.sweep)
    room = 0.5 * springs.width / math.tan(math.pi / springs.count) if springs.count > 2 else 0.0
    if min(lowest, clamp) < max(hub - 1e-9, 0.0):
        text = f"strip down to radius {min(lowest, clamp) * 1e3:.4g} mm"
        rule = f"must stay outside the outer hub, radius {hub * 1e3:.4g} mm"
        raise InputError(
            f"{springs.name} arc radius",
            text,
            rule,
            "use a smaller arc, curl, sweep or hub",
            key="sidewall_springs.arc_radius",
        )
    if lowest < room:
        rule = f"neighbours overlap at the hub: they need a radius of {room * 1e3:.4g} mm"
        raise InputError(
            f"{springs.name} width",
            f"{springs.width * 1e3:g} mm",
            rule,
            "use narrower or fewer strips",
            key="sidewall_springs.width",
        )


def _check_inner_hub(design: _Parts, inner: HubRing) -> None:
    bore = design.outer_hub.inner_radius
    _check_nested("inner hub radius", "inner_hub.outer_radius", inner.outer_radius, "outer hub's bore", bore)
    if design.cone is None and design.impact_springs is None:
        rule = "nothing joins it to the outer hub"
        raise InputError(
            "inner hub", f"{inner.outer_radius * 1e3:g} mm", rule, "give a cone, or leave the hub out", key="inner_hub"
        )
    half_width = 0.5 * min(inner.width, design.outer_hub.width)
    if design.impact_springs is not None:
        _check_springs(design.impact_springs, (inner.outer_radius, bore), half_width, "impact_springs")
        require_clear_sets((design.impact_springs,), (inner.outer_radius, bore), ["impact_springs"])
    if design.cone is not None:
        _check_cone(design, design.cone, inner)


def _check_cone(design: _Parts, cone: Cone, inner: HubRing) -> None:
    half = 0.5 * cone.axial_width(design.outer_hub.inner_radius, inner.outer_radius)
    for name, at, width in (
        ("outer_position", cone.outer_position, design.outer_hub.width),
        ("inner_position", cone.inner_position, inner.width),
    ):
        if 2.0 * half > 0.5 * width + 1e-12:
            rule = (
                f"its joint takes {2e3 * half:.4g} mm along the axle, where a side of the hub has {500.0 * width:g} mm"
            )
            raise InputError(
                "cone thickness", f"{cone.thickness * 1e3:g} mm", rule, "use a thinner shell", key="cone.thickness"
            )
        if at - half < -1e-12 or at + half > 0.5 * width + 1e-12:
            rule = f"its joint of {2e3 * half:.4g} mm must lie in 0..{500.0 * width:g} mm"
            what = f"cone {name.replace('_', ' ')}"
            raise InputError(what, f"{at * 1e3:g} mm", rule, "move the cone along the axle", key=f"cone.{name}")
    if 0.0 < abs(cone.outer_position - cone.inner_position) < 2.0 * half:
        text = f"{cone.outer_position * 1e3:g} and {cone.inner_position * 1e3:g} mm"
        rule = f"its two joints of {2e3 * half:.4g} mm overlap along the axle"
        raise InputError("cone positions", text, rule, "make them equal (a disc) or move them apart", key="cone")
    if design.impact_springs is not None:
        low = min(cone.outer_position, cone.inner_position) - half
        high = max(cone.outer_position, cone.inner_position) + half
        for y0, y1 in design.impact_springs.bands:
            if (y0 <= high and y1 >= low) or (y0 <= -low and y1 >= -high):
                rule = f"meets the cone, which takes up {low * 1e3:.4g}..{high * 1e3:.4g} mm on either side"
                raise InputError(
                    "impact_springs band",
                    f"{y0 * 1e3:g}..{y1 * 1e3:g} mm",
                    rule,
                    "narrow the band",
                    key="impact_springs.bands",
                )
