"""ANCF plates, slope discontinuities, reference node, contact, tire statics and dynamics; import from the modules.

shape_functions, plate_tables, plate_mesh, plate_model, plate_mass, plate_assembly: any network of plates.
elastic_kernels, tangent_kernels, damping_kernels, thickness_kernels: their compiled loops (compiled: numba).
bezier, spline_plates: B-spline surfaces become plates without meshing, and plates B-spline surfaces again.
reference_node, equilibrium: what ties and balances it.
contact_layout, contact_grid, contact_law, plate_contact: what touches the ground (loops: contact_search,
contact_kernels, terrain_kernels).
vector_coordinates, plate_system, mass_factor, linearisation, spectrum: equations of motion of any network.
explicit_dynamics (implicit_damping), implicit_dynamics, energy_account: their integration (rigid_triads,
triad_equations).
tire_preset, tire_mesh, plane_problem, static_tire, tire_surfaces, wheel_rig: the airless tire, a client of the above.
tire_parameters, load_sensitivity, curve_fit, fit_statistics: its parameters from measured or computed curves.
verification: benchmarks with known answers.
"""
