"""The ground of a study in few words: ``"cleat"`` with its sizes, or ``"cleat 20 mm x 12 mm"``, as [fe.obstacle].

Verified by tests/unit/test_workbench_obstacle_option.py and tests/unit/test_workbench_sweep_points.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from contracts.errors import InputError
from workbench.study.sections import FeSection

__all__ = ["OBSTACLES", "ground_words", "obstacle_table", "obstacle_words"]

OBSTACLES: Mapping[str, tuple[str, Mapping[str, str]]] = {
    "step": ("step", {"height": "height", "edge_radius": "edge_radius"}),
    "cleat": ("cleat", {"height": "height", "width": "width", "edge_radius": "edge_radius"}),
    "half_round": ("half_round_rock", {"height": "radius"}),
}
"""Word -> ``fe.obstacle.shape`` of a study, and the keys of [fe.obstacle] that its sizes are."""
_EDGE = {"edge_radius": "5 mm"}
"""Where none is given."""


def obstacle_table(word: str, sizes: Mapping[str, str]) -> dict[str, str]:
    """What [fe.obstacle] of a study would have.

    Parameters
    ----------
    word : one of `OBSTACLES`
    sizes : height, width, edge_radius and offset ahead of the hub, as a user writes lengths; the height of a half-round
        is its radius. An edge radius that is not given is 5 mm

    Raises
    ------
    InputError
        For a word that is not known, and sizes that it lacks or has not.
    """
    if word not in OBSTACLES:
        raise InputError("obstacle", repr(word), "is not known", f"give {', '.join(OBSTACLES)}")
    shape, keys = OBSTACLES[word]
    found = {"shape": shape}
    for name, value in (_EDGE | dict(sizes)).items():
        if name in keys:
            found[keys[name]] = value
        elif name == "offset":
            found["position"] = value
        elif name in sizes:
            raise InputError(name.replace("_", " "), repr(value), f"is not a size of a {word}", "leave it out")
    for name in keys:
        if keys[name] not in found:
            raise InputError(name, "", f"is missing: a {word} has it", f"give its {name}, e.g. '20 mm'")
    return found


def obstacle_words(text: object) -> dict[str, str]:
    """[fe.obstacle] of ``"plane"``, ``"step 20 mm"``, ``"cleat 20 mm x 12 mm"`` or ``"half_round 20 mm"``.

    Raises
    ------
    InputError
        For anything else.
    """
    word, _, rest = str(text).strip().partition(" ")
    if word == "plane" and not rest:
        return {"shape": "plane"}
    given = [part.strip() for part in rest.split(" x ")] if rest.strip() else []
    if len(given) > 2:
        rule = "has more sizes than a height and a width"
        raise InputError("obstacle", repr(text), rule, "write e.g. 'cleat 20 mm x 12 mm'")
    return obstacle_table(word, dict(zip(("height", "width"), given, strict=False)))


def ground_words(fe: FeSection) -> str:
    """``cleat: height 20 mm, width 12 mm, ...`` of what [fe] presses on; nothing of a level plane."""
    sizes = fe.obstacle.model_dump()
    shape, yaw = sizes.pop("shape"), sizes.pop("yaw", 0.0)
    told = [f"{name.replace('_', ' ')} {1e3 * value:g} mm" for name, value in sizes.items()]
    told += [f"{name} {math.degrees(turn):g} deg" for name, turn in (("yaw", yaw), ("camber", fe.camber)) if turn]
    return f"{shape.replace('_', ' ')}: {', '.join(told)}" if told else ""
