"""The page: trame's server with our template, script and scene. The one module that imports trame.

Verified by tests/end_to_end/test_view.py.
"""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

from trame.app import get_server  # type: ignore[import-untyped]
from trame.ui.html import DivLayout  # type: ignore[import-untyped]
from trame.widgets import vtk  # type: ignore[import-untyped]

from workbench.viewer.first_state import first_state
from workbench.viewer.results import Results
from workbench.viewer.scene import Scene
from workbench.viewer.session import Session
from workbench.viewer.window import Window

__all__ = ["open_page"]

_HERE = Path(__file__).parent
_TURNING = [
    {"button": 1, "action": "Rotate"},
    {"button": 2, "action": "Pan"},
    {"button": 3, "action": "Zoom", "scrollEnabled": True},
    {"button": 1, "action": "Pan", "shift": True},
]


async def open_page(results: Results, secret: str, number: int) -> Window:
    """Another page with everything it needs from this machine, running and waiting for its browser.

    Each has a server, a state and a scene of its own, so that no window steers another.

    secret : what its browser says first
    number : unlike that of any other page
    """
    server: Any = get_server(f"workbench-view-{number}", client_type="vue3")
    plotly = importlib.util.find_spec("plotly")
    assert plotly is not None
    assert plotly.origin is not None
    static = {"workbench": str(_HERE / "static"), "plotly": str(Path(plotly.origin).parent / "package_data")}
    scripts, styles = ["plotly/plotly.min.js", "workbench/pictures.js", "workbench/viewer.js"], ["workbench/viewer.css"]
    server.enable_module({"serve": static, "scripts": scripts, "styles": styles, "vue_use": ["workbench"]})
    state, scene = server.state, Scene()
    state.update(first_state(results.folder))
    state.trame__title = f"{state.study} - wheel workbench"
    state.trame__favicon = ""
    with DivLayout(server) as layout:
        view = vtk.VtkLocalView(
            scene.window,
            ref="view",
            picking_modes=("['click']",),
            interactor_settings=("turning", _TURNING),
            click="trame.trigger('probe', [$event && { ray: $event.ray }])",
            after_scene_loaded="trame.trigger('drawn')",
        )
        view.add_child("<workbench-eye></workbench-eye>")
        layout.root.clear()
        layout.root.add_child((_HERE / "page.html").read_text(encoding="utf-8").replace("<!--scene-->", view.html))
    page = Window(server, Session(state, view, results, scene))
    _connect(server, page)
    server.controller.on_server_bind.add(page.bind)
    server.cli.parse_known_args = lambda *_: type(server.cli).parse_known_args(server.cli, [f"--authKey={secret}"])
    server.start(backend="generic", exec_mode="task", port=0, show_connection_info=False, disable_logging=True)
    await server.ready
    return page


def _connect(server: Any, page: Window) -> None:
    """Changes of the page's choices and its triggers to what the session does about them."""
    state, session = server.state, page.session
    for keys, action in (
        (("tab",), session.open),
        (("model", "orientation"), session.open_wheel),
        (("load", "quantity", "mark_yield"), session.show_load),
        (("visible", "cut_axis", "cut_step", "cut_other_side"), session.cut),
        (("scenario", "tire"), session.open_rover),
        (("mode_file",), session.open_modes),
        (("mode", "amplitude"), session.show_mode),
        (("frame",), session.show_frame),
        (("chosen", "series"), session.draw_curves),
    ):
        state.change(*keys)(_once_ready(server, action))

    def played(playing: bool, **_: Any) -> None:
        if playing and server.running:
            page.run(session.play())

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
