"""ANCF plates, slope discontinuities, reference node, contact and tire statics; import from the modules.

shape_functions, plate_tables, plate_mesh, plate_model, plate_mass, plate_assembly: any network of plates.
elastic_kernels, tangent_kernels, damping_kernels, thickness_kernels: their compiled loops (compiled: numba).
bezier, spline_plates: B-spline surfaces become plates without meshing, and plates B-spline surfaces again.
reference_node, equilibrium: what ties and balances it.
contact_grid, contact_law, plate_contact: what touches the ground (contact_search, contact_kernels, terrain_kernels).
tire_preset, tire_mesh, plane_problem, static_tire, tire_surfaces: the airless tire, a client of the above.
"""
