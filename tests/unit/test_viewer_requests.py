"""What a page may ask: everything it offers passes, nothing else does."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import msgpack
import pytest

from workbench.viewer.requests import CHOICES, Refused, allowed_change, allowed_trigger, read_request

OFFERED = {
    "tab": ["wheel", "modes", "rover"],
    "model": ["fe"],
    "orientation": [0, 30.0],
    "load": [0, 2],
    "quantity": ["stress", "displacement", "pressure"],
    "mark_yield": [True, False],
    "visible": [[], [2, 1]],
    "cut_axis": ["", "x", "y", "z"],
    "cut_step": [0, 100],
    "cut_other_side": [True, False],
    "mode_file": [0, 1],
    "mode": [0, 2],
    "amplitude": [1, 30],
    "scenario": ["straight"],
    "tire": ["brush"],
    "series": ["load_N"],
    "chosen": [[], ["fe_average"]],
    "frame": [0, 9],
    "playing": [True, False],
    "speed": [0.1, 10],
}
NOT = (None, -1, 101, 10**30, math.nan, math.inf, 0.7, {}, ["x"], ["fe_average"] * 2, [1, 1], [[]], b"fe", 1 + 0j, "w")
SOME_OFFER = {"cut_axis": ("", "x"), "cut_step": (11,), "amplitude": (11,)}
"""What only these choices offer, to be refused to the others."""


def page() -> Any:
    """A session whose wheel has three loads and whose player ten frames."""
    state = SimpleNamespace(
        models=[{"value": "fe"}],
        quantities=[{"value": name} for name in ("stress", "displacement", "pressure")],
        yields=True,
        parts=[{"value": 1}, {"value": 2}],
        orientations=[0.0, 30.0],
        loads=[0.0, 100.0, 200.0],
        scenarios=["straight"],
        mode_files=[{"value": 0}, {"value": 1}],
        mode_choices=[{"value": 0}, {"value": 1}, {"value": 2}],
        tires=["brush"],
        series_choices={"load_N": "wheel load"},
        last_frame=9,
    )
    return SimpleNamespace(state=state, curves={"fe_average": None})


@pytest.mark.parametrize("name", CHOICES)
def test_what_is_offered_passes_and_nothing_else(name: str) -> None:
    for value in OFFERED[name]:
        assert allowed_change(page(), {"key": name, "value": value}) == (name, value)
    others = [value for one, values in SOME_OFFER.items() for value in values if value not in SOME_OFFER.get(name, ())]
    for value in (*NOT, *others, *([] if name in ("playing", "cut_other_side", "mark_yield") else [True])):
        with pytest.raises(Refused):
            assert allowed_change(page(), {"key": name, "value": value}) is None, value


def test_a_pressure_that_is_not_known_is_not_offered() -> None:
    session = page()
    session.state.quantities = [{"value": name} for name in ("stress", "displacement")]
    with pytest.raises(Refused):
        allowed_change(session, {"key": "quantity", "value": "pressure"})


def test_yield_is_marked_where_strengths_are_known_alone() -> None:
    session = page()
    session.state.yields = False
    assert allowed_change(session, {"key": "mark_yield", "value": False}) == ("mark_yield", False)
    with pytest.raises(Refused):
        allowed_change(session, {"key": "mark_yield", "value": True})


@pytest.mark.parametrize(("tab", "what"), [("wheel", "models"), ("rover", "scenarios"), ("modes", "mode_files")])
def test_a_tab_without_anything_is_not_offered(tab: str, what: str) -> None:
    session = page()
    setattr(session.state, what, [])
    with pytest.raises(Refused):
        allowed_change(session, {"key": "tab", "value": tab})


@pytest.mark.parametrize("change", [None, 3, [], {}, {"key": 1}, {"key": "figure"}, {"key": ["tab"], "value": "wheel"}])
def test_other_changes_are_refused(change: object) -> None:
    with pytest.raises(Refused):
        allowed_change(page(), change)


RAY = {"ray": [[0, 0, 0], [1.0, 0, 0]]}


@pytest.mark.parametrize(
    "arguments",
    [["look"], ["look", [], {}], ["drawn", []], ["probe", [None]], ["probe", [RAY]], ["add_curve", ["a", ""]]],
)
def test_deeds_of_the_page_pass(arguments: list[Any]) -> None:
    assert allowed_trigger(arguments) == (arguments[0], arguments[1] if len(arguments) > 1 else [])


@pytest.mark.parametrize(
    "arguments",
    [
        *([], ["nope"], [["look"]], ["look", [1]], ["look", {}], ["drawn", [1]], ["probe"], ["probe", [RAY, RAY]]),
        *(["probe", [{"ray": one}]] for one in (None, [], [[0, 0, 0]], [[0, 0, 0], [1, 0]], [[True, 0, 0], [1, 0, 0]])),
        *(["probe", [{"ray": [[x, 0, 0], [1, 0, 0]]}]] for x in ("1", math.nan, math.inf, 1e300)),
        *(["add_curve", one] for one in ([], ["a"], ["", "x"], [1, "x"], ["a", b"x"], ["a" * 300, "x"])),
    ],
)
def test_other_deeds_are_refused(arguments: list[Any]) -> None:
    with pytest.raises(Refused):
        allowed_trigger(arguments)


def framed(content: bytes, *, size: int | None = None, offset: int = 0) -> bytes:
    """As wslink's client sends it."""
    numbers = (7, offset, len(content) if size is None else size)
    return b"".join(number.to_bytes(4, "little") for number in numbers) + content


def test_a_call_is_read() -> None:
    call = {"wslink": "1.0", "id": "rpc:c0:1", "method": "trame.trigger", "args": ["look"], "kwargs": {}}
    request = read_request(framed(msgpack.packb(call)))
    assert (request.number, request.method, request.arguments) == ("rpc:c0:1", "trame.trigger", ["look"])


CALL = msgpack.packb({"id": "a", "method": "b"})


@pytest.mark.parametrize(
    "message",
    [
        *(
            b"",
            b"123",
            bytes(8),
            bytes(11),
            bytes(12),
            framed(b""),
            framed(b"\xc1"),
            framed(b"\x91" * 9000),
            framed(CALL + b"\x00"),
        ),
        *(framed(CALL, size=2**31), framed(CALL, offset=1), framed(CALL, size=0), framed(b"\x00" * (5 * 2**20))),
        *(framed(msgpack.packb(one)) for one in (None, [], "x", {}, {"id": "a"}, {"id": 1, "method": "b"})),
        *(framed(msgpack.packb({"id": "a", "method": "b", "args": one})) for one in (None, {}, "x")),
        *(framed(msgpack.packb({"id": one, "method": "b"})) for one in ("", "x" * 300, [], None)),
        framed(b"\x82\xa2id\xa2\xff\xfe\xa6method\xa1b"),
    ],
)
def test_other_messages_are_refused(message: bytes) -> None:
    with pytest.raises(Refused):
        read_request(message)
