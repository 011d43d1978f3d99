"""Finite differences of a plate model's energy and force, which unit tests hold its force and tangent against."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.plates.model import PlateModel

FloatArray = NDArray[np.float64]


def crumpled(model: PlateModel) -> FloatArray:
    """Coordinates (n_nodes, 4, 3) away from the reference: 5 mm in position, 0.1 in the gradients."""
    p = model.mesh.reference_coordinates()
    return p + np.random.default_rng(5).normal(size=p.shape) * np.array([0.005, 0.1, 0.1, 0.1])[:, None]


def force_errors(model: PlateModel, p: FloatArray) -> FloatArray:
    """Relative error of the force as derivative of the energy, (3,): steps in one component only, so that a mix-up of
    directions shows."""
    force = model.elastic_force(p)
    direction = np.random.default_rng(6).normal(size=p.shape) * np.array([0.1, 1, 1, 1])[:, None]
    errors = []
    for i in range(3):
        step = np.zeros_like(p)
        step[..., i] = 1e-5 * direction[..., i]
        difference = (model.elastic_energy(p + step) - model.elastic_energy(p - step)) / 2
        errors.append(abs(difference / float((force * step).sum()) - 1.0))
    return np.array(errors)


def tangent_error(model: PlateModel, p: FloatArray, tangent: FloatArray, size: float = 1e-6) -> float:
    """Largest error of tangent times step over its largest entry, against differences of the force; three steps."""
    rng, errors = np.random.default_rng(7), []
    for _ in range(3):
        step = size * rng.normal(size=p.shape)
        difference = (model.elastic_force(p + step) - model.elastic_force(p - step)) / 2
        expected = (tangent @ step.ravel()).reshape(step.shape)
        errors.append(np.abs(difference - expected).max() / np.abs(expected).max())
    return float(max(errors))


def asymmetry(tangent: FloatArray) -> float:
    """Largest difference from the transpose over the largest entry."""
    return float(np.abs(tangent - tangent.T).max() / np.abs(tangent).max())
