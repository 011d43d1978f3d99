"""How a number becomes a check: one function per kind of rule. Verified by tests/unit/test_workbench_checks.py."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from contracts.errors import InputError
from contracts.records import Check, Role, Status
from workbench.verdict.number_format import PERCENT_QUANTITIES, displayed
from workbench.verdict.statements import statement_of

__all__ = ["SURE", "Claim", "Doubt", "at_least", "at_most", "near", "stated", "undecided", "within"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """What a check says, before its number is known: see ``contracts.records.Check`` for the fields."""

    id: str
    title: str
    quantity: str
    unit: str
    role: Role
    source: str


type Number = Callable[[], float]
"""Computes the value; an InputError (curve too short) makes the check's status ``error``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Doubt:
    """How well a number and its reference are known: half ``width`` in the number's unit, and in ``words``."""

    width: float
    words: str


SURE = Doubt(width=0.0, words="")


def near(claim: Claim, number: Number, reference: float, tolerance: float, doubt: Doubt = SURE) -> Check:
    """|value - reference| <= tolerance |reference|, whatever the doubt adds; undecided where it reaches across."""
    value = _evaluate(number)
    beyond = math.nan if value is None else abs(value - reference) - tolerance * abs(reference)
    return _check(claim, value, reference, f"{100.0 * tolerance:g} %", beyond, doubt)


def within(claim: Claim, number: Number, low: float, high: float, doubt: Doubt = SURE) -> Check:
    """low <= value <= high, as `near`."""
    value = _evaluate(number)
    beyond = math.nan if value is None else max(low - value, value - high)
    return _check(claim, value, (low, high), "inside the band", beyond, doubt)


def at_most(claim: Claim, number: Number, limit: float, doubt: Doubt = SURE) -> Check:
    """value <= limit, as `near`."""
    value = _evaluate(number)
    beyond = math.nan if value is None else value - limit
    return _check(claim, value, limit, f"at most {_shown(limit, claim)}", beyond, doubt)


def at_least(claim: Claim, number: Number, limit: float) -> Check:
    """value >= limit."""
    value = _evaluate(number)
    return _check(
        claim, value, limit, f"at least {_shown(limit, claim)}", math.nan if value is None else limit - value, SURE
    )


def undecided(check: Check, why: str) -> Check:
    """The same number, from which nothing follows."""
    return replace(check, tolerance=f"{check.tolerance}; {why}", status="undecided")


def _evaluate(number: Number) -> float | None:
    try:
        value = float(number())
    except InputError:
        return None
    return value if math.isfinite(value) else None


def _check(
    claim: Claim,
    value: float | None,
    reference: float | tuple[float, float],
    tolerance: str,
    beyond: float,
    doubt: Doubt,
) -> Check:
    """``beyond``: by how much the value lies outside of what is allowed, negative within."""
    status: Status = "pass" if beyond + doubt.width <= 0.0 else "fail" if beyond - doubt.width > 0.0 else "undecided"
    words = f"{tolerance}; {doubt.words}" if doubt.words else tolerance
    return stated(claim, value, reference, words, "error" if value is None else status)


def stated(
    claim: Claim,
    value: float | None,
    reference: float | tuple[float, float] | None,
    tolerance: str,
    status: Status,
) -> Check:
    """The check with the words of its family; InputError if it has none, or if nothing is known to break a gate."""
    words = statement_of(claim.id, claim.quantity, claim.title)
    if claim.role == "gate" and not words.broken_by:
        rule = "must have been seen to fail to be a gate"
        raise InputError("check", claim.id, rule, "name in its family's broken_by a test that damages what it guards")
    return Check(
        id=claim.id,
        title=claim.title,
        quantity=claim.quantity,
        unit=claim.unit,
        value=value,
        reference=reference,
        tolerance=tolerance,
        status=status,
        role=claim.role,
        source=f"{claim.source}; {words.paper}" if words.paper else claim.source,
        claim=words.claim,
        why=words.why,
        theory=words.theory,
        tests=words.tests,
    )


def _shown(limit: float, claim: Claim) -> str:
    """The limit as in a sentence: percent for quantities that are fractions of a load, plain exponents."""
    if claim.unit == "-":
        text = f"{100.0 * limit:g} %" if claim.quantity in PERCENT_QUANTITIES else f"{limit:g}"
        return text.replace("e-0", "e-")
    return displayed(limit, claim.unit, claim.quantity)
