"""Natural frequencies and modes of a body about a state of rest, see docs/theory/vibration.md."""
