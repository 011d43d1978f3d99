"""A benchmark's numbers as lines of a table, each with its check, and its negative control.

Verified by tests/unit/test_workbench_verification.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from contracts.records import Check
from workbench.verdict.number_format import displayed
from workbench.verdict.rules import Claim, at_least, at_most, near, within

__all__ = ["Benchmark", "Line", "Numbers", "Reader", "Rules", "benchmark_lines"]

type Numbers = Mapping[str, Any]
"""Result of one benchmark's task."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Line:
    """One number of a benchmark.

    Attributes
    ----------
    what : the quantity, as the table names it
    check : value, reference and verdict
    expected : what the value should be; None where only a limit is known
    digits : significant ones worth showing
    """

    what: str
    check: Check
    expected: float | None = None
    digits: int = 4

    @property
    def difference(self) -> float | None:
        """Value over expected value, minus 1 [-]."""
        if self.expected is None or self.check.value is None:
            return None
        return self.check.value / self.expected - 1.0

    @property
    def shown_difference(self) -> str:
        """In percent; that of an order as it is."""
        if self.difference is None or self.expected is None:
            return "–"
        if self.check.quantity == "order":
            return f"{self.difference * self.expected:+.3f}"
        return displayed(self.difference, "-", "difference")

    @property
    def tolerance(self) -> str:
        """How far the value may lie off, in words."""
        if isinstance(self.check.reference, tuple):
            low, high = self.check.reference
            return f"± {0.5 * (high - low):g}"
        return "exact" if self.check.tolerance == "0 %" else self.check.tolerance

    def shown(self, value: float | None) -> str:
        """A value of this line, in its unit and with its digits."""
        if value is None or self.digits <= 4:
            return displayed(value, self.check.unit, self.check.quantity)
        return f"{value:.{self.digits}g} {self.check.unit}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Benchmark:
    """A benchmark with its numbers, and the negative control: what its check says of a damaged copy.

    Attributes
    ----------
    name, title, source : identifier, what it is, and who says what it must give
    lines : its numbers
    control : the damaged copy, which passes if the damage shows
    sound : what the control's check measures on the sound run
    iterations, solve_s : Newton iterations (None where there are none) and wall time [s] of the sound run
    """

    name: str
    title: str
    source: str
    lines: tuple[Line, ...]
    control: Line
    sound: float
    iterations: int | None
    solve_s: float

    @property
    def checks(self) -> list[Check]:
        """Of its numbers and of the control."""
        return [*(line.check for line in self.lines), self.control.check]


@dataclass(frozen=True, slots=True, kw_only=True)
class Rules:
    """Makes the lines of one benchmark: name in identifiers, title, and who says what it must give."""

    name: str
    title: str
    source: str

    def near(self, key: str, what: str, unit: str, pair: Sequence[float], tolerance: float, digits: int = 4) -> Line:
        """Value and expected value, whose sizes may differ by a relative tolerance."""
        value, expected = map(abs, pair)
        check = near(self.claim(key, what, "value", unit), lambda: value, expected, tolerance)
        return Line(what=what, check=check, expected=expected, digits=digits)

    def order(self, key: str, what: str, value: float, expected: float) -> Line:
        """An observed order, which may lie 0.15 off."""
        claim = self.claim(key, what, "order", "-")
        return Line(what=what, check=within(claim, lambda: value, expected - 0.15, expected + 0.15), expected=expected)

    def at_most(self, key: str, what: str, unit: str, value: float, limit: float, quantity: str = "value") -> Line:
        """A value with an upper limit."""
        return Line(what=what, check=at_most(self.claim(key, what, quantity, unit), lambda: value, limit))

    def order_at_least(self, key: str, what: str, value: float, limit: float) -> Line:
        """An observed order, of which only a lower limit is known."""
        return Line(what=what, check=at_least(self.claim(key, what, "order", "-"), lambda: value, limit))

    def caught(
        self, damage: str, numbers: Numbers, limit: float, quantity: str = "difference", unit: str = "-"
    ) -> Line:
        """The negative control: the damaged copy must lie off by this much at least."""
        claim = self.claim("control", f"negative control, {damage}", quantity, unit)
        return Line(what=damage, check=at_least(claim, lambda: float(numbers["damaged"]), limit))

    def benchmark(
        self, numbers: Numbers, lines: Sequence[Line], control: Line, sound: float | None = None
    ) -> Benchmark:
        """The whole; ``sound`` is the size of the first line's difference if left out."""
        return Benchmark(
            name=self.name,
            title=self.title,
            source=self.source,
            lines=tuple(lines),
            control=control,
            sound=abs(lines[0].difference or 0.0) if sound is None else sound,
            iterations=numbers.get("iterations"),
            solve_s=numbers["solve_s"],
        )

    def claim(self, key: str, what: str, quantity: str, unit: str) -> Claim:
        """A gate of this benchmark."""
        return Claim(
            id=f"verify.{self.name}_{key}",
            title=f"{self.title}: {what}",
            quantity=quantity,
            unit=unit,
            role="gate",
            source=self.source,
        )


type Reader = Callable[[Numbers], Benchmark]
"""What a benchmark's numbers say."""


def benchmark_lines(readers: Mapping[str, Reader], results: Mapping[str, Numbers]) -> tuple[Benchmark, ...]:
    """Every benchmark from its task's result by name."""
    return tuple(read(results[name]) for name, read in readers.items())
