"""What is looked at: the wheel at its loads, a rover in its motion; each knows its pictures and its words.

All windows look at the same ones, a folder's, read once. Verified by tests/unit/test_viewer_stages.py and
tests/end_to_end/test_view.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from workbench.charts.palette import STRAIN_COLOURS
from workbench.charts.solids import Quads
from workbench.charts.tire_animation import StrainedTires, strained_tires
from workbench.questions.fe.field_file import read_points, read_pressures
from workbench.questions.rover.motion_file import RecordedMotion, read_motion
from workbench.study.ancf_tire import drawn_tire
from workbench.viewer.colours import ColourBar, colour_bar, rgb
from workbench.viewer.ground import Ground
from workbench.viewer.scene import Camera, Scene
from workbench.viewer.wheel_body import WheelBody
from workbench.viewer.wheel_file import read_fields
from workbench.viewer.wheel_surface import WheelField, WheelPoints, WheelSurface

__all__ = ["QUANTITIES", "RoverStage", "WheelStage", "first_look", "upright", "wheel_stage"]

FloatArray = NDArray[np.float64]
QUANTITIES = {
    "stress": ("von Mises stress", "MPa", 1e-6),
    "largest_principal": ("largest principal stress", "MPa", 1e-6),
    "smallest_principal": ("smallest principal stress", "MPa", 1e-6),
    "displacement": ("displacement", "mm", 1e3),
    "pressure": ("contact pressure", "MPa", 1e-6),
}
"""What the wheel can be coloured by: title, unit, factor from SI."""
_WHEEL_EYE = (0.42, -0.86, 0.29)
_ROVER_EYE = (-0.55, -1.0, 0.45)


@dataclass(frozen=True, kw_only=True, eq=False)
class WheelStage:
    """A wheel at one orientation on the ground: unloaded, and at the loads at which fields were kept.

    It is looked at with the ground below; its own frame (x forward, z up where 0 degrees face the ground) turns.

    Attributes
    ----------
    body : the same at all loads
    loads : (n,) [N], the first one 0
    fields : (n,)
    orientation : what faces the ground [deg]
    stands_on : that ground
    """

    body: WheelBody
    loads: tuple[float, ...]
    fields: tuple[WheelField, ...]
    orientation: float
    stands_on: Ground = field(default_factory=Ground)
    _bars: dict[str, ColourBar] = field(default_factory=dict)

    def values(self, number: int, quantity: str) -> FloatArray:
        """Of one load at the mesh's nodes [SI], where it is one of `numbers`."""
        values = self._known(number, quantity)
        assert values is not None
        return values

    def _known(self, number: int, quantity: str) -> FloatArray | None:
        now = self.fields[number]
        principal = now.principal_stress
        if quantity == "largest_principal":
            return None if principal is None else principal[:, 0]
        if quantity == "smallest_principal":
            return None if principal is None else principal[:, 2]
        if quantity == "pressure":
            return now.pressure
        return now.von_mises if quantity == "stress" else np.linalg.norm(now.displacement, axis=1)

    def numbers(self, quantity: str) -> tuple[int, ...]:
        """Loads at which it is known; the first is that of the unloaded wheel, 0."""
        return tuple(k for k in range(len(self.loads)) if self._known(k, quantity) is not None)

    @cached_property
    def quantities(self) -> tuple[str, ...]:
        """Those of `QUANTITIES` that are known at some load."""
        return tuple(name for name in QUANTITIES if len(self.numbers(name)) > 1)

    def bar(self, quantity: str) -> ColourBar:
        """One for all loads, so that they can be compared."""
        if quantity not in self._bars:
            fields = [self.values(k, quantity) for k in self.numbers(quantity)]
            self._bars[quantity] = colour_bar(*QUANTITIES[quantity], fields)
        return self._bars[quantity]

    def places(self, number: int, points: WheelPoints) -> FloatArray:
        """Of points of the wheel (n, 3) [m], in true scale, the ground below."""
        turned = self.stands_on.lean @ upright(self.orientation)
        places: FloatArray = (points.places + points.displacement(self.fields[number])) @ turned.T
        return places

    def show(
        self,
        scene: Scene,
        surface: WheelSurface,
        number: int,
        quantity: str,
        marked: NDArray[np.bool_] | None = None,
    ) -> None:
        """Put what is left of it into the scene, or only move what stands there; marked points (n,) as a warning."""
        if not scene.turn_to(self):
            scene.add_shape(self.ground(number))
        bar = self.bar(quantity)
        colours = bar.colours(self.values(number, quantity)[surface.nodes])
        if marked is not None:
            colours[marked] = rgb(bar.warning)
        scene.show_shape((self.places(number, surface), surface.quads), colours, self.ground(number))
        scene.show_ground(shown=quantity != "pressure")  # which lies under it

    def camera(self) -> Camera:
        """From the side and a little above, with the ground below."""
        return first_look(float(np.abs(self.body.places).max()))

    def ground(self, number: int) -> Quads:
        """The piece of it that the whole wheel touches."""
        return self.stands_on.under(self.places(number, self.body), self.body.faces[self.body.cells[:, 1] < 0])


def upright(orientation: float) -> FloatArray:
    """Rotation (3, 3) from the wheel's frame to one in which what faces the ground [deg] is below."""
    sin, cos = np.sin(np.radians(orientation)), np.cos(np.radians(orientation))
    return np.array([[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]])


