"""Field files the viewer reads; one it cannot read is one message, and nothing of VTK's on stderr."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.errors import InputError
from tests.small_report_folder import ring_mesh, write_small_report
from workbench.viewer.wheel_file import read_fields


def test_fields_come_back(tmp_path: Path) -> None:
    write_small_report(tmp_path)
    body, field = read_fields(tmp_path / "fields" / "fe_phi000_200N.vtu")
    mesh = ring_mesh()
    np.testing.assert_allclose(body.places * [[1.0, y, 1.0] for y in body.mirror], mesh.points[body.nodes])
    assert len(body.parts) == 2 * len(mesh.cells)
    share = np.clip(-mesh.points[:, 2] / 0.14, 0.0, 1.0)
    np.testing.assert_allclose(field.von_mises, 4e8 * share)
    np.testing.assert_allclose(field.displacement[:, 2], 0.02 * share, atol=1e-12)


@pytest.mark.parametrize("damage", ["cut", "empty", "text", "other", "field"])
def test_a_damaged_file_is_one_message(tmp_path: Path, damage: str, capfd: pytest.CaptureFixture[str]) -> None:
    write_small_report(tmp_path)
    path = tmp_path / "fields" / "fe_phi000_200N.vtu"
    text = path.read_text(encoding="utf-8")
    new = {
        "cut": text[: len(text) // 2],
        "empty": "",
        "text": "no mesh",
        "other": "<VTKFile type='UnstructuredGrid'></VTKFile>",
        "field": text.replace("von_mises_Pa", "pressure"),
    }
    path.write_text(new[damage], encoding="utf-8")
    with pytest.raises(
        InputError, match=r"field file = .*fe_phi000_200N\.vtu: cannot be read .*; run the report again"
    ):
        read_fields(path)
    out, err = capfd.readouterr()
    assert (out, err) == ("", "")
