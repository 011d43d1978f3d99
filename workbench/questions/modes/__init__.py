"""Natural modes of the study's wheel, by finite elements and by the ANCF wheel, see docs/theory/vibration.md."""
