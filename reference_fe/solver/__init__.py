"""Newton's method, increments, sparse direct solves, checkpoints."""
