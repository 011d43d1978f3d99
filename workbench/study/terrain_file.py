"""Height fields from files: NumPy archives and GeoTIFF.

NPZ: ``heights`` (n_x, n_y) float [m], ``spacing`` (2,) [m] and, if wanted, ``origin`` (2,) [m], as
`contracts.height_field.HeightField` defines them. GeoTIFF: the first band, heights in metres on a grid in a projected
coordinate system in metres, north up (x runs east, y north); GDAL's reader (rasterio) knows its tags,
compressions and gaps.

GDAL would open whatever a file names: other files (VRT), the network (/vsicurl/), files beside it (.aux.xml, .ovr,
world files). Here it is given the bytes of one file, not its path, and its GeoTIFF driver alone, so that there is
nothing else to open. What a file claims is judged before memory is taken for it.

Verified by tests/unit/test_workbench_terrain_file.py and tests/unit/test_workbench_terrain_hostile.py.
"""

from __future__ import annotations

import logging
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import rasterio  # type: ignore[import-untyped]

from contracts.archive import read_archive
from contracts.errors import InputError
from contracts.height_field import HeightField
from contracts.input_file import input_bytes

__all__ = ["MOST_HEIGHTS", "read_height_field"]

_WHAT = "terrain file"
MOST_HEIGHTS = 10_000_000
"""Heights a field may have: ground for the rover takes 250 bytes for each while it is prepared, 2.5 GB in all."""
_LARGEST = 400_000_000
"""Size of a GeoTIFF [byte]: further bands and overviews are in it too."""
_LARGEST_BLOCK = 256_000_000
"""Bytes of one strip or tile, which GDAL unpacks as a whole."""
_MAGIC = (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")
_ALONE = {
    "GDAL_DISABLE_READDIR_ON_OPEN": "EMPTY_DIR",
    "GDAL_PAM_ENABLED": "NO",
    "CPL_VSIL_CURL_ALLOWED_EXTENSIONS": ".none",
    "PROJ_NETWORK": "OFF",
}
"""No files beside, no network: a second lock, the first being that GDAL gets no path."""


def read_height_field(path: Path, origin: tuple[float, float] | None = None) -> HeightField:
    """Height field of a file with the ending .npz, .tif or .tiff.

    Parameters
    ----------
    path : the file
    origin : x, y of its corner of smallest x and y in the world [m]; as the file says if not given

    Raises
    ------
    InputError
        For a file that is missing, of another kind, damaged, too large, without georeference or in degrees, or has
        gaps.
    """
    readers = {".npz": _from_npz, ".tif": _from_geotiff, ".tiff": _from_geotiff}
    if path.suffix.lower() not in readers:
        raise InputError(_WHAT, path, "must end in .npz, .tif or .tiff", "convert it")
    field = readers[path.suffix.lower()](path)
    if origin is None:
        return field
    return HeightField(heights=field.heights, spacing=field.spacing, origin=origin)


def _check_count(path: Path, shape: tuple[int, ...]) -> None:
    """Raise InputError for more heights than a field may have."""
    count = int(np.prod(np.array(shape, dtype=object)))
    if count > MOST_HEIGHTS:
        value = f"{path}, {' x '.join(map(str, shape))} heights"
        rule = f"must have at most {MOST_HEIGHTS / 1e6:g} million"
        raise InputError(_WHAT, value, rule, "cut out what the rover drives over, as with gdal_translate -projwin")


def _from_npz(path: Path) -> HeightField:
    arrays = read_archive(path, _WHAT, 16 * MOST_HEIGHTS + 1000, ("heights", "spacing", "origin"))
    rule, hint = "must be a NumPy archive with heights (n_x, n_y) and spacing (2,)", "write it with numpy.savez"
    if not {"heights", "spacing"} <= arrays.keys() or any(array.dtype.kind not in "iuf" for array in arrays.values()):
        raise InputError(_WHAT, path, rule, hint)
    heights, spacing = (np.asarray(arrays[name], dtype=np.float64) for name in ("heights", "spacing"))
    origin = np.asarray(arrays.get("origin", (0.0, 0.0)), dtype=np.float64)
    _check_count(path, heights.shape)
    if spacing.shape != (2,) or origin.shape != (2,):
        value = f"shapes {spacing.shape}, {origin.shape}"
        raise InputError("terrain file spacing, origin", value, "must be two numbers each", "give x and y")
    return HeightField(
        heights=heights,
        spacing=(float(spacing[0]), float(spacing[1])),
        origin=(float(origin[0]), float(origin[1])),
    )


def _from_geotiff(path: Path) -> HeightField:
    content = input_bytes(path, _WHAT, _LARGEST)
    if content[:4] not in _MAGIC:
        raise InputError(_WHAT, path, "must be a GeoTIFF, which begins with II or MM", "convert it with gdal_translate")
    try:
        with _opened(content) as source:
            _check_raster(path, source)
            band, place, crs = source.read(1, masked=True), source.transform, source.crs
    except (rasterio.errors.RasterioError, ValueError, MemoryError) as error:
        if isinstance(error, InputError):
            raise
        reason = str(error).replace("\n", " ")[:120]
        raise InputError(_WHAT, path, "must be a GeoTIFF", f"try gdalinfo ({reason})") from error
    if place.is_identity or place.b != 0.0 or place.d != 0.0 or place.a <= 0.0 or place.e >= 0.0:
        rule = "must be georeferenced, in the file itself, with rows from north to south"
        raise InputError(_WHAT, path, rule, "warp it with gdalwarp")
    if crs is not None and (crs.is_geographic or crs.linear_units_factor[1] != 1.0):
        raise InputError(_WHAT, path, "must have coordinates in metres", "project it with gdalwarp -t_srs")
    if np.ma.is_masked(band):
        value = f"{np.ma.count_masked(band)} gaps"
        raise InputError(_WHAT, value, "must have a height everywhere", "fill them with gdal_fillnodata")
    heights = np.ascontiguousarray(np.asarray(band, dtype=np.float64)[::-1].T)
    low = (place.c + 0.5 * place.a, place.f + (len(band) - 0.5) * place.e)
    return HeightField(heights=heights, spacing=(place.a, -place.e), origin=low)


@contextmanager
def _opened(content: bytes) -> Iterator[Any]:
    """The raster in a file's bytes, by the GeoTIFF driver alone; nothing on stderr."""
    log = logging.getLogger("rasterio")
    before = log.level
    log.setLevel(logging.CRITICAL)  # what fails is raised too
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)  # refused by the caller
            with rasterio.Env(**_ALONE), rasterio.MemoryFile(content) as file, file.open(driver="GTiff") as source:
                yield source
    finally:
        log.setLevel(before)


def _check_raster(path: Path, source: Any) -> None:
    """Raise InputError for a raster whose header claims more memory than heights need, or no heights."""
    _check_count(path, (source.width, source.height))
    kind = np.dtype(source.dtypes[0])
    if kind.kind not in "iuf":
        raise InputError(_WHAT, path, f"must hold heights, not {source.dtypes[0]}", "write it as Float32")
    rows, columns = source.block_shapes[0]
    size = rows * columns * kind.itemsize * source.count
    if size > _LARGEST_BLOCK:
        value = f"{path}, strips of {size / 1e6:.3g} MB"
        rule = f"must have strips or tiles of at most {_LARGEST_BLOCK / 1e6:g} MB"
        raise InputError(_WHAT, value, rule, "write it anew with gdal_translate -co TILED=YES")
