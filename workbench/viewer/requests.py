"""What a page may ask of its session, checked before anything is done: a browser sends what it likes.

Verified by tests/unit/test_viewer_requests.py and tests/end_to_end/test_view_safety.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeGuard

import msgpack  # type: ignore[import-untyped]

from workbench.viewer.modes_tab import AMPLITUDES
from workbench.viewer.rover_tab import SPEEDS
from workbench.viewer.session import Session
from workbench.viewer.wheel_body import AXES, STEPS

__all__ = ["CHOICES", "LONGEST", "Refused", "Request", "allowed_change", "allowed_trigger", "read_request"]

LONGEST = 4 * 1024 * 1024
"""Bytes of a message; a curve file of 1 MB fits."""
_HEADER = 12
"""Bytes before each message: its number, the place of this piece and the size of the whole."""
_LONGEST_NAME = 255
_FARTHEST = 1e9
"""Of a click's ray from the wheel [m]."""


class Refused(ValueError):  # noqa: N818 - it is an answer
    """A request that makes no sense; the text is the answer."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """One call: its number, the method and its arguments."""

    number: str
    method: str
    arguments: list[Any]


def read_request(message: bytes) -> Request:
    """A message as wslink's client sends it, in one piece; raises Refused."""
    place, size = int.from_bytes(message[4:8], "little"), int.from_bytes(message[8:_HEADER], "little")
    if not _HEADER < len(message) <= LONGEST or place != 0 or size != len(message) - _HEADER:
        raise Refused("a message is one piece of at most 4 MB")
    try:
        call = msgpack.unpackb(message[_HEADER:])
    except Exception as error:  # whatever msgpack finds
        raise Refused("a message is a call packed by msgpack") from error
    if not isinstance(call, dict):
        raise Refused("a message is a call")
    number, method, arguments = call.get("id"), call.get("method"), call.get("args", [])
    if not _is_name(number) or not _is_name(method) or not isinstance(arguments, list):
        raise Refused("a call has an id, a method and a list of arguments")
    return Request(number=number, method=method, arguments=arguments)


def allowed_change(session: Session, change: object) -> tuple[str, Any]:
    """Name and value of a choice that the page offers now; raises Refused."""
    if not isinstance(change, dict) or not isinstance(name := change.get("key"), str) or name not in CHOICES:
        raise Refused("a change names one of the page's choices")
    value = change.get("value")
    if not CHOICES[name](session, value):
        raise Refused(f"{name} is offered with other values")
    return name, value


def allowed_trigger(arguments: list[Any]) -> tuple[str, list[Any]]:
    """Name and arguments of a deed; raises Refused."""
    name, given = (arguments[0] if arguments else None), (arguments[1] if len(arguments) > 1 else [])
    if not isinstance(name, str) or name not in _DEEDS or not isinstance(given, list) or not _DEEDS[name](given):
        raise Refused("a trigger is one of the page's, with its own arguments")
    return name, given


def _is_name(value: object) -> TypeGuard[str]:
    return isinstance(value, str) and 0 < len(value) <= _LONGEST_NAME


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _counted(value: object, end: int) -> bool:
    return type(value) is int and 0 <= value < end


def _curves(session: Session, value: object) -> bool:
    if not isinstance(value, list) or not all(isinstance(name, str) and name in session.curves for name in value):
        return False
    return len(set(value)) == len(value)


def _offered(choices: list[dict[str, Any]], value: object) -> bool:
    """Whether this is the value of one of the page's choices; True and 1 + 0j are no 1."""
    return any(type(value) is type(one["value"]) and value == one["value"] for one in choices)


def _parts(session: Session, value: object) -> bool:
    if not isinstance(value, list) or not all(_offered(session.state.parts, tag) for tag in value):
        return False
    return len(set(value)) == len(value)


def _tab(session: Session, value: object) -> bool:
    state = session.state
    there = {"wheel": state.models, "rover": state.scenarios, "modes": state.mode_files}
    return isinstance(value, str) and bool(there.get(value))


CHOICES: Mapping[str, Callable[[Session, Any], bool]] = {
    "tab": _tab,
    "model": lambda session, value: _offered(session.state.models, value),
    "orientation": lambda session, value: _is_number(value) and value in session.state.orientations,
    "load": lambda session, value: _counted(value, len(session.state.loads)),
    "quantity": lambda session, value: _offered(session.state.quantities, value),
    "mark_yield": lambda session, value: isinstance(value, bool) and (session.state.yields or not value),
    "visible": _parts,
    "cut_axis": lambda session, value: isinstance(value, str) and value in ("", *AXES),
    "cut_step": lambda session, value: _counted(value, STEPS + 1),
    "cut_other_side": lambda session, value: isinstance(value, bool),
    "scenario": lambda session, value: isinstance(value, str) and value in session.state.scenarios,
    "tire": lambda session, value: isinstance(value, str) and value in session.state.tires,
    "mode_file": lambda session, value: _offered(session.state.mode_files, value),
    "mode": lambda session, value: _offered(session.state.mode_choices, value),
    "amplitude": lambda session, value: type(value) is int and value in AMPLITUDES,
    "series": lambda session, value: isinstance(value, str) and value in session.state.series_choices,
    "chosen": _curves,
    "frame": lambda session, value: _counted(value, session.state.last_frame + 1),
    "playing": lambda session, value: isinstance(value, bool),
    "speed": lambda session, value: _is_number(value) and value in SPEEDS,
}
"""What a user can choose on ``page.html`` -> whether a value is on offer."""


def _is_ray(given: list[Any]) -> bool:
    """Nothing, or two ends with three coordinates each."""
    if given == [None]:
        return True
    ray = given[0].get("ray") if len(given) == 1 and isinstance(given[0], dict) else None
    ends = ray if isinstance(ray, list) and len(ray) == 2 else []
    return bool(ends) and all(
        isinstance(end, list) and len(end) == 3 and all(_is_number(x) and abs(x) < _FARTHEST for x in end)
        for end in ends
    )


def _is_file(given: list[Any]) -> bool:
    return len(given) == 2 and _is_name(given[0]) and isinstance(given[1], str)


_DEEDS: Mapping[str, Callable[[list[Any]], bool]] = {
    "probe": _is_ray,
    "look": lambda given: not given,
    "add_curve": _is_file,
    "drawn": lambda given: not given,
}
"""Triggers of ``page.html`` -> whether arguments are theirs."""
