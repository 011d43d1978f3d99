"""The viewer: a local page on a report's folder."""
