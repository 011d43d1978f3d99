"""The airless tire, a client of the rest."""
