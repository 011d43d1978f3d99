"""Soil as a field of cells that remember how they were pressed and sheared; only touched cells cost.

A cell is a column of soil that one wheel at a time presses, by the laws of `soil.laws`. What it remembers is the
largest depth z_u [m], the line along which it unloads and reloads, p = k_u (z - z_0) with z_0 the depth at which it
carries nothing [m], how far it was sheared ahead and aside in the wheel's axes [m], and when it was last touched: what
has been left by its wheel begins to shear anew. Depths count from the undisturbed surface, z = 0, downwards.

The arrays span the whole field, but the system gives memory to pages that are written only. Method: the Soil Contact
Model as Project Chrono's class reference of ``SCMTerrain`` has it (Bekker, Mohr, Janosi, an elastic stiffness); Krenn
and Hirzinger (2009), from memory. Equations: docs/theory/soil.md 11.4. Verified by tests/unit/test_rover_soil_cells.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contracts.declared import In, require_declared
from contracts.errors import InputError
from contracts.terrain import Plane, Terrain
from soil.carcass import Carcass
from soil.laws import lug_lines
from soil.soil import Soil
from soil.steady_wheel import WheelOnSoil, standing_rim

__all__ = ["CELL", "Ruts", "SoilBed", "SoilField", "SoilGround", "SoilNumbers", "ruts_of"]

FloatArray = NDArray[np.float64]
CELL = 0.01
"""Of the soil, if not said otherwise [m]."""
MOST_CELLS = 40_000_000
"""Of a field; its arrays take 80 bytes a cell of address space."""
AROUND = 0.3
"""Undisturbed soil around ruts [m], as much as a wheel needs beside its path: they can be driven over again."""
AT_ONCE = 200_000
"""Cells whose heights are asked for at once: each takes 16 of a height field's."""
ANGLES = 48
"""To each side of the lowest point, at which the rim's depth is looked at."""
LEAST_SHARE = 0.005
"""Harmonics of a rim that give way less than this share of the hub's way are left out."""


class SoilNumbers(NamedTuple):
    """Soil and wheel, as compiled loops read them.

    Attributes
    ----------
    modulus, exponent : k [N/m^(n+2)] and n [-] of p = k z^n
    least, growth : k_0 [N/m^3] and A_u [N/m^4] of k_u = k_0 + A_u z_u
    shear_modulus : K [m]
    tips, sides : offset [Pa] and slope [-] of the two largest shear stresses over p, see `soil.laws.lug_lines`
    peaks : c_1 and c_2 of theta_m = (c_1 + c_2 s) theta_1 [-]
    slip_sinkage : power of Lyasko's factor [-]
    radius, shear_radius, width : R, m R and b of the wheel [m]
    settling : time in which the rim follows what presses on it [s]
    lag : a damper beside the soil's shear, in time [s]: the strength that is mobilised is that of j + lag dj/dt
    """

    modulus: float
    exponent: float
    least: float
    growth: float
    shear_modulus: float
    tips: tuple[float, float]
    sides: tuple[float, float]
    peaks: tuple[float, float]
    slip_sinkage: float
    radius: float
    shear_radius: float
    width: float
    settling: float
    lag: float


class SoilField(NamedTuple):
    """Cells, row i along x and column j along y; centre of cell (0, 0) at (x, y) [m].

    Attributes
    ----------
    x, y, cell : [m]
    surface : (n, m) float, heights of the undisturbed ground [m], or (0, 0) where it is level
    deepest, carries_from, unloading : (n, m) float, z_u and z_0 [m] and k_u [N/m^3]; all zero where nothing pressed yet
    ahead, aside : (2, n, m) float, how far a cell was sheared in the last steps of even and odd number [m]
    touched : (2, n, m) int, number of that step; 0 for none
    clock : (2,) float, length of the step under way [s] and number of the last step that was kept
    """

    x: float
    y: float
    cell: float
    surface: FloatArray
    deepest: FloatArray
    carries_from: FloatArray
    unloading: FloatArray
    ahead: FloatArray
    aside: FloatArray
    touched: NDArray[np.int64]
    clock: FloatArray


class SoilGround(NamedTuple):
    """What the wheels of one vehicle drive on in one motion.

    Attributes
    ----------
    numbers, field : see there
    compliance : (n,) float, of the rim by harmonics from 0 on [m/N], `soil.carcass`
    rut : (wheels,) float, depth at which the ground ahead of each wheel begins to carry [m]
    depths : (wheels, 2 `ANGLES` + 1) float, working memory
    """

    numbers: SoilNumbers
    field: SoilField
    compliance: FloatArray
    rut: FloatArray
    depths: FloatArray

    @property
    def states(self) -> int:
        """Numbers of state of a wheel."""
        return 2 * len(self.compliance) + 2


