"""What the rover is asked to do: the thesis' scenarios and the mission's requirements, as records."""
