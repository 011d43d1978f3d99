"""What the page's state is before anything is chosen; its keys are those of ``page.html``.

Verified by tests/end_to_end/test_view.py.
"""

from __future__ import annotations

from typing import Any

from workbench.viewer.curve_groups import curve_choices
from workbench.viewer.folder import ReportFolder, spoken
from workbench.viewer.names import plain
from workbench.viewer.wheel_body import STEPS

__all__ = ["first_state"]


def first_state(folder: ReportFolder) -> dict[str, Any]:
    """Every key of the page, with nothing chosen yet but the curves that average a model."""
    models = sorted({one.model for one in folder.fields}, key=lambda name: (name != "fe", name))
    averages = [n for n in ("fe_average", "ancf_average", "brush_average") if n in folder.curves]
    scenarios = list(dict.fromkeys(scenario for scenario, _ in folder.motions))
    first = "straight" if "straight" in scenarios else next(iter(scenarios), "")
    return {
        "study": folder.study or plain(folder.path.name),
        "verdict": folder.status,
        "tab": "wheel" if models else "rover" if scenarios else "modes" if folder.modes else "wheel",
        "models": [{"value": name, "text": spoken(name)} for name in models],
        "model": models[0] if models else "",
        "orientations": [],
        "orientation": 0.0,
        "loads": [],
        "load": 0,
        "quantities": [],
        "quantity": "stress",
        "mark_yield": False,
        "yields": False,
        "legend": None,
        "parts": [],
        "visible": [],
        "cut_axis": "",
        "cut_step": STEPS // 2,
        "cut_other_side": False,
        "cut_text": "",
        "scenarios": scenarios,
        "scenario": first,
        "tires": [],
        "tire": "",
        "rover_title": "",
        "mode_files": [{"value": k, "text": one.title} for k, one in enumerate(folder.modes)],
        "mode_file": 0,
        "mode_choices": [],
        "mode": 0,
        "amplitude": 8,
        "series": "load_N",
        "series_choices": {},
        "curves": curve_choices(folder.curves),
        "chosen": averages or list(folder.curves)[:3],
        "probe": None,
        "message": "",
        "caption": "",
        "bar": None,
        "last_frame": 0,
        "frame": 0,
        "moment": "",
        "playing": False,
        "speed": 1,
        "figure": None,
        "cursor": None,
    }
