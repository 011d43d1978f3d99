"""The companion solver of the rover: so far a multibody engine and the static radial line of the brush tire."""
