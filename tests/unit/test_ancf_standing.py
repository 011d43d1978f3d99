"""Whether a tire stands: eigenvalues of the tangent at its equilibria, and its load on a doubled mesh."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.standing import first_unstable, mesh_change
from ancf_reduced.tire.static import solve_tire


def test_the_thesis_tire_stands_within_its_range() -> None:
    """Up to 35 mm at 0 degrees: its limit load of 258.7 N lies beyond."""
    tire = build_tire(thesis_preset())
    assert first_unstable(tire, solve_tire(tire, 0.0, [0.010, 0.020, 0.030])) is None


def test_a_state_beyond_the_limit_is_told_with_its_mode() -> None:
    """A straight spoke that is squeezed far beyond Euler's load stands no longer, and moves in its middle.

    The tire is scaled, not solved: every node drawn towards the axle by a quarter, as if the ground pressed all around.
    """
    tire = build_tire(replace(thesis_preset(), plates_per_spoke=4))
    states = solve_tire(tire, 0.0, [0.010])
    squeezed = tire.mesh.reference_coordinates()[None].copy()
    squeezed[:, :, 0, [0, 2]] *= 0.75
    squeezed[:, :, 1:] *= 0.75
    found = first_unstable(tire, replace(states, coordinates=squeezed))
    assert found is not None
    assert found.count >= 1
    assert found.deflection == 0.010
    assert 0.0 < found.radius < thesis_preset().outer_radius


def test_twice_as_many_plates_halve_what_the_thesis_tire_carries() -> None:
    """At 45 degrees: its coarse rim holds it up. One orientation and two deflections, by hand beside it."""
    preset = thesis_preset()
    found = mesh_change(preset, np.pi / 4.0, [0.010, 0.020])
    finer = replace(
        preset,
        circumferential_plates=2 * preset.circumferential_plates,
        plates_per_spoke=2 * preset.plates_per_spoke,
        contact_stiffness=0.5 * preset.contact_stiffness,
    )
    loads = [solve_tire(build_tire(p), np.pi / 4.0, [0.010, 0.020]).load for p in (preset, finer)]
    change = loads[1] / loads[0] - 1.0
    assert found.largest == change[np.abs(change).argmax()]
    assert found.largest < -0.3
    assert found.reached == 0.020
