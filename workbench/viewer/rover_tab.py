"""What the choices about the rover do: another motion, another moment of it.

Verified by tests/end_to_end/test_view.py.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from workbench.viewer.charts import quantities
from workbench.viewer.names import plain
from workbench.viewer.results import Results
from workbench.viewer.scene import Scene
from workbench.viewer.stages import RoverStage

__all__ = ["SPEEDS", "RoverTab"]

SPEEDS = (0.1, 0.5, 1, 2, 5, 10)
"""At which a rover may be played, those of ``page.html``."""


class RoverTab:
    """The rover in one window.

    Attributes
    ----------
    stage : the motion that is shown, if any
    """

    def __init__(self, state: Any, view: Any, results: Results, scene: Scene) -> None:
        self.state, self.view, self.results, self.scene = state, view, results, scene
        self.folder = results.folder
        self.stage: RoverStage | None = None

    def open(self) -> None:
        """Another scenario or kind of tires, from its start."""
        state = self.state
        state.tires = [tire for scenario, tire in self.folder.motions if scenario == state.scenario]
        if state.tire not in state.tires:
            state.tire = state.tires[0]
        key = (state.scenario, state.tire)
        self.stage = self.results.rovers[key]
        times = self.stage.times
        state.last_frame, state.frame, state.bar = len(times) - 1, 0, self.stage.bar()
        state.rover_title = plain(self.stage.motion.title)
        series = self.folder.series.get(key)
        state.series_choices = quantities(series) if series else {}
        if state.series not in state.series_choices:
            state.series = next(iter(state.series_choices), "")
        lasts = float(times[-1] - times[0])
        state.speed = min(SPEEDS, key=lambda speed: abs(np.log(lasts / speed / 12.0)))
        self.show()

    def show(self) -> None:
        """Another moment."""
        if self.stage is None:
            return
        frame, times = int(self.state.frame), self.stage.times
        self.stage.show(self.scene, frame)
        self.state.cursor = float(times[frame])
        self.state.moment = f"{times[frame]:.2f} of {times[-1]:.2f} s"
        tires = "ANCF" if self.state.tire == "ancf" else self.state.tire
        self.state.caption = f"{self.state.scenario.replace('_', ' ')}, {tires} tires"
        self.view.update()

    def due(self, first: int, elapsed: float) -> int:
        """Number of the frame to show ``elapsed`` [s] after the first was played."""
        assert self.stage is not None
        times = self.stage.times
        moment = times[first] + elapsed * float(self.state.speed)
        return int(np.clip(np.searchsorted(times, moment), self.state.frame + 1, len(times) - 1))
