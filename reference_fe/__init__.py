"""Finite-strain statics with contact on DOLFINx/PETSc: solves any tagged hexahedral mesh.

Start with `static_problem.StaticProblem` and `newton.NewtonSolver` (any mesh, any boundary conditions), or with
`wheel.solve_wheel` (a wheel pressed on a plane). Nothing heavy is imported before one of these modules is.
"""
