"""Contact with rigid obstacles and between parts of the body."""
