"""Published tables: found by name, with their source; an unknown name is refused with those there are."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import contracts.published
from contracts.errors import InputError
from contracts.published import published_matrix, published_table

FOLDER = Path(contracts.published.__file__).parent
MATRICES = {"ancf_plate_mass", "ancf_plate_gravity", "ancf_plate_elastic_force"}
TABLES = sorted({path.stem for path in FOLDER.glob("*.csv")} - MATRICES)


@pytest.mark.parametrize("name", TABLES)
def test_every_table_has_a_source_and_full_rows(name: str) -> None:
    table = published_table(name)
    assert len(table.source) > 40
    assert len(table.rows) > 0
    assert {len(row) for row in table.rows} == {len(table.names)}


def test_numbers_and_labels_are_those_of_the_file() -> None:
    table = published_table("halfcyl_crown_reaction")
    assert table.text("mesh")[::4] == ("s8", "s60", "s200")
    assert table["crown_Fy_N"][3] == -5412.474
    assert table["dof"].dtype == np.float64


def test_matrices_are_those_of_one_plate() -> None:
    assert {name: published_matrix(name).shape for name in MATRICES} == {
        "ancf_plate_mass": (16, 16),
        "ancf_plate_gravity": (16, 3),
        "ancf_plate_elastic_force": (16, 3),
    }


def test_unknown_names_are_refused() -> None:
    with pytest.raises(InputError, match="hertz_line"):
        published_table("hertz")
    with pytest.raises(InputError, match="R_mm"):
        published_table("hertz_line").text("R")
