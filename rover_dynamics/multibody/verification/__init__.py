"""Mechanisms with known motions, built through the engine's public calls, for tests and benchmarks."""