def first_look(reach: float) -> Camera:
    """At a wheel of this size [m] from the side and a little above."""
    return Camera(eye=_unit(_WHEEL_EYE), up=(0.0, 0.0, 1.0), centre=(0.0, 0.0, 0.0), half_height=1.35 * reach)


def wheel_stage(
    orientation: float,
    files: Sequence[tuple[float, Path]],
    points: Path | None = None,
    pressures: Path | None = None,
    ground: Ground | None = None,
) -> WheelStage:
    """Read the fields of one orientation [deg] at loads [N] in increasing order.

    Parameters
    ----------
    orientation : what faces the ground [deg]
    files : loads [N] with their files, one at least; the first gives the mesh
    points : fields at the points of the curve, which are shown with them
    pressures : contact pressures at loads
    ground : what the wheel stands on; None is level

    Raises
    ------
    InputError
        For a file that cannot be used.
    """
    read = [(load, *read_fields(path)) for load, path in files]
    _, body, first = read[0]
    nothing = 0.0 * first.von_mises
    still = WheelField(
        displacement=0.0 * first.displacement,
        von_mises=nothing,
        principal_stress=0.0 * first.displacement,
        pressure=nothing,
    )
    shown = {load: field for load, _, field in read}
    if points is not None:
        along = {load: WheelField(displacement=u, von_mises=s) for load, u, s in read_points(points)}
        if any(len(field.von_mises) != len(still.von_mises) for field in along.values()):
            rule = f"must hold the {len(still.von_mises)} nodes of the mesh"
            raise InputError("field file", points, rule, "run the report again, or take the file out of the folder")
        shown = along | shown
    if pressures is not None:
        shown = _with_pressures(shown, pressures)
    loads = sorted(shown)
    return WheelStage(
        body=body,
        loads=(0.0, *loads),
        fields=(still, *(shown[load] for load in loads)),
        orientation=orientation,
        stands_on=ground or Ground(),
    )


class RoverStage:
    """A rover's recorded motion."""

    def __init__(self, path: Path) -> None:
        self.motion: RecordedMotion = read_motion(path)
        tire, vectors = self.motion.tire, self.motion.vectors
        self._tire = None if tire is None else drawn_tire(tire, vectors.shape[2])

    @property
    def times(self) -> FloatArray:
        """Of the frames (n,) [s]."""
        return self.motion.times

    @cached_property
    def tires(self) -> StrainedTires | None:
        """ANCF tires in all frames, coloured by strain; None on other tires."""
        return None if self._tire is None else strained_tires(self._tire, self.motion.vectors)

    def bar(self) -> dict[str, object] | None:
        """Of the strain, if tires are coloured by it."""
        if self.tires is None:
            return None
        bar = ColourBar(
            title="largest principal strain", unit="%", factor=100.0, end=self.tires.end, stops=STRAIN_COLOURS
        )
        return bar.shown(self.tires.largest)

    def show(self, scene: Scene, frame: int) -> None:
        """Put one frame into the scene, or move what stands there."""
        surfaces = self.tires.surfaces if self.tires else ()
        if not scene.turn_to(self):
            tires = [((one.points[frame], one.quads), one.colours[frame]) for one in surfaces]
            scene.add_solids(self.motion.solids, tires)
        moved = [(one.points[frame], one.colours[frame]) for one in surfaces]
        scene.move_solids(self.motion.positions[frame], self.motion.rotations[frame], moved)

    def camera(self) -> Camera:
        """From the right, behind and above, wide enough for the whole motion; up is against gravity."""
        r, R = self.motion.positions, self.motion.rotations
        moments = sorted({0, len(r) // 2, len(r) - 1})
        points = np.concatenate([one.placed(r[k], R[k]) for one in self.motion.solids for k in moments])
        up = self.motion.up / np.linalg.norm(self.motion.up)
        ahead = np.array([1.0, 0.0, 0.0]) - up[0] * up
        ahead /= np.linalg.norm(ahead)
        eye = np.array(_unit(_ROVER_EYE)) @ np.array([ahead, np.cross(up, ahead), up])
        across = np.cross(up, eye) / np.linalg.norm(np.cross(up, eye))
        above = np.cross(eye, across)
        low, high = points.min(axis=0), points.max(axis=0)
        seen = points @ np.array([across, above]).T
        half = 0.62 * max(np.ptp(seen[:, 1]), np.ptp(seen[:, 0]) / 1.5)
        return Camera(eye=_three(eye), up=_three(up), centre=_three(0.5 * (low + high)), half_height=float(half))


def _with_pressures(shown: Mapping[float, WheelField], path: Path) -> dict[float, WheelField]:
    """Fields by load [N] with the contact pressures at those loads that have one."""
    found = read_pressures(path)
    for load, known in shown.items():
        if load in found and found[load].shape != known.von_mises.shape:
            rule = f"must hold the {len(known.von_mises)} nodes of the mesh"
            raise InputError("pressure file", path, rule, "run the report again, or take the file out of the folder")
    return {load: replace(known, pressure=found.get(load)) for load, known in shown.items()}


def _unit(vector: tuple[float, float, float]) -> tuple[float, float, float]:
    return _three(np.array(vector) / np.linalg.norm(vector))


def _three(vector: FloatArray) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z
