"""Wheels on soil that keeps its ruts, for the rover: a field of cells, and what each wheel feels of it."""
