"""One wheel on a flexible tire moves as the tire's own solver says.

Claim: a free rigid hub with an ANCF tire, as a vehicle of one body whose reference node is eliminated onto the body,
moves by the generalised-alpha method as the same wheel does in `ancf_reduced.tire.wheel_rig`, where the reference node
is one of the coordinates, held orthonormal by constraints and integrated by explicit symplectic steps.
Source: both are thesis eq. 2.26 with the tie of eq. 2.20; they share the plates' forces and nothing else.
Tolerance: 1e-5 m in the hub's place over 60 ms in which the wheel touches down at 0.3 m/s and rolls, a thousandth of
what it travels; 2e-6 m is found at an error allowed of 1e-7 m a step, ten times as much at 1e-4 m.
Negative controls: the tire's mass counted twice, or another viscosity, misses by more than ten times the tolerance.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.motion.explicit import integrate_explicit
from ancf_reduced.motion.plate_system import HubMass
from ancf_reduced.motion.spectrum import stable_step
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.wheel_rig import wheel_rig
from ancf_reduced.tire.wheel_set import wheel_set
from contracts.terrain import Plane
from rover_dynamics.flexible.even_steps import EvenSteps
from rover_dynamics.flexible.flexible_vehicle import FlexibleVehicle, on_flexible_tires, rigid_tire_mass
from rover_dynamics.flexible.implicit_motion import drive_on_flexible_tires
from rover_dynamics.multibody.body import body
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.vehicle.vehicle import Vehicle
from tests.verification import flexible_cart

FloatArray = NDArray[np.float64]
TIRE = build_tire(replace(thesis_preset(), quadrature=(3, 3, 2)))
LAW = ContactLaw(stiffness=1000.0, damping=5.0, friction=0.6, slip_velocity=0.05)
RATIO, MASS, INERTIA, GRAVITY = 0.05, 12.0, 0.08, 3.711
HEIGHT, VELOCITY, SPIN = 0.1435, (0.2, 0.0, -0.3), 0.5
TIMES, TOLERANCE = np.linspace(0.0, 0.06, 7), 1e-5


def vehicle(*, ratio: float = RATIO) -> FlexibleVehicle:
    """The wheel as a vehicle of one body, its tire's mass taken out of it."""
    tires = wheel_set(TIRE, Plane(), 1, law=LAW, damping_ratio=ratio)
    J = rigid_tire_mass(tires)
    tire_inertia = np.trace(J[1:, 1:]) * np.eye(3) - J[1:, 1:]
    hub = body(
        "wheel",
        MASS + float(J[0, 0]),
        INERTIA * np.eye(3) + 0.5 * (tire_inertia + tire_inertia.T),
        (0.0, 0.0, HEIGHT),
        velocity=VELOCITY,
        angular_velocity=(0.0, SPIN, 0.0),
    )
    model = MultibodyModel(bodies=(hub,), gravity=(0.0, 0.0, -GRAVITY))
    return on_flexible_tires(Vehicle(model=model, wheels=("wheel",), terrain=Plane()), tires)


def hub_path(of: FlexibleVehicle, tolerance: float) -> FloatArray:
    """Places of the hub, (n, 3)."""
    steps = EvenSteps(tolerance=tolerance, first=1e-4, spectral_radius=0.9)
    return drive_on_flexible_tires(of, TIMES, steps).positions[:, 0]


@pytest.fixture(scope="module")
def rig_path() -> FloatArray:
    """The same from the tire's own solver."""
    hub = HubMass(mass=MASS, inertia=INERTIA * np.eye(3))
    rig = wheel_rig(TIRE, Plane(), hub=hub, law=LAW, damping_ratio=RATIO, gravity=GRAVITY)
    start = rig.start(np.array([0.0, 0.0, HEIGHT]), np.array(VELOCITY), SPIN)
    step = 0.25 * stable_step(rig.system, start.z)
    states = list(integrate_explicit(rig.system, start, TIMES[1:], step))
    return np.array([rig.hub(start.z), *(rig.hub(state.z) for state in states)])


def test_the_hub_moves_as_in_the_tires_own_solver(rig_path: FloatArray) -> None:
    found = np.abs(hub_path(vehicle(), 1e-7) - rig_path).max()
    print(f"\nlargest difference {found:.2e} m")
    assert found < TOLERANCE
    assert np.ptp(rig_path[:, 2]) > 100.0 * TOLERANCE


def test_a_larger_error_allowed_is_made(rig_path: FloatArray) -> None:
    coarse, fine = (np.abs(hub_path(vehicle(), t) - rig_path).max() for t in (1e-4, 1e-7))
    print(f"\n{coarse:.2e} m at 1e-4, {fine:.2e} m at 1e-7")
    assert coarse > 2.0 * fine


def test_mass_counted_twice_is_noticed(rig_path: FloatArray) -> None:
    """Negative control: the wheel's body keeps the tire's mass."""
    good = vehicle()
    hub = good.vehicle.model.bodies[0]
    heavy = replace(good.vehicle.model, bodies=(replace(hub, mass=hub.mass + 4.4),))
    doubled = replace(good, vehicle=replace(good.vehicle, model=heavy))
    assert np.abs(hub_path(doubled, 1e-6) - rig_path).max() > 10.0 * TOLERANCE


def test_another_viscosity_is_noticed(rig_path: FloatArray) -> None:
    """Negative control."""
    assert np.abs(hub_path(vehicle(ratio=0.3), 1e-6) - rig_path).max() > 10.0 * TOLERANCE


def test_points_that_stick_do_not_shorten_the_steps() -> None:
    """Friction that is all there at 0.1 mm/s: Newton's whole changes go beyond zero slip to and fro, shares end there.

    480 iterations are found. With half of every change instead, the run had not ended after 160 s of processor time.
    """
    law = replace(flexible_cart.LAW, slip_velocity=1e-4)
    moved = drive_on_flexible_tires(
        flexible_cart.cart(law=law, ratio=0.05),
        np.linspace(0.0, 0.1, 3),
        EvenSteps(tolerance=1e-5, first=1e-3, longest=0.05),
    )
    print(f"\n{moved.steps} steps, {moved.rejected} tried again, {moved.iterations} iterations")
    assert moved.iterations < 1000
