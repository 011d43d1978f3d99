"""Height fields from NPZ and GeoTIFF: the same terrain from both, and one clear message for each bad file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rasterio
from numpy.typing import NDArray

from contracts.errors import InputError
from workbench.study.terrain_file import read_height_field

FloatArray = NDArray[np.float64]
HEIGHTS = np.random.default_rng(0).normal(size=(6, 5))


def npz(folder: Path, **arrays: Any) -> Path:
    np.savez(folder / "ground.npz", **arrays)
    return folder / "ground.npz"


def geotiff(folder: Path, heights: FloatArray, **options: Any) -> Path:
    """Grid of 0.5 m by 0.25 m whose lowest corner cell has its centre at (10, -3)."""
    rows = np.ascontiguousarray(heights.T[::-1])
    north = -3.0 + 0.25 * (len(rows) - 0.5)
    place = rasterio.Affine(0.5, 0.0, 10.0 - 0.25, 0.0, -0.25, north)
    settings = {"transform": place, "crs": "EPSG:32632", "compress": "deflate", **options}
    path = folder / "ground.tif"
    size = {"width": rows.shape[1], "height": rows.shape[0], "count": 1, "dtype": "float64"}
    with rasterio.open(path, "w", driver="GTiff", **size, **{k: v for k, v in settings.items() if v is not None}) as f:
        f.write(rows, 1)
    return path


def test_both_kinds_give_the_same_field(tmp_path: Path) -> None:
    archive = read_height_field(npz(tmp_path, heights=HEIGHTS, spacing=[0.5, 0.25], origin=[10.0, -3.0]))
    for compression in ("deflate", "lzw", None):
        image = read_height_field(geotiff(tmp_path, HEIGHTS, compress=compression))
        np.testing.assert_array_equal(image.heights, HEIGHTS)
        assert image.spacing == archive.spacing == (0.5, 0.25)
        assert image.origin == pytest.approx(archive.origin)
    x, y = np.array(10.5), np.array(-2.5)
    assert float(image.height(x, y)) == pytest.approx(HEIGHTS[1, 2], abs=1e-14)


def test_the_corner_may_be_moved(tmp_path: Path) -> None:
    path = geotiff(tmp_path, HEIGHTS)
    assert read_height_field(path, (0.0, 1.0)).origin == (0.0, 1.0)
    assert read_height_field(npz(tmp_path, heights=HEIGHTS, spacing=[1.0, 1.0])).origin == (0.0, 0.0)


def test_a_geotiff_without_system_counts_as_metres(tmp_path: Path) -> None:
    assert read_height_field(geotiff(tmp_path, HEIGHTS, crs=None)).spacing == (0.5, 0.25)


def test_bad_geotiffs_are_refused(tmp_path: Path) -> None:
    gap = HEIGHTS.copy()
    gap[2, 3] = -9999.0
    with pytest.raises(InputError, match="1 gaps"):
        read_height_field(geotiff(tmp_path, gap, nodata=-9999.0))
    with pytest.raises(InputError, match="coordinates in metres"):
        read_height_field(geotiff(tmp_path, HEIGHTS, crs="EPSG:4326"))
    with pytest.raises(InputError, match="coordinates in metres"):
        read_height_field(geotiff(tmp_path, HEIGHTS, crs="EPSG:2263"))  # feet
    with pytest.raises(InputError, match="georeferenced"):
        read_height_field(geotiff(tmp_path, HEIGHTS, transform=rasterio.Affine(0.5, 0.1, 0.0, 0.1, -0.25, 0.0)))
    (tmp_path / "text.tiff").write_text("no image", encoding="utf-8")
    with pytest.raises(InputError, match="must be a GeoTIFF"):
        read_height_field(tmp_path / "text.tiff")


def test_a_geotiff_without_place_is_refused(tmp_path: Path) -> None:
    with pytest.warns(rasterio.errors.NotGeoreferencedWarning):
        path = geotiff(tmp_path, HEIGHTS, transform=None, crs=None)
    with pytest.raises(InputError, match="georeferenced"):
        read_height_field(path)


def test_bad_archives_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="spacing"):
        read_height_field(npz(tmp_path, heights=HEIGHTS))
    with pytest.raises(InputError, match="two numbers each"):
        read_height_field(npz(tmp_path, heights=HEIGHTS, spacing=[1.0, 1.0, 1.0]))
    with pytest.raises(InputError, match="must be finite"):
        read_height_field(npz(tmp_path, heights=HEIGHTS * np.nan, spacing=[1.0, 1.0]))
    with pytest.raises(InputError, match="NumPy archive"):
        read_height_field(npz(tmp_path, heights=np.array([{"a": 1}], dtype=object), spacing=[1.0, 1.0]))
    (tmp_path / "text.npz").write_text("no archive", encoding="utf-8")
    with pytest.raises(InputError, match="NumPy archive"):
        read_height_field(tmp_path / "text.npz")


def test_other_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="must end in"):
        read_height_field(tmp_path / "ground.asc")
    with pytest.raises(InputError, match="does not exist"):
        read_height_field(tmp_path / "ground.npz")
