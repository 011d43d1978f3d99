"""The page: trame's server with our template, script and scene. The one module that imports trame.

Verified by tests/end_to_end/test_view.py.
"""

from __future__ import annotations

import asyncio
import importlib.util
from pathlib import Path
from typing import Any

from trame.app import get_server  # type: ignore[import-untyped]
from trame.ui.html import DivLayout  # type: ignore[import-untyped]
from trame.widgets import vtk  # type: ignore[import-untyped]

from workbench.viewer.folder import ReportFolder
from workbench.viewer.scene import Scene
from workbench.viewer.session import Session, initial_state

__all__ = ["build_page"]

_HERE = Path(__file__).parent
_TURNING = [
    {"button": 1, "action": "Rotate"},
    {"button": 2, "action": "Pan"},
    {"button": 3, "action": "Zoom", "scrollEnabled": True},
    {"button": 1, "action": "Pan", "shift": True},
]


def build_page(folder: ReportFolder) -> Any:
    """A server that is ready to start, with everything the page needs from this machine; raises InputError."""
    server: Any = get_server("workbench-view", client_type="vue3")
    plotly = importlib.util.find_spec("plotly")
    assert plotly is not None
    assert plotly.origin is not None
    static = {"workbench": str(_HERE / "static"), "plotly": str(Path(plotly.origin).parent / "package_data")}
    scripts, styles = ["plotly/plotly.min.js", "workbench/viewer.js"], ["workbench/viewer.css"]
    server.enable_module({"serve": static, "scripts": scripts, "styles": styles, "vue_use": ["workbench"]})
    state, scene = server.state, Scene()
    state.update(initial_state(folder))
    state.trame__title = f"{state.study} - wheel workbench"
    state.trame__favicon = ""
    session: list[Session] = []
    with DivLayout(server) as layout:
        view = vtk.VtkLocalView(
            scene.window,
            ref="view",
            picking_modes=("['click']",),
            interactor_settings=("turning", _TURNING),
            click="trame.trigger('probe', [$event && { ray: $event.ray }])",
            after_scene_loaded="trame.trigger('drawn')",
        )
        layout.root.clear()
        layout.root.add_child((_HERE / "page.html").read_text(encoding="utf-8").replace("<!--scene-->", view.html))
    session.append(Session(state, view, folder, scene))
    _connect(server, session[0])
    return server


def _connect(server: Any, session: Session) -> None:
    """Changes of the page's choices and its triggers to what the session does about them."""
    state = server.state
    tasks: set[asyncio.Task[None]] = set()
    for keys, action in (
        (("tab",), session.open),
        (("model", "orientation"), session.open_wheel),
        (("load", "quantity"), session.show_load),
        (("scenario", "tire"), session.open_rover),
        (("frame",), session.show_frame),
        (("chosen", "series"), session.draw_curves),
    ):
        state.change(*keys)(_once_ready(server, action))

    def played(playing: bool, **_: Any) -> None:
        if playing and server.running:
            task = asyncio.create_task(session.play())
            tasks.add(task)
            task.add_done_callback(tasks.discard)

    state.change("playing")(played)
    server.trigger("probe")(session.probe)
    server.trigger("look")(session.look)
    server.trigger("add_curve")(session.add_curve)
    server.trigger("drawn")(session.drawn.set)
    server.controller.on_server_ready.add(lambda **_: session.open())


def _once_ready(server: Any, action: Any) -> Any:
    """A listener that ignores the changes before the server runs."""

    def changed(**_: Any) -> None:
        if server.running:
            action()

    return changed
