"""Times of wheels in motion by explicit steps of the longest stable length: standing, rolling, six in one mesh."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ancf_reduced.contact.grid import build_contact_grid
from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.contact.plate_contact import PlateContact
from ancf_reduced.motion.explicit import MotionState, integrate_explicit
from ancf_reduced.motion.plate_system import HubMass, PlateSystem, build_plate_system
from ancf_reduced.motion.spectrum import stable_step
from ancf_reduced.motion.vector_coordinates import side_by_side, with_reference_node
from ancf_reduced.plates.mesh import join_meshes
from ancf_reduced.plates.model import build_plate_model
from ancf_reduced.tire.mesh import RIM, Tire, build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.wheel_rig import MARS_GRAVITY, wheel_rig
from benchmarks.ancf_rows.clock import row, shortest
from contracts.terrain import Plane
from workbench.questions.speed.aims import DAMPING_RATIOS, FASTER, wheel_case

__all__ = ["QUADRATURE", "motion_rows", "six_wheels_rows"]

QUADRATURE = (4, 4, 2)
HUB = HubMass(mass=25.0, inertia=0.1 * np.eye(3))
ROLLING, SLIP_VELOCITY = 0.5, 0.1


def motion_rows() -> list[dict[str, object]]:
    """The thesis' tire, 25 kg on its hub: standing, then driven on level ground with contact damping and friction."""
    preset = replace(thesis_preset(), quadrature=QUADRATURE)
    tire, radius = build_tire(preset), preset.outer_radius
    rows = []
    for ratio in DAMPING_RATIOS:
        rig = wheel_rig(tire, Plane(), hub=HUB, damping_ratio=ratio)
        start = rig.start(np.array([0.0, 0.0, radius - 0.01]), np.zeros(3))
        rows += step_rows(wheel_case(ratio), rig.system, start)
    law = ContactLaw(stiffness=preset.contact_stiffness, damping=2.0, friction=0.6, slip_velocity=SLIP_VELOCITY)
    spin = ROLLING / radius
    rig = wheel_rig(tire, Plane(), hub=HUB, law=law, damping_ratio=DAMPING_RATIOS[-1], drive=(spin, 20.0))
    start = rig.start(np.array([0.0, 0.0, radius]), np.array([ROLLING, 0.0, 0.0]), spin)
    case = f"{wheel_case(DAMPING_RATIOS[-1])}, rolling at {ROLLING:g} m/s, mu 0.6, driven"
    return [*rows, *step_rows(case, rig.system, start)]


def step_rows(case: str, system: PlateSystem, start: MotionState) -> list[dict[str, object]]:
    """Explicit motion over 0.2 s from a start."""
    seconds, step = 0.2, stable_step(system, start.z)
    spent = shortest(lambda: list(integrate_explicit(system, start, np.array([seconds]), step)))
    return [
        row(case, "longest stable step", "ms", 1e3 * step),
        row(case, "one step", "us", spent * step / seconds),
        row(case, FASTER, "-", 1e6 * seconds / spent),
    ]


def six_wheels_rows() -> list[dict[str, object]]:
    """Six of these wheels as one mesh against one: all forces on the system, and one explicit step."""
    tire, seconds = build_tire(replace(thesis_preset(), quadrature=QUADRATURE)), 0.05
    times_us, steps_us = [], []
    for wheels in (1, 6):
        system, start = wheels_on_the_ground(tire, wheels)
        step, end = stable_step(system, start.z), np.array([seconds])
        times_us.append(shortest(lambda s=system, b=start: s.force(b.z, b.v)))  # type: ignore[misc]
        spent = shortest(lambda s=system, b=start, e=end, h=step: list(integrate_explicit(s, b, e, h)))  # type: ignore[misc]
        steps_us.append(spent * step / seconds)
    case = "six wheels, one mesh"
    return [
        row(case, "all forces", "us", times_us[1]),
        row(case, "all forces, over those of one wheel", "-", times_us[1] / times_us[0]),
        row(case, "one step", "us", steps_us[1]),
        row(case, "one step, over that of one wheel", "-", steps_us[1] / steps_us[0]),
    ]


def wheels_on_the_ground(tire: Tire, wheels: int) -> tuple[PlateSystem, MotionState]:
    """Wheels of 25 kg in one mesh, 10 mm deep in level ground, half a metre apart."""
    mesh = join_meshes([tire.mesh] * wheels)
    preset = tire.preset
    model = build_plate_model(
        mesh,
        young_modulus=preset.young_modulus,
        poisson_ratio=preset.poisson_ratio,
        density=preset.density,
        quadrature=preset.quadrature,
    )
    grid = build_contact_grid(mesh, mesh.plates_of(RIM), preset.contact_points, preset.contact_layout)
    contact = PlateContact(grid=grid, terrain=Plane().pieces(), law=ContactLaw(stiffness=preset.contact_stiffness))
    system = build_plate_system(
        model,
        side_by_side([with_reference_node(tire.tie)] * wheels),
        gravity=np.array([0.0, 0.0, -MARS_GRAVITY]),
        hubs=(HUB,) * wheels,
        external=(contact,),
    )
    z = system.reference()
    rows = system.coordinates.position_rows.reshape(wheels, -1)
    for k in range(wheels):
        z[rows[k]] += [0.5 * k, 0.0, preset.outer_radius - 0.01]
    return system, MotionState(time=0.0, z=z, v=np.zeros_like(z))
