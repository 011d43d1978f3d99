"""reference_fe."""
