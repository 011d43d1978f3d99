"""Motion of an ANCF wheel with a hub in its own plane: equations, friction, rest, implicit steps."""
