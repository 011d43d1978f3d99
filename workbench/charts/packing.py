"""Bytes as text in a page: gzip in base64, which every browser of 2023 or later unpacks by itself.

Verified by tests/unit/test_workbench_scenes.py.
"""

from __future__ import annotations

import base64
import gzip
import io
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike
from PIL import Image

__all__ = ["file_link", "packed", "picture_link", "quantised", "unpacked"]

_STEPS = 65535
_QUALITY = 82


def packed(data: bytes | str) -> str:
    """Base64 of the gzip stream; the same for the same data at any time."""
    raw = data.encode("utf-8") if isinstance(data, str) else data
    return base64.b64encode(gzip.compress(raw, 9, mtime=0)).decode("ascii")


def unpacked(text: str) -> bytes:
    """What was given to `packed`."""
    return gzip.decompress(base64.b64decode(text))


def file_link(content: bytes | str) -> str:
    """A file as a ``data:`` link to its gzip; a click in the page unpacks it, without scripts the gzip is saved."""
    return f"data:application/gzip;base64,{packed(content)}"


def quantised(values: ArrayLike) -> dict[str, object]:
    """Numbers in 65535 steps between their smallest and largest: ``low``, ``step``, and ``data``, uint16 in base64."""
    numbers = np.asarray(values, dtype=np.float64)
    low, high = (float(numbers.min()), float(numbers.max())) if numbers.size else (0.0, 0.0)
    step = (high - low) / _STEPS or 1.0
    steps = np.rint((numbers - low) / step).astype("<u2")
    return {"low": low, "step": step, "data": base64.b64encode(steps.tobytes()).decode("ascii")}


def picture_link(picture: Image.Image | Path) -> str:
    """A picture as a ``data:`` link in WebP, a tenth of the size of its PNG."""
    if isinstance(picture, Path):
        with Image.open(picture) as opened:
            return picture_link(opened)
    with io.BytesIO() as buffer:
        picture.convert("RGB").save(buffer, "WEBP", quality=_QUALITY, method=4)
        return "data:image/webp;base64," + base64.b64encode(buffer.getvalue()).decode("ascii")
