"""The rover on six ANCF tires that have come to rest, and the motions that are timed."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import TirePreset, thesis_preset
from ancf_reduced.tire.wheel_set import THESIS_LAW, wheel_set
from contracts.terrain import Plane
from rover_dynamics.flexible.even_steps import EvenSteps
from rover_dynamics.flexible.flexible_system import Instant
from rover_dynamics.flexible.flexible_vehicle import FlexibleMotion, FlexibleVehicle, on_flexible_tires
from rover_dynamics.flexible.implicit_motion import drive_on_flexible_tires
from rover_dynamics.multibody.motion_law import SpeedTrapezoid
from rover_dynamics.rover.rover import Actuators, build_rover
from rover_dynamics.rover.rover_file import read_rover

__all__ = ["LAW", "STRAIGHT", "TRACTION", "TimedMotion", "at_rest", "driven", "rover", "row"]

FloatArray = NDArray[np.float64]
DESIGN = read_rover()
SETTLES, SUNK, TORQUE = 5.0, -0.02, 3.5
"""Time before zero in which the rover comes to rest [s]; its height where that begins [m]; traction [N m]."""
LAW = replace(THESIS_LAW, damping_depth=1e-3)
"""The thesis' contact; its damper builds up over a millimetre, see `workbench.questions.rover.tires`."""
STRAIGHT = Actuators(
    laws={
        f"drive_{leg.name}": SpeedTrapezoid(
            speed=70.0 / 3600.0 / DESIGN.wheel_radius, accelerates=5.0, decelerates=5.0, ends=40.0
        )
        for leg in DESIGN.legs
    }
)
TRACTION = Actuators(torques={f"drive_{leg.name}": lambda t: TORQUE if t > 0.0 else 0.0 for leg in DESIGN.legs})


@dataclass(frozen=True, slots=True, kw_only=True)
class TimedMotion:
    """A motion from time zero on, and the processor time it took, settling left out [s]."""

    motion: FlexibleMotion
    seconds: float


def row(case: str, metric: str, unit: str, ours: float) -> dict[str, object]:
    """One line of the table; no other code on the registries has these tires."""
    return {"case": case, "metric": metric, "unit": unit, "ours": ours, "peer": None, "ratio": None}


def rover(
    actuators: Actuators, preset: TirePreset | None = None, *, damping_ratio: float = 0.05, law: ContactLaw = LAW
) -> FlexibleVehicle:
    """The rover with a little of each tire in the ground."""
    vehicle = build_rover(DESIGN, actuators=actuators, height=SUNK)
    tire = build_tire(preset or thesis_preset())
    law = replace(law, stiffness=tire.preset.contact_stiffness)
    tires = wheel_set(tire, Plane(), 6, law=law, damping_ratio=damping_ratio)
    return on_flexible_tires(vehicle, tires)


def driven(vehicle: FlexibleVehicle, end: float, tolerance: float, every: float = 0.1) -> TimedMotion:
    """Settle, then move to ``end`` [s]."""
    begun: dict[str, float] = {}

    def watch(t: float, now: Instant) -> None:
        if t >= 0.0:
            begun.setdefault("at", time.process_time())

    times = np.concatenate([[-SETTLES], np.linspace(0.0, end, round(end / every) + 1)])
    motion = drive_on_flexible_tires(vehicle, times, EvenSteps(tolerance=tolerance), settles_until=0.0, watch=watch)
    return TimedMotion(motion=motion, seconds=time.process_time() - begun["at"])


def at_rest(vehicle: FlexibleVehicle) -> Instant:
    """The state in which the rover stands at time zero."""
    last: dict[str, Instant] = {}

    def keep(t: float, now: Instant) -> None:
        last["instant"] = now

    drive_on_flexible_tires(vehicle, np.array([-SETTLES, 0.0]), EvenSteps(), settles_until=0.0, watch=keep)
    return last["instant"]
