"""Ends a motion on ANCF tires in which a tire folds, and says which one, where, and under what load.

Verified by tests/unit/test_workbench_rover_tires.py.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.tire.mesh import RIM
from ancf_reduced.tire.wheel_set import WheelSet
from contracts.errors import ConvergenceError, IncrementRecord
from rover_dynamics.flexible.flexible_system import FlexibleSystem, Instant

__all__ = ["NEARLY", "TRY", "TireShapes", "Watch"]

Watch = Callable[[float, Instant], None]
NEARLY = 0.1
"""Volume ratio of a plate below which a motion that stops is said to stop for it [-]."""
_EACH = 5
"""Steps from one look at the plates to the next; a look takes a third of a step's time."""
TRY = "lower the load, fall less far, or take a stiffer tire: one of more plates, or one fitted to the wheel"


@dataclass(slots=True, eq=False)
class TireShapes:
    """Looks at each step's end, see `watch`.

    Attributes
    ----------
    system : the equations of the motion
    tires : on its wheels
    wheels : their names
    also : what else sees each step's end
    seen : last time [s] and state, or None
    steps : seen so far
    """

    system: FlexibleSystem
    tires: WheelSet
    wheels: Sequence[str]
    also: Watch | None = None
    seen: tuple[float, Instant] | None = None
    steps: int = 0

    def watch(self, t: float, now: Instant) -> None:
        """Raises ConvergenceError for a plate that is inverted: its volume is not above zero somewhere."""
        self.seen, self.steps = (t, now), self.steps + 1
        if self.steps % _EACH == 0 and (ratios := self.ratios(now)).min() <= 0.0:
            message = f"a tire folds at t = {t:g} s: {self._worst(ratios, now)} is inverted; {TRY}"
            raise ConvergenceError(message, [IncrementRecord(target=t, step=0.0, converged=False, residuals=())])
        if self.also is not None:
            self.also(t, now)

    def faults(self, now: Instant) -> tuple[str, float]:
        """The plate of least volume in words, and its volume ratio [-]."""
        ratios = self.ratios(now)
        return self._worst(ratios, now), float(ratios.min())

    def explained(self, error: ConvergenceError) -> ConvergenceError:
        """The error of a motion that stopped, which says whether a tire was about to fold."""
        if self.seen is None or "folds" in str(error):
            return error
        (t, now), ratios = self.seen, self.ratios(self.seen[1])
        if ratios.min() > NEARLY:
            message = f"{error}. No tire is near folding: least volume has {self._worst(ratios, now)} at t = {t:g} s"
            return ConvergenceError(message, error.history, error.last_good)
        message = f"a tire folds at t = {t:g} s, where no step converges: {self._worst(ratios, now)} gives way; {TRY}"
        return ConvergenceError(message, error.history, error.last_good)

    def ratios(self, now: Instant) -> NDArray[np.float64]:
        """Smallest volume ratio of each plate of each tire, (n_w, n_plates) [-]."""
        points = self.tires.system.model.volume_ratio(self.tires.node_coordinates(self.system.whole(now)[0]))
        return np.asarray(points.min(axis=1).reshape(self.tires.n_wheels, -1))

    def _worst(self, ratios: NDArray[np.float64], now: Instant) -> str:
        wheel, plate = np.unravel_index(int(ratios.argmin()), ratios.shape)
        part = "rim" if plate in self.tires.tire.mesh.plates_of(RIM) else "spoke"
        load = self.tires.contacts(*self.system.whole(now)).load[wheel]
        ratio = float(ratios[wheel, plate])
        name = self.wheels[int(wheel)].replace("_", " ")
        mesh = self.tires.tire.mesh
        x, _, z = mesh.points[mesh.elements[plate]].mean(axis=0)
        at = f"at {np.degrees(np.arctan2(x, -z)) % 360.0:.0f} deg of the wheel"
        return f"plate {plate + 1} ({part}, volume ratio {ratio:.2g}, {at}) of {name}, which carries {load:.0f} N,"
