"""A tagged mesh with supports, loads and contact as one static problem."""
