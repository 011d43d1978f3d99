"""The longest stable step: from all eigenvalues and from Lanczos iterations, the same in every run."""

from __future__ import annotations

import numpy as np
import pytest

from ancf_reduced.motion import spectrum
from ancf_reduced.motion.plate_system import PlateSystem, build_plate_system
from ancf_reduced.motion.spectrum import natural_frequencies, stable_step
from ancf_reduced.motion.vector_coordinates import all_free
from ancf_reduced.plates.mesh import build_plate_mesh, flat_patch
from ancf_reduced.plates.model import build_plate_model


@pytest.fixture(scope="module")
def strip() -> PlateSystem:
    """Twelve free plates in a row."""
    along, across = np.array([0.1, 0, 0]), np.array([0, 0.08, 0])
    mesh = build_plate_mesh([flat_patch(k * along, along, across, 0.01, "strip") for k in range(12)])
    model = build_plate_model(mesh, young_modulus=1e6, poisson_ratio=0.0, density=1000.0, quadrature=(4, 4, 2))
    return build_plate_system(model, all_free(mesh))


def test_lanczos_finds_the_same_step(strip: PlateSystem, monkeypatch: pytest.MonkeyPatch) -> None:
    """To 1 % below that of all eigenvalues, never above; the same bits each time."""
    z = strip.reference()
    exact = stable_step(strip, z)
    assert exact == pytest.approx(0.8 / (np.pi * natural_frequencies(strip, z).max()), rel=1e-6)
    monkeypatch.setattr(spectrum, "_DENSE", 0)
    found = [stable_step(strip, z) for _ in range(2)]
    assert found[0] == found[1]
    assert 0.98 * exact < found[0] < exact


def test_lanczos_finds_the_same_frequencies(strip: PlateSystem, monkeypatch: pytest.MonkeyPatch) -> None:
    z = strip.reference()
    exact = natural_frequencies(strip, z)[:10]
    monkeypatch.setattr(spectrum, "_DENSE", 0)
    np.testing.assert_allclose(natural_frequencies(strip, z, 10)[6:], exact[6:], rtol=1e-6)
