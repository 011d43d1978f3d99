"""Terrain files that claim, point or never end: no second file is opened, no memory taken on a file's word.

Negative control: GDAL left to itself does open the second file and does ask the network, so that the traps work.
"""

from __future__ import annotations

import io
import os
import socket
import struct
import threading
import warnings
import zipfile
from collections.abc import Callable, Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path

import numpy as np
import pytest
import rasterio
from numpy.typing import NDArray

from contracts.errors import InputError
from workbench.study.terrain_file import MOST_HEIGHTS, read_height_field

FloatArray = NDArray[np.float64]
HEIGHTS = np.random.default_rng(0).normal(size=(6, 5))
PLACE = rasterio.Affine(0.5, 0.0, 0.0, 0.0, -0.5, 10.0)
MOST_MEMORY = 50_000_000
"""[byte] that a refusal may take."""


def most_memory(*, anew: bool = False) -> int:
    """Largest memory this process has had [byte], or has now, to count from."""
    if anew:
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
    (line,) = (line for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines() if "VmHWM" in line)
    return 1024 * int(line.split()[1])


def geotiff(path: Path, heights: FloatArray = HEIGHTS, **options: object) -> Path:
    settings = {"transform": PLACE, "crs": "EPSG:32632", "dtype": "float64", "count": 1, **options}
    size = {"height": heights.shape[0], "width": heights.shape[1]}
    with rasterio.open(path, "w", driver="GTiff", **{**size, **settings}) as file:
        if settings["count"] == 1 and not options.get("SPARSE_OK"):
            file.write(heights.astype(settings["dtype"]), 1)
    return path


def vrt(source: str) -> str:
    return f"""<VRTDataset rasterXSize="5" rasterYSize="6"><GeoTransform>0, 0.5, 0, 10, 0, -0.5</GeoTransform>
<VRTRasterBand dataType="Float64" band="1"><SimpleSource><SourceFilename>{source}</SourceFilename>
<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>"""


@pytest.fixture
def server() -> Iterator[tuple[str, list[str]]]:
    """A web server on loopback: its address and what it was asked for."""
    asked: list[str] = []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            asked.append(self.path)
            self.send_error(404)

        do_HEAD = do_GET

        def log_message(self, *_: object) -> None:
            pass

    with HTTPServer(("127.0.0.1", 0), Handler) as web:
        thread = threading.Thread(target=web.serve_forever, args=(0.01,))
        thread.start()
        yield f"http://127.0.0.1:{web.server_port}", asked
        web.shutdown()
        thread.join()


def test_no_file_opens_another_file(tmp_path: Path) -> None:
    other = geotiff(tmp_path / "other.tif")
    trap = tmp_path / "trap.tif"
    trap.write_text(vrt(str(other)), encoding="utf-8")
    with rasterio.open(trap) as control:  # negative control: GDAL by itself follows
        np.testing.assert_array_equal(control.read(1), HEIGHTS)
    with pytest.raises(InputError, match="begins with II or MM"):
        read_height_field(trap)


@pytest.mark.parametrize("wrapped", ["file", "path"])
def test_no_file_asks_the_network(wrapped: str, tmp_path: Path, server: tuple[str, list[str]]) -> None:
    address, asked = server
    trap = tmp_path / "trap.tif"
    trap.write_text(vrt(f"/vsicurl/{address}/control.tif"), encoding="utf-8")
    with pytest.raises(rasterio.errors.RasterioError), rasterio.open(trap) as control:
        control.read(1)
    assert asked, "negative control: GDAL by itself asks"
    asked.clear()
    trap.write_text(vrt(f"/vsicurl/{address}/far.tif"), encoding="utf-8")  # GDAL asks but once for each
    with pytest.raises(InputError):
        read_height_field(trap if wrapped == "file" else Path(f"/vsicurl/{address}/far.tif"))
    assert not asked


