"""Rows of the benchmark `rover_ancf`."""
