"""Finite-strain statics with contact on DOLFINx/PETSc: solves any tagged hexahedral mesh.

cells, material, contact: what makes forces and tangents. solver: Newton's method, increments, direct solves.
problem: a tagged mesh with supports, loads and contact. wheel: the wheel on the ground, a client of the rest.
verification: benchmarks with known answers.

Start with `problem.static_problem.StaticProblem` and `solver.newton.NewtonSolver` (any mesh, any boundary conditions),
or with `wheel.pressed.solve_wheel` (a wheel pressed on a plane). Nothing heavy is imported before one of these modules
is.
"""
