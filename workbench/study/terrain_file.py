"""Height fields from files: NumPy archives and GeoTIFF.

NPZ: ``heights`` (n_x, n_y) float [m], ``spacing`` (2,) [m] and, if wanted, ``origin`` (2,) [m], as
`contracts.height_field.HeightField` defines them. GeoTIFF: the first band, heights in metres on a grid in a projected
coordinate system in metres, north up (x runs east, y north); GDAL's reader (rasterio) knows its tags,
compressions and gaps.

Verified by tests/unit/test_workbench_terrain_file.py.
"""

from __future__ import annotations

import warnings
import zipfile
import zlib
from pathlib import Path

import numpy as np
import rasterio  # type: ignore[import-untyped]

from contracts.errors import InputError
from contracts.height_field import HeightField

__all__ = ["read_height_field"]

_DAMAGED = (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, MemoryError, TypeError)
"""What a damaged archive makes of zipfile and NumPy: bad members, an unknown compression, encryption, a huge shape."""


def read_height_field(path: Path, origin: tuple[float, float] | None = None) -> HeightField:
    """Height field of a file with the ending .npz, .tif or .tiff.

    Parameters
    ----------
    path : the file
    origin : x, y of its corner of smallest x and y in the world [m]; as the file says if not given

    Raises
    ------
    InputError
        For a file that is missing, of another kind, damaged, without georeference or in degrees, or has gaps.
    """
    readers = {".npz": _from_npz, ".tif": _from_geotiff, ".tiff": _from_geotiff}
    if path.suffix.lower() not in readers:
        raise InputError("terrain file", path, "must end in .npz, .tif or .tiff", "convert it")
    if not path.is_file():
        raise InputError("terrain file", path, "does not exist", "check its name")
    field = readers[path.suffix.lower()](path)
    if origin is None:
        return field
    return HeightField(heights=field.heights, spacing=field.spacing, origin=origin)


def _from_npz(path: Path) -> HeightField:
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as archive:
            heights, spacing = (np.asarray(archive[name], dtype=np.float64) for name in ("heights", "spacing"))
            origin = np.asarray(archive.get("origin", (0.0, 0.0)), dtype=np.float64)
    except (*_DAMAGED, KeyError, ValueError, OSError) as error:
        rule = "must be a NumPy archive with heights (n_x, n_y) and spacing (2,)"
        raise InputError("terrain file", path, rule, f"write it with numpy.savez ({error})") from error
    if spacing.shape != (2,) or origin.shape != (2,):
        value = f"shapes {spacing.shape}, {origin.shape}"
        raise InputError("terrain file spacing, origin", value, "must be two numbers each", "give x and y")
    return HeightField(
        heights=heights,
        spacing=(float(spacing[0]), float(spacing[1])),
        origin=(float(origin[0]), float(origin[1])),
    )


def _from_geotiff(path: Path) -> HeightField:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)  # refused below
            with rasterio.open(path) as source:
                band, place, crs = source.read(1, masked=True), source.transform, source.crs
    except rasterio.errors.RasterioError as error:
        raise InputError("terrain file", path, "must be a GeoTIFF", f"try gdalinfo ({error})") from error
    if place.is_identity or place.b != 0.0 or place.d != 0.0 or place.a <= 0.0 or place.e >= 0.0:
        rule = "must be georeferenced with rows from north to south"
        raise InputError("terrain file", path, rule, "warp it with gdalwarp")
    if crs is not None and (crs.is_geographic or crs.linear_units_factor[1] != 1.0):
        raise InputError("terrain file", path, "must have coordinates in metres", "project it with gdalwarp -t_srs")
    if np.ma.is_masked(band):
        value = f"{np.ma.count_masked(band)} gaps"
        raise InputError("terrain file", value, "must have a height everywhere", "fill them with gdal_fillnodata")
    heights = np.ascontiguousarray(np.asarray(band, dtype=np.float64)[::-1].T)
    low = (place.c + 0.5 * place.a, place.f + (len(band) - 0.5) * place.e)
    return HeightField(heights=heights, spacing=(place.a, -place.e), origin=low)
