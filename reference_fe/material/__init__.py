"""Hyperelastic laws, plane states, temperature, stress and stored energy."""
