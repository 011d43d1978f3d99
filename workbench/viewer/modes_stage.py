"""A wheel that swings in one of its modes. Verified by tests/unit/test_viewer_modes.py."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from workbench.viewer.colours import ColourBar
from workbench.viewer.folder import ModesFile
from workbench.viewer.mode_shapes import read_modes
from workbench.viewer.scene import Camera, Scene
from workbench.viewer.stages import first_look, upright

__all__ = ["FRAMES", "ModesStage"]

FRAMES = 20
"""Of one turn of the swing."""


class ModesStage:
    """Modes of one wheel in one state, drawn with what faces the ground below.

    A mode has no size of its own: it is drawn with a chosen largest displacement.
    """

    def __init__(self, file: ModesFile) -> None:
        self.found, self.title, self.orientation = read_modes(file), file.title, file.orientation

    def bar(self) -> dict[str, object]:
        """Of the displacement over the largest one."""
        return self._bar.shown(1.0) | {"above": ""}

    @property
    def _bar(self) -> ColourBar:
        return ColourBar(title="moves by", unit="% of the largest", factor=100.0, end=1.0)

    def places(self, number: int, amplitude: float, frame: int) -> NDArray[np.float64]:
        """Of the surface's points (n, 3) [m]; amplitude is the largest displacement over the wheel's radius [-]."""
        surface = self.found.surface
        size = amplitude * self._radius * np.sin(2.0 * np.pi * frame / FRAMES)
        places: NDArray[np.float64] = surface.places + size * self.found.displacement(number)
        return places @ upright(self.orientation).T

    def show(self, scene: Scene, number: int, amplitude: float, frame: int) -> None:
        """Put it into the scene, or move what stands there."""
        if not scene.turn_to(self):
            scene.add_shape(None)
        colours = self._bar.colours(np.linalg.norm(self.found.displacement(number), axis=1))
        scene.show_shape((self.places(number, amplitude, frame), self.found.surface.quads), colours, None)

    def camera(self) -> Camera:
        """As of a wheel on the ground."""
        return first_look(self._radius)

    @property
    def _radius(self) -> float:
        return float(np.hypot(self.found.surface.places[:, 0], self.found.surface.places[:, 2]).max())
