"""Rows of the benchmark `ancf_tire`."""
