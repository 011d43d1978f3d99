"""ANCF plates, slope discontinuities, reference node, contact, tire statics and dynamics; import from the modules.

plates: any network of plates, its energy, mass, forces and tangents (loops in the modules named kernels).
`plates.bezier` and `plates.spline_plates`: B-spline surfaces become plates without meshing, and plates B-spline
surfaces again. contact: what touches the ground.
motion: what ties a network to a body, balances it and moves it: `motion.equilibrium`, `motion.explicit`,
`motion.implicit`.
tire: the airless tire, a client of the above.
thin_plates, wheel: plates without director, and a wheel's own design as a network of them, pressed on the ground.
fit: its parameters from measured or computed curves.
verification: benchmarks with known answers.
"""
