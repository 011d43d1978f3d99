"""What the page's choices do: they move the scene, redraw the charts, answer a probe, play.

``state`` is trame's, shared with the page; its keys are those of ``page.html``. Verified by
tests/end_to_end/test_view.py.
"""

from __future__ import annotations

import asyncio
import contextlib
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from contracts.curves import StiffnessCurve, read_curve
from contracts.errors import InputError
from workbench.study.curve_file import in_si
from workbench.viewer.charts import curves_chart, modes_chart, series_chart
from workbench.viewer.curve_groups import OWN
from workbench.viewer.first_state import first_state
from workbench.viewer.modes_stage import FRAMES
from workbench.viewer.modes_tab import ModesTab
from workbench.viewer.names import plain
from workbench.viewer.results import Results
from workbench.viewer.rover_tab import RoverTab
from workbench.viewer.scene import Scene
from workbench.viewer.wheel_tab import WheelTab

__all__ = ["Session"]

_LOAD_SHOWN = 0.9
"""Longest time a load is shown while they are played [s]."""
_PLAYED = 4.0
"""Time in which many loads are played [s]."""
_SWING = 1.6
"""Shortest time in which a mode is played through one turn [s]."""
_PATIENCE = 1.0
"""Longest wait for the browser to have drawn a frame [s]."""
_MOST_OWN = 50
"""Curves that a window may be given."""


