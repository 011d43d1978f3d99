"""A wheel's mesh from another program: read, completed, checked, in the wheel frame."""
