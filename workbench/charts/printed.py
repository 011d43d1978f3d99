"""The page's figures on paper: Plotly's numbers drawn as vectors.

Lines, markers, error bars, filled bands, maps of contours, coloured points, log axes, a second axis, lines and notes of
the layout; another kind of trace is named in the figure instead of drawn. Verified by
tests/unit/test_workbench_printed.py.
"""

from __future__ import annotations

import base64
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.text import for_matplotlib, plain_of_html
from workbench.charts.still_charts import blank_figure, red_green_blue

__all__ = ["draw", "plain", "values"]

Spec = Mapping[str, Any]
Axes = Any
Figure = Any
"""Of matplotlib, which `workbench.charts.still_charts` alone imports."""
_DASHES = {"dash": (0, (5, 2.5)), "dot": (0, (1.2, 1.6)), "dashdot": (0, (5, 2, 1.2, 2)), "longdash": (0, (9, 3)),
           "longdashdot": (0, (9, 2.5, 1.2, 2.5))}  # fmt: skip
_MARKERS = {"circle": "o", "square": "s", "diamond": "D", "triangle-up": "^", "cross": "P", "x": "X", "star": "*",
            "line-ns": "|"}  # fmt: skip
_EDGE = "#80868b"
_STYLE = {"size": 8.0, "grid": "#e4e7ea", "edge": _EDGE, "ink": "#1b1f23"}
_LEGEND_ROW = 0.17
_PER_ROW = {True: 100, False: 48}
"""Letters of a legend's row, on the whole width of the page or half of it."""


def draw(figure: Spec, path: Path, *, whole_width: bool) -> None:
    """Write one figure; the kind of file is that of the name (``.svg``, ``.pdf``).

    Parameters
    ----------
    figure : ``data`` and ``layout``, as Plotly writes them
    path : file to write
    whole_width : of the page, else half of it
    """
    data, layout = figure["data"], figure["layout"]
    labels = [plain(str(t["name"])) for t in data if t.get("name") and t.get("showlegend", True)]
    width, height = (6.9, 2.6) if whole_width else (3.35, 2.55)
    rows = _legend_rows(labels, _PER_ROW[whole_width]) if len(labels) > 1 else 0
    tall = height + _LEGEND_ROW * rows
    second_axis, bar = "yaxis2" in layout, any(_with_bar(trace) for trace in data)
    page = blank_figure(width, tall)
    right = 0.55 if second_axis else 0.7 if bar else 0.1
    axes = page.add_axes((0.6 / width, 0.45 / tall, 1.0 - (0.6 + right) / width, (height - 0.55) / tall))
    second = axes.twinx() if second_axis else None
    _style(axes, layout, second)
    missing = [_trace(second if second and t.get("yaxis") == "y2" else axes, t, page) for t in data]
    for shape in layout.get("shapes", ()):
        _shape(axes, shape)
    for note in layout.get("annotations", ()):
        _note(axes, note)
    _limits(axes, layout)
    if rows:
        _legend(page, [a for a in (axes, second) if a], labels, rows)
    if any(missing):
        words = ", ".join(sorted({m for m in missing if m}))
        axes.text(0.5, 0.5, f"{words}: see report.html", transform=axes.transAxes, ha="center", color=_STYLE["edge"])
    page.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else {"CreationDate": None})


def values(field: object) -> NDArray[np.float64]:
    """An array of Plotly's: a list, or base64 with its type and shape."""
    if isinstance(field, Mapping):
        raw = np.frombuffer(base64.b64decode(field["bdata"]), dtype=np.dtype(f"<{field['dtype']}"))
        shape = [int(n) for n in str(field.get("shape", len(raw))).split(",")]
        return raw.reshape(shape).astype(np.float64)
    return np.array([np.nan if v is None else v for v in field], dtype=np.float64)  # type: ignore[attr-defined]


def plain(text: str) -> str:
    """Text without the tags and entities Plotly allows; dollars are no formulas."""
    lines = re.split(r"<br\s*/?>", text)
    return "\n".join(for_matplotlib(plain_of_html(line)) for line in lines)


