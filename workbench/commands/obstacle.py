"""``--obstacle`` of ``workbench stiffness``: the ground of a study, given beside it.

Verified by tests/unit/test_workbench_obstacle_option.py and tests/end_to_end/test_obstacle_option.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from contracts.errors import InputError

__all__ = ["OBSTACLES", "ObstacleChoice", "obstacle_choice"]

OBSTACLES: Mapping[str, tuple[str, Mapping[str, str]]] = {
    "step": ("step", {"height": "height", "edge_radius": "edge_radius"}),
    "cleat": ("cleat", {"height": "height", "width": "width", "edge_radius": "edge_radius"}),
    "half_round": ("half_round_rock", {"height": "radius"}),
}
"""Word of the option -> ``fe.obstacle.shape`` of a study, and the keys of [fe.obstacle] that its sizes are."""
_USED_BY = ("fe", "section", "ancf_wheel")
"""Models that stand on what [fe] says."""
_EDGE = "5 mm"
"""Edge radius where none is given."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ObstacleChoice:
    """What the options say, each length as a user writes it, None where it is not given.

    Attributes
    ----------
    shape : one of `OBSTACLES`
    height, width, edge_radius : see `workbench.study.contact`; the height of a half-round is its radius
    offset : place ahead of the hub

    Raises
    ------
    InputError
        For a shape that is not known, and sizes that it lacks or has not.
    """

    shape: str
    height: str | None = None
    width: str | None = None
    edge_radius: str | None = None
    offset: str | None = None

    def __post_init__(self) -> None:
        if self.shape not in OBSTACLES:
            raise InputError("obstacle", repr(self.shape), "is not known", f"give {', '.join(OBSTACLES)}")
        sizes = OBSTACLES[self.shape][1]
        for name in ("height", "width", "edge_radius"):
            option, given = f"--{name.replace('_', '-')}", getattr(self, name)
            if given is not None and name not in sizes:
                raise InputError(option, repr(given), f"is not a size of a {self.shape}", "leave it out")
            if given is None and name in sizes and name != "edge_radius":
                raise InputError(option, "", f"is missing: a {self.shape} has it", f"give e.g. {option} '20 mm'")

    def table(self) -> dict[str, str]:
        """What [fe.obstacle] of a study would have."""
        shape, sizes = OBSTACLES[self.shape]
        given = {"edge_radius": _EDGE} | {n: v for n in sizes if (v := getattr(self, n)) is not None}
        place = {} if self.offset is None else {"position": self.offset}
        return {"shape": shape} | {key: given[name] for name, key in sizes.items()} | place

    def put_in(self, study: Mapping[str, Any], model: str) -> dict[str, Any]:
        """A study file's table whose [fe] has this obstacle; InputError for a model that does not stand on it."""
        if model not in _USED_BY:
            rule = f"does not stand on what --obstacle says; {', '.join(_USED_BY)} do"
            raise InputError("model", model, rule, "leave out --obstacle")
        fe = study.get("fe")
        return dict(study) | ({"fe": dict(fe) | {"obstacle": self.table()}} if isinstance(fe, Mapping) else {})


def obstacle_choice(shape: str | None, **sizes: str | None) -> ObstacleChoice | None:
    """The choice of the options, None without ``--obstacle``; InputError for sizes without it."""
    if shape is not None:
        return ObstacleChoice(shape=shape, **sizes)
    for name, value in sizes.items():
        if value is not None:
            raise InputError(f"--{name.replace('_', '-')}", repr(value), "is that of an obstacle", "give --obstacle")
    return None
