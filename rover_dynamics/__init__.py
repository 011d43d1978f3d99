"""The companion solver of the rover: so far the static radial line of the brush tire."""
