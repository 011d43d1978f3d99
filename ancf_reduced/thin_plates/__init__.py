"""Thin ANCF plates: a mid-surface with its slopes, Kirchhoff-Love, no director; they do not lock on curved strips."""
