"""The average curve against slope and band of a reference: decided, or left open by what is not known of both."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from contracts.curves import Around, StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from tests.unit.test_workbench_limits import model
from workbench.questions.fe.reference_checks import leaves_band, reference_checks
from workbench.questions.mesh_study.results import MeshStudy
from workbench.study.reference import BandPoint, BandReference, ReferenceSection, SlopeReference
from workbench.study.reference_file import LoadBand
from workbench.study.sections import ToleranceSection

SAID: dict[str, Any] = {"kind": "measured", "source": "test rig"}
FE = model({0.0: 8000.0})
"""A straight line of 8 N/mm to 40 mm."""


def _mesh(share: float) -> MeshStudy:
    """Every load known to +-share, which is the norm's."""
    found = SimpleNamespace(l2_uncertainty=lambda curve, start, end: share)
    return cast(MeshStudy, found)


def _slope(value: float, uncertainty: float = 0.0) -> ReferenceSection:
    return ReferenceSection(slope=SlopeReference(value=value, uncertainty=uncertainty, **SAID))


def _checked(reference: ReferenceSection, mesh: MeshStudy | None = None, limit: float = 0.03) -> Check:
    (check,) = reference_checks(FE, reference, ToleranceSection(initial_tangent=limit), None, mesh)
    assert check.role == "finding"
    assert check.source == "measured: test rig"
    return check


@pytest.mark.parametrize(
    ("value", "own", "mesh", "status"),
    [
        (8100.0, 0.0, None, "pass"),
        (8400.0, 0.0, None, "fail"),  # 4.8 % off
        (8100.0, 0.01, 0.01, "pass"),  # 1.2 % and 1.4 % are less than 3 %
        (8100.0, 0.02, None, "undecided"),
        (8100.0, 0.0, 0.02, "undecided"),
        (8100.0, 0.015, 0.015, "undecided"),  # each by itself would decide: 2.1 % together do not
        (8100.0, 0.015, None, "pass"),
        (8400.0, 0.01, 0.01, "fail"),
        (8400.0, 0.02, 0.0, "undecided"),
    ],
)
def test_a_slope_is_judged_with_both_uncertainties(value: float, own: float, mesh: float | None, status: str) -> None:
    check = _checked(_slope(value, own), None if mesh is None else _mesh(mesh))
    assert (check.id, check.value) == ("fe.initial_tangent", pytest.approx(8000.0))
    assert check.status == status
    numerical = "numerical not known" if mesh is None else f"numerical ±{100 * mesh:.2g} %"
    assert check.tolerance == f"3 %; uncertainty of the reference ±{100 * own:.2g} %, {numerical}"


def test_the_slope_may_be_that_of_some_orientations() -> None:
    """A soft third orientation does not count."""
    fe = model({0.0: 8000.0, 40.0: 8200.0, 80.0: 5000.0})
    slope = SlopeReference(value=8100.0, orientations=("0 deg", "40 deg"), uncertainty=0.0, **SAID)
    (check,) = reference_checks(fe, ReferenceSection(slope=slope), ToleranceSection(), Around(period=120.0))
    assert (check.status, check.value) == ("pass", pytest.approx(8100.0))
    assert "of 0, 40 degrees alone" in check.title
    whole = SlopeReference(value=8100.0, uncertainty=0.0, **SAID)
    assert reference_checks(fe, ReferenceSection(slope=whole), ToleranceSection())[0].status == "fail"


def _at_160(low: float, high: float, uncertainty: float = 0.0) -> ReferenceSection:
    point = BandPoint(load=160.0, low=low, high=high)
    return ReferenceSection(band=BandReference(points=(point,), uncertainty=uncertainty, **SAID))


@pytest.mark.parametrize(
    ("low", "high", "own", "mesh", "status"),
    [
        (0.019, 0.021, 0.0, None, "pass"),  # 20 mm
        (0.021, 0.022, 0.0, None, "fail"),
        (0.019, 0.021, 0.0, 0.049, "pass"),  # +-0.98 mm
        (0.019, 0.021, 0.0, 0.06, "undecided"),
        (0.021, 0.022, 0.0, 0.06, "undecided"),
        (0.019, 0.021, 0.04, 0.04, "undecided"),
    ],
)
def test_a_deflection_is_judged_with_both(low: float, high: float, own: float, mesh: float | None, status: str) -> None:
    check = _checked(_at_160(low, high, own), None if mesh is None else _mesh(mesh))
    assert (check.id, check.status) == ("fe.deflection_at_160N", status)
    assert check.value == pytest.approx(0.020)


def test_a_load_that_is_not_reached_is_not_evaluated() -> None:
    point = BandPoint(load=400.0, low=0.01, high=0.02)
    check = _checked(ReferenceSection(band=BandReference(points=(point,), uncertainty=0.0, **SAID)))
    assert (check.status, check.value) == ("error", None)


def _band(low: float, high: float, end: float = 0.04) -> LoadBand:
    at = np.linspace(0.0, end, 9)
    return LoadBand(deflection=at, low=low * at, high=high * at)


def test_how_far_a_curve_leaves_a_band() -> None:
    assert leaves_band(FE.average, _band(7600.0, 8400.0)) == pytest.approx(8000.0 / 8400.0 - 1.0)  # within
    assert leaves_band(FE.average, _band(6000.0, 7500.0)) == pytest.approx(8000.0 / 7500.0 - 1.0)
    assert leaves_band(FE.average, _band(9000.0, 9500.0)) == pytest.approx(1.0 - 8000.0 / 9000.0)
    with pytest.raises(InputError, match="covers less than half of the band"):
        leaves_band(FE.average, _band(7600.0, 8400.0, end=0.1))


@pytest.mark.parametrize(
    ("low", "high", "own", "mesh", "status"),
    [
        (7600.0, 8400.0, 0.0, None, "pass"),
        (6000.0, 7500.0, 0.0, None, "fail"),
        (7600.0, 8400.0, 0.0, 0.06, "undecided"),  # 4.8 % within
        (6000.0, 7500.0, 0.05, 0.05, "undecided"),  # 6.7 % beyond, known to 7.1 %
    ],
)
def test_a_band_of_a_file_is_judged_with_both(
    tmp_path: Path, low: float, high: float, own: float, mesh: float | None, status: str
) -> None:
    at = np.linspace(0.0, 0.04, 9)
    rows = "".join(f"{d},{8000 * d},{low * d},{high * d}\n" for d in at)
    (tmp_path / "band.csv").write_text(f"deflection_m,load_N,load_low_N,load_high_N\n{rows}", encoding="utf-8")
    band = BandReference(file=str(tmp_path / "band.csv"), uncertainty=own, **SAID)
    check = _checked(ReferenceSection(band=band), None if mesh is None else _mesh(mesh))
    assert (check.id, check.status) == ("fe.band", status)


def test_the_words_of_the_thesis_bring_no_slope_and_no_marks() -> None:
    """19 to 21 mm at 160 N and 8.25 N/mm chose the wheel, and judge nothing."""
    assert reference_checks(FE, ReferenceSection(thesis_words=True), ToleranceSection()) == []


def test_without_a_point_nothing_is_decided() -> None:
    empty = StiffnessCurve(model="fe", orientation_deg=0.0, deflection=np.zeros(1), load=np.zeros(1), partial=True)
    fe = cast(Any, SimpleNamespace(average=empty, by_orientation={0.0: empty}))
    (check,) = reference_checks(fe, _slope(8000.0, 0.01), ToleranceSection(), None, _mesh(0.01))
    assert check.status == "error"
