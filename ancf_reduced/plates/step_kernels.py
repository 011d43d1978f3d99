"""Compiled loop over all plates of a mesh: elastic tangent and damping matrix of a time step, in one pass.

An implicit step needs w_q K + w_v C with the elastic tangent K and the damping matrix C of `tangent_kernels` and
`damping_kernels`. Most of the time of either goes into the sums over pairs of functions; here both are added at the
points and summed once. Verified by tests/unit/test_ancf_damping.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.compiled import LANES, compiled
from ancf_reduced.plates.damping_kernels import add_viscous_stiffness, dual_vectors, products_of
from ancf_reduced.plates.elastic_kernels import base_vectors, gather
from ancf_reduced.plates.tangent_kernels import (
    add_stiffness,
    mirror,
    point_stiffness,
    stresses_and_normals,
    to_structure,
)

__all__ = ["step_matrix_kernel"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@compiled
def step_matrix_kernel(
    p: FloatArray,
    elements: IntArray,
    frame: FloatArray,
    D: FloatArray,
    metric: FloatArray,
    weights: tuple[FloatArray, FloatArray],
    lame: tuple[float, float],
    viscosity: tuple[float, float],
    matrix: FloatArray,
) -> None:
    """Sum of both for each plate, symmetric.

    Parameters
    ----------
    p, elements, frame, D, metric : as `elastic_kernels.energy_kernel`
    weights : those of the elastic points and (n_blocks, LANES) those of Gauss
    lame, viscosity : lambda and mu times w_q, lambda_v and mu_v times w_v
    matrix : (n_plates, 48, 48) float, overwritten, laid out as in `tangent_kernels.tangent_kernel`
    """
    e, half, volume = np.empty((16, 3)), np.empty((48, 48)), np.empty(LANES)
    g, h, S, B = np.empty((3, 3, LANES)), np.empty((3, 3, LANES)), np.empty((6, LANES)), np.empty((6, LANES))
    dual, products = np.empty((3, 3, LANES)), np.empty((6, LANES))
    A, moduli = np.empty((9, 9, LANES)), np.empty((2, LANES))
    w, c = weights
    matrix[:] = 0.0
    for plate in range(len(elements)):
        gather(p, elements[plate], frame[plate], e)
        for k in range(len(D)):
            base_vectors(e, D[k], g)
            for q in range(LANES):
                moduli[0, q], moduli[1, q] = w[plate, k, q] * lame[0], w[plate, k, q] * lame[1]
            stresses_and_normals(g, metric[plate, k], moduli, S, h, B)
            point_stiffness(S, h, B, metric[plate, k, 1], moduli, A)
            dual_vectors(g, dual, volume, c[k])
            products_of(dual, products)
            add_viscous_stiffness(dual, products, volume, viscosity, A)
            add_stiffness(A, D[k], D[k], matrix[plate], True)
        mirror(matrix[plate])
        to_structure(matrix[plate], frame[plate], half)