def _trace(axes: Axes, trace: Spec, page: Figure) -> str | None:
    """Draw one; the name of its kind if it cannot be drawn."""
    kind = trace.get("type", "scatter")
    if kind == "contour":
        _contour(axes, trace, page)
    elif kind != "scatter":
        return str(kind)
    elif trace.get("fill") == "toself":
        label = _label(trace)
        axes.fill(values(trace["x"]), values(trace["y"]), color=_colour(trace["fillcolor"]), lw=0, label=label)
    elif isinstance(trace.get("marker", {}).get("color"), list | dict):
        _coloured_points(axes, trace, page)
    else:
        _line(axes, trace)
    return None


def _with_bar(trace: Spec) -> bool:
    return trace.get("type") == "contour" or "colorbar" in trace.get("marker", {})


def _line(axes: Axes, trace: Spec) -> None:
    line, marker, mode = trace.get("line", {}), trace.get("marker", {}), trace.get("mode", "lines")
    symbol = str(marker.get("symbol", "circle"))
    colour = _colour(
        line.get("color") if "lines" in mode else marker.get("color"), line.get("color"), marker.get("color")
    )
    x, y = values(trace["x"]), values(trace["y"])
    own = _colour(marker.get("color"), colour)
    axes.errorbar(
        x,
        y,
        xerr=_error(trace.get("error_x")),
        yerr=_error(trace.get("error_y")),
        elinewidth=1.0,
        capsize=2.5,
        ecolor=_colour(trace.get("error_x", {}).get("color"), colour),
        color=colour,
        lw=0.55 * float(line.get("width", 2.0)) if "lines" in mode else 0.0,
        ls=_DASHES.get(line.get("dash", ""), "-") if "lines" in mode else "none",
        marker=_MARKERS.get(symbol.removesuffix("-open"), "o") if "markers" in mode else "none",
        ms=0.5 * float(marker.get("size", 6.0)),
        mfc="none" if symbol.endswith("-open") else own,
        mec=own,
        markevery=max(1, len(x) // int(marker["maxdisplayed"])) if marker.get("maxdisplayed") else None,
        alpha=trace.get("opacity"),
        label=_label(trace),
    )


def _coloured_points(axes: Axes, trace: Spec, page: Figure) -> None:
    marker = trace["marker"]
    points = axes.scatter(
        values(trace["x"]),
        values(trace["y"]),
        c=values(marker["color"]),
        vmin=marker.get("cmin"),
        vmax=marker.get("cmax"),
        cmap="viridis",
        marker=_MARKERS.get(str(marker.get("symbol", "circle")), "o"),
        s=0.3 * float(marker.get("size", 8.0)) ** 2,
        linewidths=0.0,
    )
    _colour_bar(page, points, axes, marker.get("colorbar", {}))


def _contour(axes: Axes, trace: Spec, page: Figure) -> None:
    x, y, z = (values(trace[name]) for name in "xyz")
    _colour_bar(page, axes.contourf(x, y, z, levels=12, cmap="viridis"), axes, trace.get("colorbar", {}))
    lines = axes.contour(x, y, z, levels=12, colors="white", linewidths=0.5)
    axes.clabel(lines, fontsize=6.5)


def _colour_bar(page: Figure, drawn: Any, axes: Axes, bar: Spec) -> None:
    box = axes.get_position()
    made = page.colorbar(drawn, cax=page.add_axes((box.x1 + 0.02, box.y0, 0.02, box.height)))
    made.set_label(_title(bar), size=_STYLE["size"])
    made.ax.tick_params(labelsize=7.0)
    made.outline.set_visible(False)


def _error(field: Spec | None) -> NDArray[np.float64] | None:
    return None if field is None else values(field["array"])


def _label(trace: Spec) -> str:
    """Name in the legend; names that begin with an underscore have no place there."""
    return plain(str(trace["name"])) if trace.get("name") and trace.get("showlegend", True) else "_"


def _colour(*candidates: object) -> Any:
    """The first that is a colour, as red, green, blue, opacity."""
    for one in candidates:
        if isinstance(one, tuple):
            return one
        if isinstance(one, str):
            found = re.fullmatch(r"rgba?\(([^)]*)\)", one.strip())
            if found:
                r, g, b, *alpha = (float(part) for part in found[1].split(","))
                return (r / 255.0, g / 255.0, b / 255.0, *(alpha or [1.0]))
            return red_green_blue(one)
    return red_green_blue(_EDGE)


def _title(axis: Spec) -> str:
    title = axis.get("title", "")
    return plain(str(title.get("text", "") if isinstance(title, Mapping) else title))


def _style(axes: Axes, layout: Spec, second: Axes | None) -> None:
    size, ink = _STYLE["size"], _STYLE["ink"]
    axes.grid(color=_STYLE["grid"], lw=0.6)
    axes.set_axisbelow(True)
    axes.set_xlabel(_title(layout.get("xaxis", {})), size=size, color=ink)
    axes.set_ylabel(_title(layout.get("yaxis", {})), size=size, color=ink)
    if second is not None:
        second.set_ylabel(_title(layout["yaxis2"]), size=size, color=ink)
    for one in [a for a in (axes, second) if a is not None]:
        one.tick_params(labelsize=7.0, color=_STYLE["edge"], labelcolor=ink)
        for side, spine in one.spines.items():
            spine.set_color(_STYLE["edge"])
            spine.set_visible(side in ("left", "bottom") or (side == "right" and one is second))


def _limits(axes: Axes, layout: Spec) -> None:
    """Kind and range of both axes; ranges of log axes are exponents, as Plotly's."""
    for name, scale, limits in (("xaxis", axes.set_xscale, axes.set_xlim), ("yaxis", axes.set_yscale, axes.set_ylim)):
        axis = layout.get(name, {})
        log = axis.get("type") == "log"
        if log:
            scale("log")
        if "range" in axis:
            low, high = (10.0**v if log else v for v in axis["range"])
            limits(low, high)
        elif not log and axis.get("rangemode") == "tozero":
            low, high = axes.get_xlim() if name == "xaxis" else axes.get_ylim()
            limits(low if low < -0.1 * abs(high) else 0.0, high)
        if "tickvals" in axis:
            drawn = axes.xaxis if name == "xaxis" else axes.yaxis
            drawn.set_ticks(axis["tickvals"], labels=[f"{v:g}" for v in axis["tickvals"]])
            drawn.set_ticks([], minor=True)


def _shape(axes: Axes, shape: Spec) -> None:
    """A line across the axes, or a rectangle behind the lines."""
    line = shape.get("line", {})
    if shape["type"] == "line" and str(shape.get("xref", "x")).endswith("domain"):
        axes.axhline(
            float(shape["y0"]), color=_colour(line.get("color")), lw=0.8, ls=_DASHES.get(line.get("dash", ""), "-")
        )
    elif shape["type"] == "line" and str(shape.get("yref", "y")).endswith("domain"):
        axes.axvline(
            float(shape["x0"]), color=_colour(line.get("color")), lw=0.8, ls=_DASHES.get(line.get("dash", ""), "-")
        )
    elif shape["type"] == "rect":
        x, y = [shape["x0"], shape["x1"]], [shape["y0"], shape["y1"]]
        axes.fill_between(x, y[0], y[1], color=_colour(shape.get("fillcolor")), lw=0, zorder=0.5)


def _note(axes: Axes, note: Spec) -> None:
    """Text at a place, in parts of the axes or in their numbers."""
    parts = [str(note.get(ref, "x")).endswith(("domain", "paper")) for ref in ("xref", "yref")]
    transform = {(True, False): axes.get_yaxis_transform(), (False, True): axes.get_xaxis_transform(),
                 (True, True): axes.transAxes, (False, False): axes.transData}[parts[0], parts[1]]  # fmt: skip
    across = {"left": "left", "right": "right"}.get(str(note.get("xanchor")), "center")
    up = {"bottom": "bottom", "top": "top"}.get(str(note.get("yanchor")), "center")
    axes.text(note["x"], note["y"], plain(str(note["text"])), ha=across, va=up, size=7.0, transform=transform)


def _legend_rows(labels: Sequence[str], letters: int) -> int:
    """Rows of a legend whose columns are as wide as the longest name."""
    return -(-len(labels) // _columns(labels, letters))


def _columns(labels: Sequence[str], letters: int) -> int:
    return max(1, min(len(labels), letters // (max(len(label) for label in labels) + 8)))


def _legend(page: Figure, axes: Sequence[Axes], labels: Sequence[str], rows: int) -> None:
    handles = [(h, n) for one in axes for h, n in zip(*one.get_legend_handles_labels(), strict=True)]
    page.legend(
        [h for h, _ in handles],
        [n for _, n in handles],
        loc="upper left",
        bbox_to_anchor=(0.0, 1.0),
        ncols=-(-len(labels) // rows),
        frameon=False,
        fontsize=7.0,
        handlelength=2.6,
        columnspacing=1.4,
        labelspacing=0.25,
        borderpad=0.1,
    )
