"""Equations of motion of any network, their equilibrium and integration."""