@pytest.mark.parametrize(
    "name",
    [
        "/vsizip/{zip}/ground.tif",
        "/vsicurl/http://127.0.0.1:9/ground.tif",
        "/vsistdin/ground.tif",
        "GTIFF_DIR:1:{tif}",
        "GTIFF_RAW:{tif}",
        'NETCDF:"{tif}":heights.tif',
        "vrt://{tif}",
        "zip+file://{zip}!ground.tif",
        "zip://{zip}!ground.tif",
        "DERIVED_SUBDATASET:LOGAMPLITUDE:{tif}",
        "MEM:::DATAPOINTER=1,PIXELS=5,LINES=6.tif",
        "<VRTDataset/>.tif",
    ],
)
def test_a_path_is_a_path_and_no_more(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What GDAL or rasterio would understand as a driver, an archive or an address is the name of a missing file."""
    monkeypatch.chdir(tmp_path)
    tif = geotiff(tmp_path / "ground.tif")
    with zipfile.ZipFile(tmp_path / "ground.zip", "w") as archive:
        archive.write(tif, "ground.tif")
    with pytest.raises(InputError, match=r"does not exist|cannot be read"):
        read_height_field(Path(name.format(zip="ground.zip", tif="ground.tif")))


@pytest.mark.parametrize("beside", ["ground.tif.aux.xml", "ground.tfw", "ground.tif.ovr", "ground.tif.msk"])
def test_files_beside_it_change_nothing(beside: str, tmp_path: Path) -> None:
    """Statistics, nodata, places, overviews and masks of a second file are not taken up."""
    path = geotiff(tmp_path / "ground.tif")
    if beside.endswith("xml"):
        text = "<PAMDataset><GeoTransform>0, 7, 0, 0, 0, -7</GeoTransform></PAMDataset>"
        (tmp_path / beside).write_text(text, encoding="utf-8")
    elif beside.endswith("tfw"):
        (tmp_path / beside).write_text("7\n0\n0\n-7\n0\n0\n", encoding="utf-8")
    else:
        (tmp_path / beside).write_bytes(geotiff(tmp_path / "small.tif", 0.0 * HEIGHTS, dtype="uint8").read_bytes())
    field = read_height_field(path)
    assert field.spacing == (0.5, 0.5)
    np.testing.assert_array_equal(field.heights, HEIGHTS[::-1].T)


def test_a_place_beside_the_file_does_not_count(tmp_path: Path) -> None:
    with pytest.warns(rasterio.errors.NotGeoreferencedWarning):
        path = geotiff(tmp_path / "ground.tif", transform=None, crs=None)
    (tmp_path / "ground.tfw").write_text("7\n0\n0\n-7\n0\n0\n", encoding="utf-8")
    with rasterio.open(path) as control:
        assert control.transform.a == 7.0
    with pytest.raises(InputError, match="in the file itself"):
        read_height_field(path)


def sparse(path: Path) -> Path:
    empty = np.broadcast_to(np.zeros(1), (120_000, 120_000))
    return geotiff(path, empty, dtype="float32", SPARSE_OK=True, tiled=True, BIGTIFF="YES", compress="deflate")


def strip(path: Path) -> Path:
    """Few heights in one tile of 2^15 x 2^15."""
    return geotiff(path, np.zeros((100, 100)), SPARSE_OK=True, tiled=True, blockxsize=32768, blockysize=32768)


def bands(path: Path) -> Path:
    """Few heights, ten thousand bands in one strip."""
    wide = np.broadcast_to(np.zeros(1), (50, 9000))
    return geotiff(path, wide, SPARSE_OK=True, count=10_000, interleave="pixel", dtype="float32")


def complex_numbers(path: Path) -> Path:
    return geotiff(path, HEIGHTS, dtype="complex128")


def mountains(path: Path) -> Path:
    return geotiff(path, 1e30 * HEIGHTS)


def truncated(path: Path) -> Path:
    content = geotiff(path, np.zeros((400, 400)) + 1.0).read_bytes()
    path.write_bytes(content[: len(content) // 2])
    return path


def offsets(path: Path) -> Path:
    """A directory of tags at the end of the world."""
    path.write_bytes(b"II*\0" + struct.pack("<I", 0xFFFFFF00) + bytes(64))
    return path


def loop(path: Path) -> Path:
    """A directory of one tag that names itself as the next."""
    tag = struct.pack("<HHII", 256, 4, 1, 5)
    path.write_bytes(b"II*\0" + struct.pack("<I", 8) + struct.pack("<H", 1) + tag + struct.pack("<I", 8))
    return path


@pytest.mark.parametrize(
    ("make", "rule"),
    [
        (sparse, "120000 x 120000 heights: must have at most 10 million"),
        (strip, "strips of"),
        (bands, "strips of"),
        (complex_numbers, "must hold heights"),
        (mountains, "must not exceed 100000 m"),
        (truncated, "must be a GeoTIFF"),
        (offsets, "must be a GeoTIFF"),
        (loop, "must be a GeoTIFF"),
    ],
)
def test_a_raster_is_judged_by_its_header(
    make: Callable[[Path], Path], rule: str, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        path = make(tmp_path / "ground.tif")
    before = most_memory(anew=True)
    with pytest.raises(InputError, match=rule):
        read_height_field(path)
    assert most_memory() - before < MOST_MEMORY
    assert not caplog.records


def test_an_archive_of_too_many_heights_is_refused(tmp_path: Path) -> None:
    wide = np.broadcast_to(np.float16(0.0), (1, MOST_HEIGHTS + 1))
    np.savez_compressed(tmp_path / "wide.npz", heights=wide, spacing=[1.0, 1.0])
    with pytest.raises(InputError, match="at most 10 million"):
        read_height_field(tmp_path / "wide.npz")
    np.savez(tmp_path / "words.npz", heights=np.full((5, 5), "high"), spacing=[1.0, 1.0])
    with pytest.raises(InputError, match="with heights"):
        read_height_field(tmp_path / "words.npz")


@pytest.mark.parametrize("ending", [".npz", ".tif"])
@pytest.mark.parametrize("kind", ["pipe", "device", "folder", "socket", "endless", "loop", "closed"])
def test_what_is_no_file_is_said_at_once(
    kind: str, ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # names of sockets are short
    path = Path(f"ground{ending}")
    if kind == "pipe":
        os.mkfifo(path)
    elif kind in ("device", "endless"):
        path.symlink_to("/dev/null" if kind == "device" else "/dev/zero")
    elif kind == "folder":
        path.mkdir()
    elif kind == "loop":
        path.symlink_to(path)
    elif kind == "closed":
        path.symlink_to("/proc/self/mem")  # a regular file of size 0 that cannot be read at its start
    else:
        with socket.socket(socket.AF_UNIX) as listening:
            listening.bind(str(path))
    with pytest.raises(InputError, match=r"not a file|cannot be read|NumPy archive"):
        read_height_field(path)


def test_a_good_one_in_every_packing_is_read(tmp_path: Path) -> None:
    """What the locks let pass: BigTIFF, big endian, tiles, all lossless compressions, integers."""
    cases = ({"BIGTIFF": "YES"}, {"endianness": "big"}, {"tiled": True, "blockxsize": 16, "blockysize": 16})
    packed = ({"compress": name} for name in ("lzw", "deflate", "zstd", "lzma", "packbits", "lerc"))
    for options in (*cases, *packed):
        path = geotiff(tmp_path / "ground.tif", HEIGHTS, **options)
        np.testing.assert_array_equal(read_height_field(path).heights, HEIGHTS[::-1].T)
    whole = geotiff(tmp_path / "whole.tif", np.arange(30.0).reshape(6, 5), dtype="int16")
    np.testing.assert_array_equal(read_height_field(whole).heights, np.arange(30.0).reshape(6, 5)[::-1].T)
    stream = io.BytesIO()
    np.savez_compressed(stream, heights=HEIGHTS, spacing=[1.0, 1.0])
    (tmp_path / "ground.npz").write_bytes(stream.getvalue())
    np.testing.assert_array_equal(read_height_field(tmp_path / "ground.npz").heights, HEIGHTS)
