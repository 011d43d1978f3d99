"""Picture of the first modes. Verified by tests/end_to_end/test_modes.py."""

from __future__ import annotations

from pathlib import Path

from workbench.charts.stills import draw_modes
from workbench.questions.modes.kinds import mode_kinds
from workbench.questions.modes.mode_file import KeptModes

__all__ = ["PICTURE", "draw"]

PICTURE = "modes.png"
"""In a task's folder."""


def draw(kept: KeptModes, fields: Path, path: Path) -> None:
    """The first modes that are no rigid motions, of those that share a frequency one alone, from their VTU as a PNG."""
    modes, kinds = kept.modes, mode_kinds(kept)
    shown = [int(group[0]) for group in modes.clusters() if not modes.rigid[group[0]]]
    titles = {
        i + 1: f"{modes.frequency[i]:.1f} Hz, {kinds[i].words}" if modes.growth[i] == 0.0 else "grows" for i in shown
    }
    parity = {i + 1: int(modes.parity[i]) for i in shown} if kept.half else None
    draw_modes(fields, titles, path, parity)
