"""rover_dynamics."""
