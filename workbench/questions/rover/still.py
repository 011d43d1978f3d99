"""Task of the rover's still. Verified by tests/end_to_end/test_report.py."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rover_dynamics.rover.rover_file import read_rover
from workbench.questions.rover.scene import draw_still

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["draw"]


def draw(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``rover.png``: the rover at rest on level ground."""
    draw_still(read_rover(), out / "rover.png")
    progress(1.0)
    return 0
