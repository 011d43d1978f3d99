"""Figures of the rover's ANCF tires from close by. Verified by tests/unit/test_workbench_rover_closer.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from workbench.charts.curves import add_plain
from workbench.charts.interactive import empty_figure, figure_html, log_axis
from workbench.charts.palette import MODEL_COLOURS, ORIENTATION_COLOURS
from workbench.questions.rover_closer.results import GROUNDS, CloserLook

if TYPE_CHECKING:
    from workbench.study.model import Study

__all__ = ["closer_figures"]

_LOWEST = 1e-6
"""Amplitudes below this one are not drawn [m/s^2]."""


def closer_figures(study: Study, found: CloserLook) -> dict[str, str]:
    """HTML by name: pressure at each moment, strains, spectra."""
    return {
        **{f"closer_pressure_{k}": text for k, text in enumerate(_pressures(found))},
        "closer_strain": _strains(found),
        **{f"closer_spectrum_{ground}": _spectra(found, ground) for ground in GROUNDS},
    }


def _pressures(found: CloserLook) -> list[str]:
    """Contact points of one wheel from above, coloured by pressure; the same colours at all moments."""
    drawn, highest = [], float(found.pressure[:, 3].max(initial=1.0)) * 1e-3
    for k, one in enumerate(found.footprints):
        figure = empty_figure("ahead of the hub [mm]", "left of the hub [mm]")
        points = found.pressure[found.pressure[:, 0] == one["time"]]
        colours = {"color": 1e-3 * points[:, 3], "colorscale": "Viridis", "cmin": 0.0, "cmax": highest, "size": 13}
        bar = {"title": {"text": "pressure [kPa]"}}
        figure.add_scatter(
            x=1e3 * points[:, 1],
            y=1e3 * points[:, 2],
            mode="markers",
            marker={**colours, "symbol": "square", "colorbar": bar},
            hovertemplate="%{marker.color:.1f} kPa<extra></extra>",
        )
        figure.update_xaxes(range=[-90.0, 90.0], rangemode="normal")
        figure.update_yaxes(range=[-75.0, 75.0], rangemode="normal")
        figure.update_layout(hovermode="closest", height=380)
        drawn.append(figure_html(figure, f"closer-pressure-{k}"))
    return drawn


def _strains(found: CloserLook) -> str:
    figure = empty_figure("time [s]", "largest principal strain of each tire [%]")
    for k, (name, strain) in enumerate(found.strains.items()):
        line = {"color": ORIENTATION_COLOURS[k % 6], "width": 1.8, "dash": "dot" if "left" in name else "solid"}
        time = found.series["straight", "ancf"].time
        figure.add_scatter(x=time, y=100.0 * strain, name=name.replace("_", " "), mode="lines", line=line)
    figure.update_yaxes(rangemode="normal")
    return figure_html(figure, "closer-strain")


def _spectra(found: CloserLook, ground: str) -> str:
    """Amplitude of the vertical acceleration of the first body on both tires."""
    figure = empty_figure("frequency [Hz]", "vertical acceleration of the body [m/s²]")
    for words, tire, one in found.vibrations:
        if words == GROUNDS[ground]:
            seen = np.maximum(one.amplitude[1:], _LOWEST)
            add_plain(figure, one.frequency[1:], seen, f"{tire} tires", MODEL_COLOURS[tire], width=1.8)
    log_axis(figure)
    return figure_html(figure, f"closer-spectrum-{ground}")
