"""Shape functions of one plate at its integration points, in normalised coordinates: the same for every plate.

With xi^1 = x1/a, xi^2 = x2/b, xi^3 = x3/t and the node coordinates r, r_xi1, r_xi2, r_xi3, thesis eq. 2.13 no longer
contains a, b and t. Points are kept in blocks of `compiled.LANES`; those that fill up the last block have weight zero.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.compiled import LANES
from ancf_reduced.plates.shape_functions import THESIS_SHAPE, PlateShape, gauss_points
from contracts.errors import InputError

__all__ = ["PlateTables", "in_blocks", "plate_tables"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class PlateTables:
    """Quadrature of a plate.

    Attributes
    ----------
    points : (n_points, 3) float [-], (xi, eta, zeta)
    weights : (n_points,) float [-], sum 1
    gauss_weight : (n_blocks, LANES) float [-], the weights in blocks
    shape : (n_points, 16) float [-]
    gradient : (n_blocks, 3, 16, LANES) float [-], derivatives by xi^1, xi^2, xi^3 at the points
    middle_gradient : (n_blocks, 3, 16, LANES) float [-], those on the mid-surface below each point (zeta = 0)

    Verified by tests/unit/test_ancf_plate_tables.py.
    """

    points: FloatArray
    weights: FloatArray
    gauss_weight: FloatArray
    shape: FloatArray
    gradient: FloatArray
    middle_gradient: FloatArray

    def at_points(self, blocks: FloatArray) -> FloatArray:
        """The inverse of `in_blocks`: (..., n_blocks, LANES) as (..., n_points)."""
        return blocks.reshape(*blocks.shape[:-2], -1)[..., : len(self.weights)]


def plate_tables(quadrature: tuple[int, int, int], shape: PlateShape = THESIS_SHAPE) -> PlateTables:
    """Tabulate the shape functions at a Gauss rule with so many points along x1, x2, x3.

    Raises
    ------
    InputError
        For a rule that is not three counts of one or more.
    """
    if len(quadrature) != 3 or min(quadrature) < 1:
        raise InputError("quadrature", quadrature, "needs three counts of 1 or more", "give e.g. (5, 5, 3)")
    points, weights = gauss_points(quadrature)
    unit = np.ones(3)
    middle = points * [1.0, 1.0, 0.0]
    return PlateTables(
        points=points,
        weights=weights,
        gauss_weight=in_blocks(weights),
        shape=shape.value(points, unit),
        gradient=_gradient_blocks(shape.gradient(points, unit)),
        middle_gradient=_gradient_blocks(shape.gradient(middle, unit)),
    )


def _gradient_blocks(gradient: FloatArray) -> FloatArray:
    """(n_points, 3, 16) as (n_blocks, 3, 16, LANES)."""
    return np.ascontiguousarray(np.moveaxis(in_blocks(np.moveaxis(gradient, 0, -1)), -2, 0))


def in_blocks(values: FloatArray) -> FloatArray:
    """Values (..., n_points) as (..., n_blocks, LANES), the last block filled up with zeros."""
    n_points = values.shape[-1]
    n_blocks = -(-n_points // LANES)
    padding = [(0, 0)] * (values.ndim - 1) + [(0, n_blocks * LANES - n_points)]
    return np.pad(values, padding).reshape(*values.shape[:-1], n_blocks, LANES)
