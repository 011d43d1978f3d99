"""Benchmarks of ANCF plates with known answers, solved through the same public calls as the tire; one module each.

Each has one function that runs it and returns the numbers measured. Tests in ``tests/verification`` and the report's
section on verification hold them against the published ones; a damaged parameter serves as negative control.
"""
