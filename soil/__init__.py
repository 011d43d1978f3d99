"""Soil: its numbers, its laws as scalar functions every model can call or compile, and a wheel that drives on it."""
