"""Colours that remain distinct for colour-blind readers (Okabe and Ito, 2008; black and grey added)."""

from __future__ import annotations

__all__ = [
    "ABOVE_YIELD",
    "BAND",
    "INK",
    "MODEL_COLOURS",
    "ORIENTATION_COLOURS",
    "PART_COLOURS",
    "SIGNED_ABOVE_YIELD",
    "SIGNED_COLOURS",
    "STRAIN_COLOURS",
    "STRESS_COLOURS",
]

PART_COLOURS = ("#8f8f8f", "#3b3b3b", "#0072b2", "#e69f00", "#009e73", "#cc79a7", "#d55e00", "#56b4e9", "#f0e442")
ORIENTATION_COLOURS = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#d55e00", "#56b4e9")
MODEL_COLOURS = {"fe": "#1a1a1a", "section": "#009e73", "ancf": "#0072b2", "brush": "#d55e00"}
BAND = "rgba(0, 158, 115, 0.18)"
INK = "#1a1a1a"
ABOVE_YIELD = "#d55e00"
SIGNED_ABOVE_YIELD = "#f0e442"
"""On `SIGNED_COLOURS`, which have a red of their own."""
STRAIN_COLOURS = ("#440154", "#414487", "#2a788e", "#22a884", "#7ad151", "#fde725")
"""Ends and equal steps of viridis, from unstrained to most strained."""
STRESS_COLOURS = ("#ffffd9", "#edf8b1", "#c7e9b4", "#7fcdbb", "#41b6c4", "#1d91c0", "#225ea8", "#253494", "#081d58")
"""YlGnBu (Brewer, 2003), from unstressed to most stressed; light where little is to be seen."""
SIGNED_COLOURS = ("#053061", "#2166ac", "#92c5de", "#f7f7f7", "#f4a582", "#b2182b", "#67001f")
"""Equal steps of RdBu (Brewer, 2003), turned round: blue below zero, red above."""
