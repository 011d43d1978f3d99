"""What the choices about the wheel do: another wheel, load, colour, cut, or a point that was clicked.

Verified by tests/end_to_end/test_view.py.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from workbench.viewer.folder import spoken
from workbench.viewer.names import plain
from workbench.viewer.results import Results
from workbench.viewer.scene import Scene
from workbench.viewer.stages import QUANTITIES, WheelStage
from workbench.viewer.wheel_body import Cut
from workbench.viewer.wheel_surface import WheelSurface
from workbench.viewer.yielding import above_yield, legend, marked_share

__all__ = ["WheelTab"]


class WheelTab:
    """The wheel in one window.

    Attributes
    ----------
    stage : the wheel that is shown, if any
    """

    def __init__(self, state: Any, view: Any, results: Results, scene: Scene) -> None:
        self.state, self.view, self.results, self.scene = state, view, results, scene
        self.folder = results.folder
        self.stage: WheelStage | None = None
        self._surface: WheelSurface | None = None
        self._numbers: tuple[int, ...] = ()

    @property
    def load(self) -> float:
        """On the wheel that is shown [N]."""
        assert self.stage is not None
        return self.stage.loads[self._number]

    @property
    def _number(self) -> int:
        """Of the load among those of the stage; the page counts those at which the quantity is known."""
        return self._numbers[int(self.state.load)]

    def _offer_loads(self, load: float) -> None:
        """Those at which the quantity is known; the nearest to ``load`` [N] where they change."""
        assert self.stage is not None
        state, numbers = self.state, self.stage.numbers(self.state.quantity)
        if numbers == self._numbers:
            return
        loads = np.array([self.stage.loads[k] for k in numbers])
        self._numbers, state.last_frame = numbers, len(numbers) - 1
        state.loads = [float(f"{one:.4g}") for one in loads]
        state.load = state.frame = int(np.argmin(np.abs(loads - load)))

    @property
    def models(self) -> list[str]:
        """Models with fields."""
        return [one["value"] for one in self.state.models]

    def open(self) -> None:
        """Another model or orientation: its loads, and the largest of them."""
        state = self.state
        state.orientations = sorted({one.orientation for one in self.folder.fields if one.model == state.model})
        if state.orientation not in state.orientations:
            state.orientation = state.orientations[0]
        self.stage = self.results.wheels[state.model, float(state.orientation)]
        state.quantities = [{"value": name, "text": QUANTITIES[name][0]} for name in self.stage.quantities]
        if state.quantity not in self.stage.quantities:
            state.quantity = "stress"
        self._numbers = ()
        self._offer_loads(self.stage.loads[-1])
        parts = [{"value": tag, "text": self._part(tag)} for tag in np.unique(self.stage.body.parts).tolist()]
        if parts != state.parts:
            state.parts, state.visible = parts, [one["value"] for one in parts]
        state.yields = bool(self.folder.strengths_of(state.model, float(state.orientation)))
        self._forget_probe()
        self.cut()

    def cut(self) -> None:
        """Take away other parts, or another side of the plane; a probed point stays if it is still seen."""
        if self.stage is None:
            return
        state = self.state
        hidden = frozenset(one["value"] for one in state.parts) - frozenset(state.visible)
        cut = Cut(hidden=hidden, axis=state.cut_axis, step=int(state.cut_step), other_side=bool(state.cut_other_side))
        self._surface = self.stage.body.surface(cut)
        state.cut_text = f"{cut.axis} = {1e3 * self.stage.body.place(cut):.1f} mm" if cut.axis else ""
        self.show()

    def show(self) -> None:
        """Another load or colour on the wheel that stands there; a probed point keeps its node."""
        if self.stage is None or self._surface is None:
            return
        state = self.state
        self._offer_loads(self.load)
        state.legend = None
        number = self._number
        marked = self._marked() if state.mark_yield else None
        self.stage.show(self.scene, self._surface, number, state.quantity, marked)
        values = self.stage.values(number, state.quantity)
        state.bar = self.stage.bar(state.quantity).shown(float(values.max()), float(values.min()))
        state.moment = f"{self.stage.loads[number]:.4g} N"
        state.caption = f"{spoken(state.model)}, {state.orientation:g}° down, {state.moment}"
        if number == 0:
            state.caption += " (unloaded)"
        if words := self.stage.stands_on.words:
            state.caption += f", {words}"
        if not len(self._surface.quads):
            state.caption += ": nothing left of it"
        if state.probe:
            self._tell(state.probe["point"], state.probe["tag"])
        self.view.update()

    def _marked(self) -> NDArray[np.bool_] | None:
        """Points of the surface above yield, with their legend; None where no strength is known."""
        assert self.stage is not None
        assert self._surface is not None
        state, names = self.state, {one["value"]: one["text"] for one in self.state.parts}
        strengths = self.folder.strengths_of(state.model, float(state.orientation))
        seen = {tag: strengths[tag] for tag in state.visible if tag in strengths}
        if not seen:
            return None
        marked = above_yield(self._surface, self.stage.fields[self._number].von_mises, seen)
        text = legend({names[tag]: value for tag, value in seen.items()}, marked_share(self._surface, marked))
        state.legend = {"colour": self.stage.bar(state.quantity).warning, "text": text}
        return marked

    def probe(self, ray: Any) -> None:
        """Say what the wheel has where a ray (2, 3) [m] meets it; beside it, nothing."""
        if self.stage is None or self._surface is None:
            return
        places = self.stage.places(self._number, self._surface)
        found = self._surface.probe(places, np.array(ray, dtype=np.float64))
        if found is not None:
            self._tell(found.point, found.part)
            self.view.update()

    def _tell(self, point: int, tag: int) -> None:
        assert self.stage is not None
        assert self._surface is not None
        state, surface, number = self.state, self._surface, self._number
        index = surface.index(point)
        if index is None:
            self._forget_probe()
            return
        node, moved = int(surface.nodes[index]), surface.displacement(self.stage.fields[number])[index]
        state.probe = {
            "point": point,
            "tag": tag,
            "title": QUANTITIES[state.quantity][0],
            "value": self.stage.bar(state.quantity).text(float(self.stage.values(number, state.quantity)[node])),
            "part": self._part(tag),
            "node": node,
            "place": _millimetres(surface.places[index]),
            "moved": _millimetres(moved),
        }
        radius = 0.022 * float(np.abs(self.stage.body.places).max())
        self.scene.mark(self.stage.places(number, surface)[index], radius)

    def _forget_probe(self) -> None:
        self.state.probe = None
        self.scene.mark(None, 0.0)

    def _part(self, tag: int) -> str:
        names = self.folder.parts_of(self.state.model, float(self.state.orientation))
        return plain(names[tag - 1].replace("_", " ")) if 1 <= tag <= len(names) else f"hub (part {tag})"


def _millimetres(vector: Any) -> str:
    return ", ".join(f"{1e3 * x:.2f}" for x in vector) + " mm"
