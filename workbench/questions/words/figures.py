"""The continuum's curves among those of the thesis' tires. Verified by tests/end_to_end/test_report.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

from workbench.charts.curves import add_line
from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import MODEL_COLOURS

if TYPE_CHECKING:
    from workbench.questions.words.results import Words
    from workbench.study.model import Study

__all__ = ["words_figures"]


def words_figures(study: Study, words: Words) -> dict[str, str]:
    """Thin: each orientation of the wheel; thick: the average by arc; the ANCF tire's curves and the brush line."""
    figure = empty_figure()
    for orientation, curve in words.fe.loaded.items():
        add_line(figure, curve, f"FE {orientation:g}°", MODEL_COLOURS["fe"], width=0.8)
    add_line(figure, words.average, "FE average by arc", MODEL_COLOURS["fe"], width=4.0)
    for i, (orientation, curve) in enumerate(words.ancf.loaded.items()):
        add_line(
            figure, curve, f"ANCF {orientation:g}°", MODEL_COLOURS["ancf"], width=2.0, dash=("dash", "dashdot")[i % 2]
        )
    add_line(figure, words.brush, "brush line", MODEL_COLOURS["brush"], width=2.0, dash="dot")
    return {"words": figure_html(figure, "words-curves")}
