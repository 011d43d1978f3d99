"""Curves and series as figures: units, names, the mark of what is shown."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from contracts.series import TimeSeries
from workbench.viewer.charts import curves_chart, quantities, series_chart

CURVE = StiffnessCurve(
    model="fe", orientation_deg=0.0, deflection=np.array([0.0, 0.01]), load=np.array([0.0, 80.0]), columns={}
)


def test_curves_are_drawn_in_millimetres_and_told_apart() -> None:
    curves = {"fe_average": CURVE, "fe_phi000": CURVE, "fe_phi015": CURVE, "mine.csv": CURVE}
    figure = curves_chart(curves, ["mine.csv"], ("40 N", 0.005, 40.0))
    assert [one["name"] for one in figure["data"]] == ["FE average", "FE 0°", "FE 15°", "mine.csv", "shown: 40 N"]
    assert figure["data"][0]["x"] == [0.0, 10.0]
    assert (figure["data"][-1]["x"], figure["data"][-1]["y"]) == ([5.0], [40.0])
    styles = [(one["line"]["color"], one["line"]["dash"]) for one in figure["data"][:-1]]
    assert len(set(styles)) == len(styles)
    assert figure["layout"]["xaxis"]["title"]["text"] == "radial deflection [mm]"


def test_many_curves_keep_styles_of_their_own() -> None:
    figure = curves_chart({f"fe_phi{5 * k:03d}": CURVE for k in range(16)}, [], None)
    assert len({(one["line"]["color"], one["line"]["dash"]) for one in figure["data"]}) == 16


def test_a_series_is_drawn_by_quantity() -> None:
    time = np.array([0.0, 1.0])
    columns = {
        "front_left_deflection_m": np.array([0.001, 0.002]),
        "rear_right_deflection_m": np.array([0.003, 0.004]),
        "body_lean_rad": np.array([0.0, np.pi / 180.0]),
    }
    series = TimeSeries(scenario="drop", tire="brush", time=time, columns=columns)
    assert quantities(series) == {"deflection_m": "radial deflection [mm]", "body_lean_rad": "body lean [°]"}
    wheels = series_chart(series, "deflection_m")
    assert [one["name"] for one in wheels["data"]] == ["front left", "rear right"]
    assert wheels["data"][1]["y"] == [3.0, 4.0]
    lean = series_chart(series, "body_lean_rad")
    assert lean["data"][0]["y"] == pytest.approx([0.0, 1.0])
    assert lean["layout"]["yaxis"]["title"]["text"] == "body lean [°]"


def test_names_are_no_markup() -> None:
    """Plotly draws tags such as <b> and <a href> in names and titles; entities it draws as what they stand for."""
    name = "<a href='x'>mine</a>&amp;.csv"
    (line,) = curves_chart({name: CURVE}, [name], None)["data"]
    assert line["name"] == "&lt;a href='x'&gt;mine&lt;/a&gt;&amp;amp;.csv"
    (long,) = curves_chart({"x" * 250: CURVE}, [], None)["data"]
    assert len(long["name"]) == 60
    column = "<b>\n_m"
    series = TimeSeries(scenario="s", tire="brush", time=np.array([0.0, 1.0]), columns={column: np.array([0.0, 1.0])})
    assert quantities(series) == {column: "<b>\\n [mm]"}  # text of a list
    assert series_chart(series, column)["layout"]["yaxis"]["title"]["text"] == "&lt;b&gt;\\n [mm]"
