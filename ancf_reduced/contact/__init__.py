"""Contact points on faces of plates, and terrain."""
