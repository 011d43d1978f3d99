"""Page, picture and numbers of a comparison."""

from __future__ import annotations

import io
import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from contracts.csv_table import TableRule, read_table
from contracts.curves import StiffnessCurve
from workbench.questions.two_curves.figures import compared_still
from workbench.questions.two_curves.pair import CurvePair, compared
from workbench.report.compared_page import compared_html, compared_rows, compared_table, compared_values
from workbench.study.curve_file import MeasuredCurve


@pytest.fixture(scope="module")
def pair() -> CurvePair:
    d = np.linspace(0.0, 0.03, 31)
    one = StiffnessCurve(model="<mine> $1", orientation_deg=None, deflection=d, load=8800.0 * d, source="a & b")
    two = StiffnessCurve(model="theirs", orientation_deg=None, deflection=d, load=8000.0 * d)
    reference = MeasuredCurve(curve=two, kind="radial deflection", uncertainty=0.03 * two.load)
    return compared(MeasuredCurve(curve=one, kind="radial deflection"), reference, tolerance=0.1)


def test_the_page_loads_nothing_and_says_the_verdict(pair: CurvePair) -> None:
    text = compared_html(pair)
    assert "src=" not in text.split("<script>")[0]
    assert "<strong>undecided</strong>" in text
    assert "&lt;mine&gt; $1" in text
    assert "<mine>" not in text.partition("<script>")[0]
    assert "a &amp; b" in text
    for row in compared_rows(pair):
        assert f"<td>{row.quantity}</td>" in text


def test_the_picture_is_drawn(pair: CurvePair) -> None:
    image = np.asarray(Image.open(io.BytesIO(compared_still(pair))).convert("RGB"))
    assert image.shape[0] > 800
    assert len(np.unique(image.reshape(-1, 3), axis=0)) > 50
    blue = (np.abs(image.astype(int) - [0, 114, 178]) < 40).all(axis=2)
    assert blue.sum() > 500  # the curve under test


def test_numbers_as_json_and_csv(pair: CurvePair, tmp_path: Path) -> None:
    values = json.loads(json.dumps(compared_values(pair), allow_nan=False))
    assert values["judgement"]["outcome"] == "undecided"
    assert values["metrics"]["relative_l2"] == pytest.approx(0.1)
    assert values["energies"]["reference"] == pytest.approx(0.5 * 240.0**2 / 8000.0)
    path = tmp_path / "c.csv"
    path.write_text(compared_table(pair), encoding="utf-8")
    table = read_table(path, TableRule(what="table", first=("deflection_m", "load_N"), units="SI"))
    assert table.names[-1] == "difference_uncertainty_N"
    np.testing.assert_allclose(table.values[:, 5], 8000.0, rtol=1e-9)
