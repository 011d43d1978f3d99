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
from workbench.viewer.charts import curves_chart, quantities, series_chart
from workbench.viewer.first_state import first_state
from workbench.viewer.folder import spoken
from workbench.viewer.names import plain
from workbench.viewer.scene import Scene
from workbench.viewer.stages import QUANTITIES, Results, RoverStage, WheelStage

__all__ = ["SPEEDS", "Session"]

_LOAD_SHOWN = 0.9
"""Longest time a load is shown while they are played [s]."""
_PLAYED = 4.0
"""Time in which many loads are played [s]."""
_PATIENCE = 1.0
"""Longest wait for the browser to have drawn a frame [s]."""
_MOST_OWN = 50
"""Curves that a window may be given."""
SPEEDS = (0.1, 0.5, 1, 2, 5, 10)
"""At which a rover may be played, those of ``page.html``."""


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
        self.wheel: WheelStage | None = None
        self.rover: RoverStage | None = None
        self.drawn = asyncio.Event()

    def renew(self) -> None:
        """Forget what the last window did; the scene stays, and with it the addresses the browsers know."""
        self.curves, self.own = dict(self.folder.curves), []
        self.wheel = self.rover = None
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
        self.draw_curves()
        self.look()

    def wheel_models(self) -> list[str]:
        """Models with fields."""
        return [one["value"] for one in self.state.models]

    def quantities(self) -> list[str]:
        """What the wheel can be coloured by."""
        return [one["value"] for one in self.state.quantities]

    def open_wheel(self) -> None:
        """Another model or orientation: its loads, and the largest of them. Nothing while the rover is looked at."""
        state = self.state
        if state.tab != "wheel" or not self.wheel_models():
            return
        state.orientations = sorted({one.orientation for one in self.folder.fields if one.model == state.model})
        if state.orientation not in state.orientations:
            state.orientation = state.orientations[0]
        self.wheel = self.results.wheels[state.model, float(state.orientation)]
        state.loads = [float(f"{load:.4g}") for load in self.wheel.loads]
        state.load = state.frame = state.last_frame = len(state.loads) - 1
        state.quantities = [{"value": name, "text": QUANTITIES[name][0]} for name in self.wheel.quantities]
        if state.quantity not in self.wheel.quantities:
            state.quantity = "stress"
        state.probe = None
        self.scene.mark(None, 0.0)
        self._show_wheel()
        self.draw_curves()

    def show_load(self) -> None:
        """Another load or colour on the wheel that stands there; a probed point keeps its node."""
        if self.wheel is not None and self.state.tab == "wheel":
            self._show_wheel()
            if self.state.probe:
                self._tell(self.state.probe["point"], self.state.probe["tag"])
            self.draw_curves()

    def _show_wheel(self) -> None:
        assert self.wheel is not None
        state, number = self.state, int(self.state.load)
        self.wheel.show(self.scene, number, state.quantity)
        values = self.wheel.values(number, state.quantity)
        state.bar = self.wheel.bar(state.quantity).shown(float(values.max()))
        state.moment = f"{self.wheel.loads[number]:.4g} N"
        state.caption = f"{spoken(state.model)}, {state.orientation:g}° down, {state.moment}"
        if number == 0:
            state.caption += " (unloaded)"
        self.view.update()

    def open_rover(self) -> None:
        """Another scenario or kind of tires, from its start. Nothing while the wheel is looked at."""
        state = self.state
        if state.tab != "rover" or not self.folder.motions:
            return
        state.tires = [tire for scenario, tire in self.folder.motions if scenario == state.scenario]
        if state.tire not in state.tires:
            state.tire = state.tires[0]
        key = (state.scenario, state.tire)
        self.rover = self.results.rovers[key]
        state.last_frame, state.frame, state.bar = len(self.rover.times) - 1, 0, self.rover.bar()
        state.rover_title = plain(self.rover.motion.title)
        series = self.folder.series.get(key)
        state.series_choices = quantities(series) if series else {}
        if state.series not in state.series_choices:
            state.series = next(iter(state.series_choices), "")
        lasts = float(self.rover.times[-1] - self.rover.times[0])
        state.speed = min(SPEEDS, key=lambda speed: abs(np.log(lasts / speed / 12.0)))
        self._show_rover()
        self.draw_curves()

    def show_frame(self) -> None:
        """Another frame: a load of the wheel, or a moment of the rover."""
        if self.state.tab == "wheel":
            self.state.load = int(self.state.frame)
        elif self.rover is not None:
            self._show_rover()

    def _show_rover(self) -> None:
        assert self.rover is not None
        frame = int(self.state.frame)
        self.rover.show(self.scene, frame)
        self.state.cursor = float(self.rover.times[frame])
        self.state.moment = f"{self.rover.times[frame]:.2f} of {self.rover.times[-1]:.2f} s"
        tires = "ANCF" if self.state.tire == "ancf" else self.state.tire
        self.state.caption = f"{self.state.scenario.replace('_', ' ')}, {tires} tires"
        self.view.update()

    def look(self) -> None:
        """The first view again."""
        stage = self.wheel if self.state.tab == "wheel" else self.rover
        if stage is not None:
            self.scene.look(stage.camera())
            self.view.update()
            self.view.push_camera()

    def probe(self, picked: dict[str, Any] | None) -> None:
        """Say what the wheel has where it was clicked; beside it, nothing."""
        if not picked or self.wheel is None or self.state.tab != "wheel":
            return
        places = self.wheel.places(int(self.state.load))
        found = self.wheel.surface.probe(places, np.array(picked["ray"], dtype=np.float64))
        if found is not None:
            self._tell(found.point, found.part)

    def _tell(self, point: int, tag: int) -> None:
        assert self.wheel is not None
        state, surface, number = self.state, self.wheel.surface, int(self.state.load)
        node, bar = int(surface.nodes[point]), self.wheel.bar(state.quantity)
        names = self.folder.parts_of(state.model, float(state.orientation))
        moved = surface.displacement(self.wheel.fields[number])[point]
        state.probe = {
            "point": point,
            "tag": tag,
            "title": QUANTITIES[state.quantity][0],
            "value": bar.text(float(self.wheel.values(number, state.quantity)[node])),
            "part": plain(names[tag - 1].replace("_", " ")) if 1 <= tag <= len(names) else f"hub (part {tag})",
            "node": node,
            "place": _millimetres(surface.places[point]),
            "moved": _millimetres(moved),
        }
        radius = 0.022 * float(np.abs(surface.places).max())
        self.scene.mark(self.wheel.places(number)[point], radius)
        self.view.update()

    def draw_curves(self) -> None:
        """The chart below the scene."""
        state = self.state
        if state.tab == "rover":
            series = self.folder.series.get((state.scenario, state.tire))
            state.figure = series_chart(series, state.series) if series and state.series else None
            return
        state.cursor = None
        chosen = {name: self.curves[name] for name in state.chosen if name in self.curves}
        shown, name = None, f"{state.model}_phi{float(state.orientation):03g}"
        if self.wheel is not None and name in self.curves:
            curve, load = self.curves[name], self.wheel.loads[int(state.load)]
            chosen.setdefault(name, curve)
            shown = (f"{load:.4g} N", float(np.interp(load, curve.load, curve.deflection)), load)
        state.figure = curves_chart(chosen, self.own, shown)

    def add_curve(self, name: str, text: str) -> None:
        """Overlay a user's curve; one that cannot be used is refused in words."""
        state = self.state
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "curve.csv"
            path.write_text(text, encoding="utf-8")
            try:
                path.write_text(in_si(path), encoding="utf-8")
                curve = read_curve(path)
            except InputError as error:
                state.message = f"{plain(name)}: {plain(error.rule)}; {plain(error.hint)}"
                return
        name = plain(name)
        full = name not in self.own and len(self.own) >= _MOST_OWN
        state.message = f"{name}: {_MOST_OWN} curves are enough; reload the page to begin anew" if full else ""
        if full:
            return
        self.curves[name] = curve
        if name not in self.own:
            self.own.append(name)
            state.curves = [*state.curves, {"value": name, "text": name}]
        state.chosen = [*(one for one in state.chosen if one != name), name]
        self.draw_curves()

    async def play(self) -> None:
        """Step through the loads, or through the motion by the clock, as fast as the browser draws."""
        state = self.state
        if state.frame >= state.last_frame:
            state.frame = -1 if state.tab == "wheel" else 0
        begun, first = time.monotonic(), max(int(state.frame), 0)
        pause = min(_LOAD_SHOWN, _PLAYED / (state.last_frame + 1))
        while state.playing and state.frame < state.last_frame:
            self.drawn.clear()
            with state:
                state.frame = self._due(first, time.monotonic() - begun)
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self.drawn.wait(), _PATIENCE)
            await asyncio.sleep(pause if state.tab == "wheel" else 0.03)
        with state:
            state.playing = False

    def _due(self, first: int, elapsed: float) -> int:
        """Number of the frame to show."""
        if self.state.tab == "wheel" or self.rover is None:
            return int(self.state.frame) + 1
        times = self.rover.times
        moment = times[first] + elapsed * float(self.state.speed)
        return int(np.clip(np.searchsorted(times, moment), self.state.frame + 1, len(times) - 1))


def _millimetres(vector: Any) -> str:
    return ", ".join(f"{1e3 * x:.2f}" for x in vector) + " mm"
