"""The companion solver of the rover: a multibody engine, the brush tire, vehicles, the rover."""
