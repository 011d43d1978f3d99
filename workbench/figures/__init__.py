"""Curves in the page, stills, animations."""
