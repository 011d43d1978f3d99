"""Vehicles on flexible tires with a mass of their own: one system of rigid bodies and nodal vectors."""
