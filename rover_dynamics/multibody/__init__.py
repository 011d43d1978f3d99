"""A small general multibody engine: rigid bodies, joints, drives, forces; equations 2.24 to 2.26 of the thesis."""
