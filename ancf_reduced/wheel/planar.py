"""An ANCF wheel that bends in its plane alone, as the planar section model does in plane strain.

Verified by tests/verification/test_ancf_wheel_planar.py.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse import coo_array, csc_array

from ancf_reduced.wheel.mesh import AncfWheel
from contracts.errors import InputError

__all__ = ["planar"]


def planar(wheel: AncfWheel) -> AncfWheel:
    """The wheel with one motion for all nodes across a strip: none along the axle, none of r_2 and r_12.

    Raises InputError for sidewall springs, which stand in planes of their own, and for an elastic hub with its cone.
    """
    if np.any(wheel.strips.strip < 0):
        what = "sidewall springs or an elastic hub"
        raise InputError("planar ANCF wheel", what, "bend out of the wheel's plane", "take the wheel whole")
    basis, reference = wheel.basis, wheel.plates.reference
    strip = np.zeros(len(reference), dtype=np.int64)
    strip[wheel.plates.plates.ravel()] = np.repeat(wheel.strips.strip, 4)
    groups, rows = dict[tuple[float, ...], int](), list[tuple[int, int]]()
    for k in range(basis.shape[1]):
        entries = slice(basis.indptr[k], basis.indptr[k + 1])
        first = int(basis.indices[entries][0])
        node, slot = first // 12, first % 12 // 3
        direction = np.zeros(3)
        direction[basis.indices[entries] - 12 * node - 3 * slot] = basis.data[entries]
        if slot > 1 or direction[1] != 0.0:
            continue
        place = reference[node, 0, [0, 2]]
        key = (float(strip[node] if strip[node] else 0), *np.round(1e9 * place), slot, *np.round(1e6 * direction))
        rows.append((k, groups.setdefault(key, len(groups))))
    free, group = np.array(rows).T
    shared = csc_array(coo_array((np.ones(len(free)), (free, group)), shape=(basis.shape[1], len(groups))))
    return replace(wheel, basis=csc_array(basis @ shared), held=csc_array(shared.T @ wheel.held @ shared))
