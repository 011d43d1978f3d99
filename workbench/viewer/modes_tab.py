"""What the choices about modes do: another wheel, mode or amplitude, another moment of its turn.

Verified by tests/end_to_end/test_view.py.
"""

from __future__ import annotations

from typing import Any

from workbench.viewer.modes_stage import FRAMES, ModesStage
from workbench.viewer.results import Results
from workbench.viewer.scene import Scene

__all__ = ["AMPLITUDES", "ModesTab"]

AMPLITUDES = range(1, 31)
"""Largest displacement as it is drawn [% of the wheel's radius], those of ``page.html``."""


class ModesTab:
    """Modes in one window.

    Attributes
    ----------
    stage : the wheel whose modes are shown, if any
    """

    def __init__(self, state: Any, view: Any, results: Results, scene: Scene) -> None:
        self.state, self.view, self.results, self.scene = state, view, results, scene
        self.stage: ModesStage | None = None

    def open(self) -> None:
        """Another wheel or state, with its first mode that is no rigid motion, at the end of its swing."""
        state = self.state
        self.stage = self.results.modes[int(state.mode_file)]
        modes = self.stage.found.modes
        state.mode_choices = [{"value": k, "text": f"{k + 1}: {one.words}"} for k, one in enumerate(modes)]
        state.mode = next((k for k, one in enumerate(modes) if one.frequency > 0.0), 0)
        state.last_frame, state.frame, state.cursor, state.legend = FRAMES - 1, FRAMES // 4, None, None
        state.bar = self.stage.bar()
        self.show()

    def show(self) -> None:
        """Another mode, amplitude or moment."""
        if self.stage is None:
            return
        state, frame = self.state, int(self.state.frame)
        self.stage.show(self.scene, int(state.mode), 0.01 * int(state.amplitude), frame)
        state.moment = f"{360.0 * frame / FRAMES:.0f}° of a turn"
        words = self.stage.found.modes[int(state.mode)].words
        state.caption = f"{self.stage.title}\nmode {int(state.mode) + 1}: {words}"
        self.view.update()
