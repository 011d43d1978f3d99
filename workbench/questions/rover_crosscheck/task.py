"""Task: the rover stands on a fitted ANCF tire in every orientation, six at a time.

Verified by tests/unit/test_workbench_rover_crosscheck.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import TirePreset
from ancf_reduced.tire.wheel_set import WheelSet, wheel_set
from contracts.errors import ConvergenceError, InputError
from contracts.terrain import Plane
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.standing import Standing, stand_under_loads
from workbench.execution.result_files import FAILURE, read_result, write_result
from workbench.questions.rover_crosscheck.results import WheelPoint, lattice
from workbench.study.ancf_tire import preset_from

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["stand"]

_LIGHTER = 0.5
"""Of the density, of which nothing at rest depends: a fitted tire has the mass of the whole wheel, hub included."""
_CONTACT_DAMPING = 10.0
"""Of each point [N s/m]; it only quietens the way to rest."""


def stand(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``result.json``: the wheels' points, SI; or why the rover does not stand on this tire."""
    numbers = read_result(needs[inputs["fit"]])
    if FAILURE in numbers:
        write_result(out, {"points": [], FAILURE: numbers[FAILURE]})
        return 0
    preset = preset_from(numbers["preset"])
    try:
        points = _points(preset, inputs["loads"], progress)
        deflections = [_mean_deflection(preset, ratio) for ratio in inputs["modulus_ratios"]]
    except (InputError, ConvergenceError) as error:
        write_result(out, {"points": [], FAILURE: str(error)})
        return 0
    write_result(out, {"points": [asdict(point) for point in points], "deflections_at_modulus": deflections})
    return 0


def _points(preset: TirePreset, loads: list[float], progress: Progress) -> list[WheelPoint]:
    """All orientations of the tire's period; loads other than the rover's own come after it."""
    design = replace(read_rover(), wheel_radius=preset.zero_radius, wheel_width=preset.width)
    tires, n, found = _tires(preset), len(design.legs), []
    wanted = lattice(360.0 / preset.spokes)
    wheels = [wanted[i % len(wanted)] for i in range(n * -(-len(wanted) // n))]
    for first in range(0, len(wheels), n):
        turned = wheels[first : first + n]
        for rest in stand_under_loads(design, tires, np.radians(turned), [design.static_load, *loads]):
            _check_shape(tires, rest)
            each = zip(turned, rest.load.tolist(), rest.deflection.tolist(), strict=True)
            found += [WheelPoint(mean_load=rest.mean_load, orientation=o, load=f, deflection=d) for o, f, d in each]
        progress((first + n) / len(wheels))
    return found


def _mean_deflection(preset: TirePreset, ratio: float) -> float:
    """Of the standing rover's wheels in six orientations [m], with all stiffness of the tire times a ratio."""
    E, k = ratio * preset.young_modulus, ratio * preset.contact_stiffness
    design = replace(read_rover(), wheel_radius=preset.zero_radius, wheel_width=preset.width)
    turned = 2.0 * np.pi / preset.spokes * np.arange(len(design.legs)) / len(design.legs)
    tires = _tires(replace(preset, young_modulus=E, contact_stiffness=k))
    (rest,) = stand_under_loads(design, tires, turned, [design.static_load])
    _check_shape(tires, rest)
    return float(rest.deflection.mean())


def _tires(preset: TirePreset) -> WheelSet:
    """Without weight, as the FE wheel: a rim's own would press on the ground and not on the spokes."""
    law = ContactLaw(stiffness=preset.contact_stiffness, damping=_CONTACT_DAMPING, friction=0.0)
    tires = wheel_set(build_tire(replace(preset, density=_LIGHTER * preset.density)), Plane(), 6, law=law)
    return replace(tires, weight=np.zeros_like(tires.weight))


def _check_shape(tires: WheelSet, rest: Standing) -> None:
    """Refuse an equilibrium of inverted plates, or of a hub on the ground."""
    smallest = float(tires.system.model.volume_ratio(tires.node_coordinates(rest.vectors)).min())
    reach = tires.tire.preset.zero_radius - tires.tire.preset.hub_radius
    deepest = float(rest.deflection.max())
    if smallest <= 0.0 or deepest >= reach:
        found = f"smallest volume ratio {smallest:.2g}, largest deflection {1e3 * deepest:.3g} mm"
        raise ConvergenceError(f"a tire folded at a mean wheel load of {rest.mean_load:g} N: {found}", [])
