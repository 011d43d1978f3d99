"""Plotly's figures as vectors: each kind of trace leaves its mark, each title its unit."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.printed import draw, plain, values
from workbench.report.document import read_html


def _spec(figure: Any) -> Any:
    return read_html(figure_html(figure, "f")).figures["f"]


def _drawn(spec: Any, path: Path, *, whole_width: bool = True) -> str:
    draw(spec, path, whole_width=whole_width)
    return path.read_text(encoding="utf-8")


def test_arrays_are_read_as_plotly_writes_them() -> None:
    numbers = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
    field = {"dtype": "f8", "bdata": base64.b64encode(numbers.tobytes()).decode(), "shape": "2, 3"}
    assert np.array_equal(values(field), numbers)
    assert np.isnan(values([1.0, None])[1])


def test_text_loses_its_tags() -> None:
    assert plain("a<sub>2</sub><br>b &lt; c") == "a2\nb < c"


def test_every_kind_of_trace_is_drawn(tmp_path: Path) -> None:
    figure = empty_figure("deflection [mm]", "load [N]")
    empty = _drawn(_spec(figure), tmp_path / "empty.svg")
    x = np.array([1.0, 2.0, 4.0])
    lengths = [len(empty)]
    figure.add_scatter(x=x, y=x**2, name="a line", line={"color": "#0072b2", "dash": "dash"})
    lengths.append(len(_drawn(_spec(figure), tmp_path / "a.svg")))
    figure.add_scatter(
        x=x, y=x, name="points", mode="markers", marker={"symbol": "square-open"}, error_y={"type": "data", "array": x}
    )
    lengths.append(len(_drawn(_spec(figure), tmp_path / "b.svg")))
    figure.add_scatter(x=[1, 2, 2], y=[1, 1, 2], name="band", fill="toself", fillcolor="rgba(0, 1, 2, 0.2)")
    figure.add_hline(y=3.0, line={"dash": "dot", "color": "#123456"}, annotation={"text": "limit"})
    lengths.append(len(_drawn(_spec(figure), tmp_path / "c.svg")))
    assert lengths == sorted(set(lengths))
    text = (tmp_path / "c.svg").read_text(encoding="utf-8")
    assert "#0072b2" in text
    assert "#123456" in text


def test_log_axes_and_maps(tmp_path: Path) -> None:
    figure = empty_figure()
    figure.add_contour(x=[0, 1, 2], y=[0, 1], z=[[0, 1, 2], [1, 2, 4]], colorbar={"title": {"text": "load [N]"}})
    assert len(_drawn(_spec(figure), tmp_path / "map.svg", whole_width=False)) > 5000
    lines = empty_figure()
    lines.add_scatter(x=[1, 10, 100], y=[1e-3, 1e-2, 1.0], name="error")
    lines.update_xaxes(type="log", tickvals=[1, 10, 100])
    lines.update_yaxes(type="log", range=[-3, 0])
    assert "<svg" in _drawn(_spec(lines), tmp_path / "log.svg")


def test_the_same_figure_gives_the_same_file_up_to_its_names(tmp_path: Path) -> None:
    figure = empty_figure()
    figure.add_scatter(x=[1, 2], y=[1, 2], name="one")
    sizes = [len(_drawn(_spec(figure), tmp_path / f"{k}.svg")) for k in range(2)]
    assert sizes[0] == pytest.approx(sizes[1], rel=0.01)


def test_a_trace_it_cannot_draw_is_named(tmp_path: Path) -> None:
    """Otherwise an empty figure would stand in the document without a word."""
    figure = empty_figure()
    bare = len(_drawn(_spec(figure), tmp_path / "bare.svg"))
    figure.add_parcoords(dimensions=[{"label": "a", "values": [1, 2]}])
    assert len(_drawn(_spec(figure), tmp_path / "named.svg")) > bare + 1000
