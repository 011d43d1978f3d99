"""A tire's parameters from measured or computed curves."""
