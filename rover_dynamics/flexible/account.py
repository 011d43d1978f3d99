"""Energy and momentum accounts of a vehicle on flexible tires: what is stored, spent and put in, step by step.

    kinetic + strain + contact + weight + spent (damping, contact damping, friction) - work of drives = constant
    momentum - impulse of weight and ground = constant

Rates are integrated by the trapezoidal rule over the steps of the integrator whose `watch` this is. Bodies hold the
tires' mass in neither: kinetic energy is that of the bodies and that of the tires. Verified by
tests/verification/test_flexible_account.py.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from rover_dynamics.flexible.flexible_system import FlexibleSystem, Instant

__all__ = ["COLUMNS", "FlexibleAccount"]

FloatArray = NDArray[np.float64]

COLUMNS = ("kinetic", "strain", "contact", "weight", "damping", "contact_damping", "friction", "drives")
"""Columns of the account [J]; the last four are sums since the start."""


@dataclass(slots=True, eq=False)
class FlexibleAccount:
    """Collects a row at each step it is shown.

    Attributes
    ----------
    system : the equations of the motion
    times : [s]
    energies : rows as `COLUMNS`
    momenta : rows (3,) [N s], of bodies and tires
    impulses : rows (3,) [N s], of weight and ground since the start
    """

    system: FlexibleSystem
    times: list[float] = field(default_factory=list)
    energies: list[FloatArray] = field(default_factory=list)
    momenta: list[FloatArray] = field(default_factory=list)
    impulses: list[FloatArray] = field(default_factory=list)
    _rates: FloatArray = field(default_factory=lambda: np.zeros(4))
    _force: FloatArray = field(default_factory=lambda: np.zeros(3))

    def watch(self, t: float, now: Instant) -> None:
        """Add a row for the time t [s]."""
        system = self.system
        z, v = system.whole(now)
        tires, masses, g = system.tires.energies(z, v), system.tree.masses, system.gravity
        dead = system.tires.weight[:, None] * g
        stored = np.array(
            [
                _kinetic(system, now) + tires.kinetic,
                tires.strain,
                tires.contact,
                -float(masses @ now.motion.positions[:-1] @ g) - float(np.sum(z * dead)),
            ]
        )
        rates = np.array([tires.damping, tires.contact_damping, tires.friction, system.drive_power(now, t)])
        ground = system.tires.contacts(z, v).force.sum(axis=0)
        force = ground + g * (masses.sum() + len(z) * system.tires.weight[system.tires.position_rows].sum())
        spent, impulse = np.zeros(4), np.zeros(3)
        if self.times:
            half = 0.5 * (t - self.times[-1])
            spent = self.energies[-1][4:] + half * (rates + self._rates)
            impulse = self.impulses[-1] + half * (force + self._force)
        carried = (system.tires.mass[system.tires.position_rows] @ v).sum(axis=(0, 1))
        self.momenta.append(masses @ now.motion.velocities[:-1, :3] + carried)
        self.energies.append(np.concatenate([stored, spent]))
        self.impulses.append(impulse)
        self.times.append(t)
        self._rates, self._force = rates, force

    def table(self) -> FloatArray:
        """Energies (n, 8), columns as `COLUMNS` [J].

        Raises
        ------
        InputError
            If no state has been shown.
        """
        if not self.times:
            raise InputError("energy account", "no states", "needs one or more", "hand its watch to the integrator")
        return np.array(self.energies)

    def energy_closure(self) -> float:
        """Spread of the total over the largest energy that changed hands [-]."""
        table = self.table()
        total = table[:, :7].sum(axis=1) - table[:, 7]
        return float(np.ptp(total) / np.ptp(table, axis=0).max())

    def momentum_closure(self) -> float:
        """Largest gap between change of momentum and impulse over the largest impulse of the weight [-]."""
        gap = np.array(self.momenta) - self.momenta[0] - np.array(self.impulses)
        system = self.system
        total = system.tree.masses.sum() + system.tires.n_wheels * system.tires.weight[system.tires.position_rows].sum()
        weight = total * np.linalg.norm(system.gravity) * (self.times[-1] - self.times[0])
        return float(np.abs(gap).max() / weight)


def _kinetic(system: FlexibleSystem, now: Instant) -> float:
    """Of the rigid bodies [J]."""
    u, R = now.motion.velocities[:-1], now.motion.rotations[:-1]
    spin = np.einsum("bji,bj->bi", R, u[:, 3:])
    turning = np.einsum("bi,bij,bj->", spin, system.tree.inertias, spin)
    return 0.5 * float(system.tree.masses @ np.sum(u[:, :3] ** 2, axis=1) + turning)
