"""The companion solver of the rover: multibody engine, rigid and brush tires, flexible tires, vehicles, the rover."""
