"""What kind of motion a wheel's mode is, by who moves and how it goes around the wheel.

The rim's motion is split into radial, tangential and axial parts and each into waves around the axle. Verified by
tests/unit/test_workbench_modes.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.modes import DIRECTIONS
from workbench.questions.modes.mode_file import KeptModes

__all__ = ["KINDS", "ModeKind", "mode_kinds"]

Array = NDArray[np.float64]
RIM = ("tire", "tread", "grousers")
"""Parts that go around the wheel."""
HUB = ("outer_hub", "cone", "impact_springs", "inner_hub")
KINDS = {
    "rigid": "the wheel as a rigid body, hub and all",
    "torsional": "the rim turns about the axle against the hub",
    "shift": "the rim moves as a whole in its plane, up or ahead of the hub",
    "radial": "the rim bends in its plane, n waves around",
    "lateral": "the rim moves as a whole along the axle",
    "tilting": "the rim turns about a diameter, n = 1",
    "warping": "the rim bends out of its plane, n waves around",
    "springs": "springs move, the rim hardly",
}
_WAVES = 16
"""Most waves around that are told apart."""
_LEAST = 0.2
"""Share of the rim in the kinetic energy of rim and springs below which a mode is the springs'."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ModeKind:
    """Kind of a mode.

    Attributes
    ----------
    name : one of `KINDS`
    waves : around the axle, of the rim; 0 where all of it moves alike
    direction : of a rigid motion, one of `DIRECTIONS`; else empty
    part : that has most of the kinetic energy
    share : of the kinetic energy that it has [-]
    """

    name: str
    waves: int
    direction: str
    part: str
    share: float

    @property
    def words(self) -> str:
        """For a table."""
        if self.direction:
            return f"rigid {self.direction}"
        waves = f" n={self.waves}" if self.name in ("radial", "warping", "springs") else ""
        return self.name + waves


def mode_kinds(kept: KeptModes) -> list[ModeKind]:
    """The kind of each mode."""
    return [_kind(kept, i) for i in range(len(kept.modes.eigenvalue))]


def _kind(kept: KeptModes, number: int) -> ModeKind:
    modes = kept.modes
    energy = modes.weight * (modes.shape[number].astype(np.float64) ** 2).sum(axis=1)
    by_part = np.bincount(kept.part, weights=energy, minlength=len(kept.parts)) / energy.sum()
    most = int(by_part.argmax())
    name, waves, direction = _named(kept, number, energy)
    return ModeKind(name=name, waves=waves, direction=direction, part=kept.parts[most], share=float(by_part[most]))


def _named(kept: KeptModes, number: int, energy: Array) -> tuple[str, int, str]:
    """Name, waves and direction; energy : (n_points,) of the points."""
    modes = kept.modes
    if modes.rigid[number]:
        moved = modes.participation[number] ** 2 / np.maximum(modes.whole, np.finfo(float).tiny)
        return "rigid", 0, DIRECTIONS[int(moved.argmax())]
    rim, hub = (np.isin(kept.part, [k for k, name in enumerate(kept.parts) if name in group]) for group in (RIM, HUB))
    if energy[rim].sum() < _LEAST * energy[~hub].sum():
        return "springs", _waves(kept, number, np.ones(len(energy), dtype=bool))[0], ""
    waves, (radial, tangential, axial) = _waves(kept, number, rim)
    if axial > radial + tangential or modes.parity[number] == -1:
        return {0: "lateral", 1: "tilting"}.get(waves, "warping"), waves, ""
    if waves == 0:
        return "torsional" if tangential > radial else "radial", waves, ""
    return "shift" if waves == 1 else "radial", waves, ""


def _waves(kept: KeptModes, number: int, which: NDArray[np.bool_]) -> tuple[int, tuple[float, float, float]]:
    """Waves around that carry most of some points' motion, and how much of them is radial, tangential, axial."""
    points, weight = kept.modes.points[which], kept.modes.weight[which]
    shape = kept.modes.shape[number, which].astype(np.float64)
    angle = np.arctan2(points[:, 0], -points[:, 2])
    out = np.stack([np.sin(angle), 0.0 * angle, -np.cos(angle)], axis=1)
    around = np.stack([np.cos(angle), 0.0 * angle, np.sin(angle)], axis=1)
    parts = np.stack([(shape * out).sum(axis=1), (shape * around).sum(axis=1), shape[:, 1]])
    sides = [np.ones(len(angle))] if kept.half else [np.ones(len(angle)), np.sign(points[:, 1])]
    turns = np.exp(-1j * np.outer(np.arange(_WAVES + 1), angle)) * weight / weight.sum()
    power = np.sum([np.abs(turns @ (parts * side).T) ** 2 for side in sides], axis=0)
    power[1:] *= 2.0
    waves = int(power.sum(axis=1).argmax())
    radial, tangential, axial = (float(value) for value in power[waves])
    return waves, (radial, tangential, axial)