class Session:
    """One window on one folder.

    Parameters
    ----------
    state : trame's, of this window alone
    view : the page's 3D view: ``update()``, ``push_camera()``
    results : what is shown, shared by all windows
    scene : where it is shown
    """

    def __init__(self, state: Any, view: Any, results: Results, scene: Scene) -> None:
        self.state, self.view, self.results, self.scene = state, view, results, scene
        self.folder = results.folder
        self.curves: dict[str, StiffnessCurve] = dict(self.folder.curves)
        self.own: list[str] = []
        self.wheel = WheelTab(state, view, results, scene)
        self.rover = RoverTab(state, view, results, scene)
        self.modes = ModesTab(state, view, results, scene)
        self.drawn = asyncio.Event()

    def renew(self) -> None:
        """Forget what the last window did; the scene stays, and with it the addresses the browsers know."""
        self.curves, self.own = dict(self.folder.curves), []
        self.wheel.stage = self.rover.stage = self.modes.stage = None
        self.scene.mark(None, 0.0)
        with self.state:
            self.state.update(first_state(self.folder))
        with self.state:
            self.open()

    def open(self) -> None:
        """Show what the tab is about, from its first view."""
        self.state.playing = False
        self.open_wheel()
        self.open_rover()
        self.open_modes()
        self.draw_curves()
        self.look()

    def open_wheel(self) -> None:
        """Another model or orientation. Nothing while something else is looked at."""
        if self.state.tab == "wheel" and self.wheel.models:
            self.wheel.open()
            self.draw_curves()

    def cut(self) -> None:
        """Other parts, or another cut through the wheel."""
        if self.state.tab == "wheel":
            self.wheel.cut()

    def show_load(self) -> None:
        """Another load or colour on the wheel, or a mark."""
        if self.state.tab == "wheel":
            self.wheel.show()
            self.draw_curves()

    def open_rover(self) -> None:
        """Another scenario or kind of tires. Nothing while something else is looked at."""
        if self.state.tab == "rover" and self.folder.motions:
            self.state.legend = None
            self.rover.open()
            self.draw_curves()

    def open_modes(self) -> None:
        """Modes of another wheel. Nothing while something else is looked at."""
        if self.state.tab == "modes" and self.folder.modes:
            self.modes.open()
            self.draw_curves()

    def show_mode(self) -> None:
        """Another mode or amplitude."""
        if self.state.tab == "modes":
            self.modes.show()
            self.draw_curves()

    def show_frame(self) -> None:
        """Another frame: a load of the wheel, a moment of the rover or of a mode."""
        if self.state.tab == "wheel":
            self.state.load = int(self.state.frame)
        else:
            (self.rover if self.state.tab == "rover" else self.modes).show()

    def look(self) -> None:
        """The first view again."""
        tabs: dict[str, WheelTab | RoverTab | ModesTab] = {
            "wheel": self.wheel,
            "rover": self.rover,
            "modes": self.modes,
        }
        stage = tabs[self.state.tab].stage
        if stage is not None:
            self.scene.look(stage.camera())
            self.view.update()
            self.view.push_camera()

    def probe(self, picked: dict[str, Any] | None) -> None:
        """Say what the wheel has where it was clicked."""
        if picked and self.state.tab == "wheel":
            self.wheel.probe(picked["ray"])

    def draw_curves(self) -> None:
        """The chart below the scene."""
        state = self.state
        if state.tab == "rover":
            series = self.folder.series.get((state.scenario, state.tire))
            state.figure = series_chart(series, state.series) if series and state.series else None
            return
        state.cursor = None
        if state.tab == "modes":
            stage = self.modes.stage
            state.figure = modes_chart(stage.found.modes, int(state.mode)) if stage else None
            return
        chosen = {name: self.curves[name] for name in state.chosen if name in self.curves}
        shown, name = None, f"{state.model}_phi{float(state.orientation):03g}"
        if self.wheel.stage is not None and name in self.curves:
            curve, load = self.curves[name], self.wheel.load
            chosen.setdefault(name, curve)
            shown = (f"{load:.4g} N", float(np.interp(load, curve.load, curve.deflection)), load)
        state.figure = curves_chart(chosen, self.own, shown)

    def add_curve(self, name: str, text: str) -> None:
        """Overlay a user's curve; one that cannot be used is refused in words. A large file comes as no text."""
        state = self.state
        if not text:
            state.message = f"{plain(name)}: is empty, or larger than 1 MB; give fewer points"
            return
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "curve.csv"
            path.write_text(text, encoding="utf-8")
            try:
                path.write_text(in_si(path), encoding="utf-8")
                curve = read_curve(path)
            except InputError as error:
                state.message = f"{plain(name)}: {plain(error.rule)}; {plain(error.hint)}"
                return
        name = plain(name) + " (yours)" * (plain(name) in self.folder.curves)
        full = name not in self.own and len(self.own) >= _MOST_OWN
        state.message = f"{name}: {_MOST_OWN} curves are enough; reload the page to begin anew" if full else ""
        if full:
            return
        self.curves[name] = curve
        if name not in self.own:
            self.own.append(name)
            state.curves = [*state.curves, {"value": name, "text": name, "group": OWN}]
        state.chosen = [*(one for one in state.chosen if one != name), name]
        self.draw_curves()

    async def play(self) -> None:
        """Step through the loads, through the motion by the clock, or swing, as fast as the browser draws."""
        state = self.state
        if state.frame >= state.last_frame and state.tab != "modes":
            state.frame = -1 if state.tab == "wheel" else 0
        begun, first = time.monotonic(), max(int(state.frame), 0)
        pauses = {"wheel": min(_LOAD_SHOWN, _PLAYED / (state.last_frame + 1)), "rover": 0.03, "modes": _SWING / FRAMES}
        while state.playing and (state.frame < state.last_frame or state.tab == "modes"):
            self.drawn.clear()
            with state:
                state.frame = self._due(first, time.monotonic() - begun)
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self.drawn.wait(), _PATIENCE)
            await asyncio.sleep(pauses[state.tab])
        with state:
            state.playing = False

    def _due(self, first: int, elapsed: float) -> int:
        """Number of the frame to show."""
        if self.state.tab == "rover":
            return self.rover.due(first, elapsed)
        return (int(self.state.frame) + 1) % (int(self.state.last_frame) + 1)
