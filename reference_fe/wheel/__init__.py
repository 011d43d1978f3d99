"""The wheel on the ground, a client of the rest."""
