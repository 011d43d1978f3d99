"""The kept run of the contact's damping is whole, says that the default does not drag, and is what the report shows."""

from __future__ import annotations

from dataclasses import replace

import pytest

from ancf_reduced.contact.law import ContactLaw
from benchmarks.contact_damping import laws
from contracts.errors import InputError
from workbench.questions.rover.tires import DISSIPATION
from workbench.questions.speed.damping import LAWS, SHARE, STRAIGHT, TRACTION, damping_rows, drives_of
from workbench.questions.speed.record import read_record

NONE, TENTH, PRINTED, DEFAULT = range(4)


def test_the_laws_are_those_of_their_names() -> None:
    found = laws()
    assert tuple(found) == LAWS
    assert [law.damping for law in found.values()] == [0.0, 10.0, 100.0, 0.0]
    assert [law.dissipation for law in found.values()] == [0.0, 0.0, 0.0, DISSIPATION]
    assert f"{DISSIPATION:g} s/m" in LAWS[DEFAULT]
    assert all(isinstance(law, ContactLaw) and law.stiffness == 1000.0 for law in found.values())


def test_the_kept_run_says_what_the_default_takes() -> None:
    """Less than a tenth of the drives' power where the printed damping takes more than half; at rest all are alike."""
    rows = damping_rows()
    assert [row.law for row in rows] == list(LAWS)
    assert rows[NONE].straight[1] == rows[NONE].traction[1] == 0.0
    for path in ("straight", "traction"):
        shares = [getattr(row, path)[1] for row in rows]
        assert shares[NONE] < shares[DEFAULT] < shares[TENTH] < shares[PRINTED]
        assert shares[DEFAULT] < 10.0
        assert shares[PRINTED] > 50.0
    assert rows[DEFAULT].traction[1] < 5.0
    assert all(row.deflection == pytest.approx(rows[NONE].deflection, rel=1e-3) for row in rows)
    assert all(row.bounces < 50.0 for row in rows)
    assert rows[PRINTED].bounces < rows[DEFAULT].bounces <= rows[NONE].bounces


def test_shares_of_a_path_do_not_exceed_its_drives() -> None:
    kept = read_record("contact_damping")
    for law in LAWS:
        for path in (STRAIGHT, TRACTION):
            assert kept.row(law, drives_of(path)).ours > 0.0
            assert sum(kept.row(law, f"{path}: {words}").ours for words in SHARE.values()) < 105.0


def test_a_run_without_a_law_is_refused() -> None:
    """Negative control."""
    kept = read_record("contact_damping")
    with pytest.raises(InputError, match="must be among the rows"):
        damping_rows(replace(kept, rows=kept.rows[5:]))
