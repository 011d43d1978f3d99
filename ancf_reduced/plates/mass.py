"""Consistent mass matrix, mass and gravity force of a mesh of plates: constant, because r is linear in p."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.plates.assembly import dense_matrix, plate_rows
from ancf_reduced.plates.model import PlateModel

__all__ = ["flexible_mass", "gravity_force", "mass_blocks", "mass_matrix"]

FloatArray = NDArray[np.float64]


def flexible_mass(model: PlateModel) -> float:
    """Mass of all plates, rho times the integrated reference volume [kg]. Plates that overlap at a T count twice.

    Verified by tests/verification/test_ancf_tire_table.py (4.43 kg).
    """
    return float(model.density * model.volume.sum())


def mass_matrix(model: PlateModel) -> FloatArray:
    """Consistent mass matrix of the mesh, one block per coordinate direction.

    M[m, n] = sum over plates of the integral of rho s_m s_n dV0 (thesis eq. 2.26, M_p, before Cholesky coordinates);
    the kinetic energy is 1/2 sum_i v_i^T M v_i over the directions i, so the full matrix is M kron I.

    Returns
    -------
    mass : (4 n_nodes, 4 n_nodes) float [kg, kg m, kg m^2], row 4 n + c is node n, vector c of (r, r_X, r_Y, r_Z)

    Verified by tests/verification/test_ancf_plate_reference.py.
    """
    return dense_matrix(model.mesh, mass_blocks(model))


def mass_blocks(model: PlateModel) -> FloatArray:
    """The plates' parts of `mass_matrix`, (n_plates, 16, 16) float, for `plates.assembly`."""
    shape = model.shape
    return np.asarray(np.swapaxes(shape * (model.density * model.volume)[..., None], 1, 2) @ shape)


def gravity_force(model: PlateModel, acceleration: FloatArray) -> FloatArray:
    """Generalised force of a uniform gravity field.

    Parameters
    ----------
    model : plates with density
    acceleration : (3,) float [m/s^2], e.g. (0, 0, -3.711)

    Returns
    -------
    force : (n_nodes, 4, 3) float [N, N m]

    Verified by tests/verification/test_ancf_plate_reference.py.
    """
    rows = plate_rows(model.mesh, components=1)
    moments = np.einsum("jg,jga->ja", model.density * model.volume, model.shape)
    total = np.bincount(rows.ravel(), weights=moments.ravel(), minlength=4 * len(model.mesh.points))
    return np.multiply.outer(total.reshape(-1, 4), acceleration)
