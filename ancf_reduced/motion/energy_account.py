"""Energy account of a motion: what is stored, what is dissipated and what is put in, so that it can be closed.

    kinetic + strain + weight + contact + dissipated (damping, contact damping, friction) - work of drives = constant
Rates are integrated by the trapezoidal rule over the steps of the integrator, whose `watch` this is.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.contact.plate_contact import PlateContact
from ancf_reduced.motion.explicit import MotionState
from ancf_reduced.motion.plate_system import PlateSystem
from contracts.errors import InputError

__all__ = ["EnergyAccount", "EnergyRow"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class EnergyRow:
    """The account at one instant.

    Attributes
    ----------
    time : [s]
    kinetic, strain, dead, contact : stored [J]; ``dead`` is the potential of weights, ``contact`` that of the penalty
    damping, contact_damping, friction : dissipated since the start, >= 0 [J]
    drive : work put in by all other external forces since the start [J]
    """

    time: float
    kinetic: float
    strain: float
    dead: float
    contact: float
    damping: float
    contact_damping: float
    friction: float
    drive: float

    @property
    def total(self) -> float:
        """What must stay constant [J]."""
        stored = self.kinetic + self.strain + self.dead + self.contact
        return stored + self.damping + self.contact_damping + self.friction - self.drive


@dataclass(slots=True)
class EnergyAccount:
    """Collects a row at each step it is shown.

    Verified by tests/verification/test_ancf_wheel_rig.py.
    """

    system: PlateSystem
    rows: list[EnergyRow] = field(default_factory=list)
    _rates: FloatArray = field(default_factory=lambda: np.zeros(4))

    def watch(self, state: MotionState) -> None:
        """Add a row."""
        system = self.system
        p, p_dot = system.coordinates.expand(state.z), system.coordinates.expand_rates(state.v)
        contact, rates = 0.0, np.zeros(4)
        if system.is_damped:
            rates[0] = np.sum(system.model.damping_force(p, p_dot) * p_dot)
        for external in system.external:
            if isinstance(external, PlateContact):
                found = external.power(p, p_dot)
                contact += found.energy
                rates[1:3] += found.damping, found.friction
            else:
                rates[3] += np.sum(external.force(p, p_dot, state.time) * p_dot)
        last = self.rows[-1] if self.rows else None
        spent = np.zeros(4)
        if last is not None:
            before = np.array([last.damping, last.contact_damping, last.friction, last.drive])
            spent = before + 0.5 * (state.time - last.time) * (rates + self._rates)
        self._rates = rates
        self.rows.append(
            EnergyRow(
                time=state.time,
                kinetic=system.kinetic_energy(state.v),
                strain=system.model.elastic_energy(p),
                dead=system.dead_energy(state.z),
                contact=contact,
                damping=float(spent[0]),
                contact_damping=float(spent[1]),
                friction=float(spent[2]),
                drive=float(spent[3]),
            )
        )

    def closure(self) -> float:
        """Spread of the total over the largest energy that changed hands [-]; 0 where none did.

        Raises
        ------
        InputError
            If no state has been shown.
        """
        if not self.rows:
            raise InputError("energy account", "no states", "needs one or more", "hand its watch to the integrator")
        table = np.array([list(asdict(row).values())[1:] for row in self.rows])
        total = np.array([row.total for row in self.rows])
        largest = float(np.ptp(table, axis=0).max())
        return float(np.ptp(total)) / largest if largest > 0.0 else 0.0