class Ruts(NamedTuple):
    """What is left of a drive, cut to where the soil was touched and `AROUND` it.

    Attributes
    ----------
    x, y : (n,), (m,) float, centres of the cells [m]
    depth : (n, m) float, of the ground below the undisturbed surface [m]
    deepest : (n, m) float, to which the soil was pressed [m]
    surface : (n, m) float, heights of the undisturbed ground [m]
    """

    x: FloatArray
    y: FloatArray
    depth: FloatArray
    deepest: FloatArray
    surface: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class SoilBed:
    """Soil under all wheels of a vehicle.

    Attributes
    ----------
    soil, wheel : numbers of the soil; radius, width, rim and lugs of the wheels
    load : that the rim's compliance is a secant at [N]
    gravity : that gives the soil its weight [m/s^2]
    low, high : corners of the field (x, y) [m]
    cell : length of a cell [m]
    settling : time in which a rim follows what presses on it, a damper beside its compliance [s]
    lag : see `SoilNumbers`
    terrain : the undisturbed ground

    Raises
    ------
    InputError
        For a cell that is not above zero or above a sixth of the wheel's width or radius; a field that
        is empty or has more than `MOST_CELLS`; a load that the soil cannot carry.
    """

    soil: Soil
    wheel: WheelOnSoil
    load: Annotated[float, In("N", above=0.0)]
    gravity: Annotated[float, In("m/s^2", above=0.0)]
    low: tuple[float, float]
    high: tuple[float, float]
    cell: Annotated[float, In("m", above=0.0)] = CELL
    settling: Annotated[float, In("s", above=0.0)] = 0.1
    lag: Annotated[float, In("s", least=0.0)] = 0.05
    terrain: Terrain = field(default_factory=Plane)

    def __post_init__(self) -> None:
        require_declared(self, "soil bed")
        largest = min(self.wheel.width, self.wheel.radius) / 6.0
        if self.cell > largest:
            rule = f"must be at most {1e3 * largest:.3g} mm: a sixth of the wheel's width and of its radius"
            raise InputError("cell of the soil", f"{1e3 * self.cell:g} mm", rule, "5 to 20 mm are usual", key="cell")
        n, m = self.shape
        if not (min(n, m) > 0 and n * m <= MOST_CELLS):
            rule = f"must be 1 to {MOST_CELLS:g}"
            raise InputError("cells of the soil", f"{n:g} x {m:g}", rule, "give larger cells or a shorter way")

    @property
    def shape(self) -> tuple[int, int]:
        """Cells along x and y."""
        n, m = (math.ceil((b - a) / self.cell) for a, b in zip(self.low, self.high, strict=True))
        return n, m

    @property
    def compliance(self) -> FloatArray:
        """Of the rim at the load, harmonics that matter, (n,) [m/N]; one zero for a rigid rim."""
        found = np.array(self.wheel.carcass.at(self.load).compliance)
        matter = np.flatnonzero(np.abs(found) > LEAST_SHARE * np.abs(found).sum())
        return found[: int(matter[-1]) + 1] if matter.size else np.zeros(1)

    def standing(self) -> tuple[float, FloatArray]:
        """Height of a hub over the surface at rest under the load [m], and the state of a wheel, (2 n + 2,)."""
        rigid = not self.compliance.any()
        carcass = Carcass() if rigid else Carcass(compliance=tuple(self.compliance.tolist()), load=self.load)
        found, shape = standing_rim(replace(self.wheel, carcass=carcass), self.soil, self.load)
        return found.hub_height, np.zeros(4) if rigid else np.array([*shape.cosines, *shape.sines, 0.0, 0.0])

    def _surface(self) -> FloatArray:
        """Heights of the undisturbed ground at the cells' centres [m], (0, 0) if it is level."""
        if self.terrain == Plane():
            return np.zeros((0, 0))
        n, m = self.shape
        x, y = (low + self.cell * (0.5 + np.arange(k)) for low, k in zip(self.low, (n, m), strict=True))
        some = max(1, AT_ONCE // m)
        places = [np.meshgrid(x[i : i + some], y, indexing="ij") for i in range(0, n, some)]
        return np.concatenate([self.terrain.height(*place) for place in places])

    def ground(self, wheels: int) -> SoilGround:
        """Undisturbed soil under so many wheels."""
        soil, wheel, shape = self.soil, self.wheel, self.shape
        numbers = soil.cohesion, soil.friction_angle, soil.density * self.gravity, soil.rim_angle
        tips, sides = lug_lines(numbers, wheel.lug, wheel.width)
        return SoilGround(
            SoilNumbers(
                modulus=soil.modulus(wheel.width),
                exponent=soil.exponent,
                least=soil.unloading_stiffness,
                growth=soil.unloading_growth,
                shear_modulus=soil.shear_modulus,
                tips=tips,
                sides=sides,
                peaks=(soil.peak_rolling, soil.peak_slipping),
                slip_sinkage=soil.slip_sinkage,
                radius=wheel.radius,
                shear_radius=wheel.shear_radius,
                width=wheel.width,
                settling=self.settling,
                lag=self.lag,
            ),
            SoilField(
                x=self.low[0] + 0.5 * self.cell,
                y=self.low[1] + 0.5 * self.cell,
                cell=self.cell,
                surface=self._surface(),
                deepest=np.zeros(shape),
                carries_from=np.zeros(shape),
                unloading=np.zeros(shape),
                ahead=np.zeros((2, *shape)),
                aside=np.zeros((2, *shape)),
                touched=np.zeros((2, *shape), dtype=np.int64),
                clock=np.zeros(2),
            ),
            self.compliance,
            np.zeros(wheels),
            np.zeros((wheels, 2 * ANGLES + 1)),
        )


def ruts_of(field: SoilField) -> Ruts:
    """What a field remembers of being pressed, with soil around it; empty arrays if nothing was pressed."""
    touched = [np.flatnonzero((field.deepest > 0.0).any(axis=axis)) for axis in (1, 0)]
    if not touched[0].size:
        return Ruts(np.zeros(0), np.zeros(0), *[np.zeros((0, 0))] * 3)
    more = math.ceil(AROUND / field.cell)
    i, j = (
        slice(max(int(one[0]) - more, 0), min(int(one[-1]) + 1 + more, n))
        for one, n in zip(touched, field.deepest.shape, strict=True)
    )
    x, y = field.x + field.cell * np.arange(i.start, i.stop), field.y + field.cell * np.arange(j.start, j.stop)
    depth, deepest = field.carries_from[i, j].copy(), field.deepest[i, j].copy()
    return Ruts(x, y, depth, deepest, field.surface[i, j].copy() if field.surface.size else np.zeros_like(depth))
