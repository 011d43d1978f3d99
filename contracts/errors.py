"""The one error tree of the project.

Every message says what is wrong, the value with its unit, the rule it breaks, and what to try. Libraries raise;
only the command line turns an error into an exit status. Verified by tests/unit/test_errors.py.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

__all__ = [
    "ConvergenceError",
    "IncrementRecord",
    "InputError",
    "LimitLoad",
    "MemoryLimitError",
    "MeshError",
    "MissingLibraryError",
    "StudyError",
    "WorkbenchError",
]


class WorkbenchError(Exception):
    """Base of every error this project raises on purpose; survives the way back from a worker process whole."""

    def __reduce__(self) -> tuple[Callable[..., WorkbenchError], tuple[object, ...]]:
        """Rebuild from text and attributes: the constructors take parts, not the text."""
        return _restored, (type(self), self.args, vars(self))


def _restored(kind: type[WorkbenchError], args: tuple[object, ...], state: dict[str, object]) -> WorkbenchError:
    error = kind.__new__(kind, *args)
    error.__dict__.update(state)
    return error


def _named(what: str, value: str) -> str:
    return f"{what} = {value}" if value else what


class InputError(WorkbenchError, ValueError):
    """A value given to the library breaks a rule.

    Parameters
    ----------
    what : name of the quantity in words, e.g. ``"tire thickness"``
    value : the value as given, with its unit, e.g. ``"-0.6 mm"``; empty for what is missing
    rule : the rule it breaks, e.g. ``"must be greater than zero"``
    hint : what to try, e.g. ``"give a strip thickness such as 0.6 mm"``
    key : attribute of the judged object that the value is, e.g. ``"tire.thickness"``, by which a reader of files finds
        the place; empty where there is none
    """

    def __init__(self, what: str, value: object, rule: str, hint: str, *, key: str = "") -> None:
        self.what, self.value, self.rule, self.hint, self.key = what, str(value), rule, hint, key
        super().__init__(f"{_named(what, self.value)}: {rule}; {hint}")


class StudyError(WorkbenchError, ValueError):
    """A study file cannot be used: names the file, the key, the value, the rule and what to try."""

    def __init__(self, path: Path | str, key: str, value: object, rule: str, hint: str) -> None:
        self.path, self.key, self.value, self.rule, self.hint = str(path), key, str(value), rule, hint
        place = f"{path}: {_named(key, self.value)}" if key else f"{path}"
        super().__init__(f"{place}: {rule}; {hint}")


class MeshError(WorkbenchError):
    """A mesh fails one of its checks (untagged boundary, inverted element, separate pieces, wrong volume)."""


class MemoryLimitError(WorkbenchError):
    """A computation needs more memory than there is.

    Parameters
    ----------
    message : what needs how much, and how much there is
    hint : what to try
    """

    def __init__(self, message: str, hint: str) -> None:
        self.hint = hint
        super().__init__(f"out of memory: {message}; {hint}")


class MissingLibraryError(WorkbenchError):
    """A library is installed but cannot be loaded, since this machine lacks something it needs.

    Parameters
    ----------
    library : what cannot be loaded
    reason : what the system says, e.g. ``"libGLU.so.1: cannot open shared object file"``
    """

    def __init__(self, library: str, reason: str) -> None:
        super().__init__(f"{library} cannot be loaded ({reason}); `workbench doctor` names the command that mends it")


@dataclass(frozen=True, slots=True, kw_only=True)
class IncrementRecord:
    """One attempted load increment of a nonlinear static solve.

    Attributes
    ----------
    target : control parameter at the increment's end [unit of the control, metres for a raised plane]
    step : increment of the control parameter [same unit]
    converged : whether the iteration met its tolerance
    residuals : relative residual norm after each iteration [-]
    """

    target: float
    step: float
    converged: bool
    residuals: tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class LimitLoad:
    """Where a body gives way: equilibrium ends (limit point) or is left by another one (branch point).

    Attributes
    ----------
    branch : whether the drive does no work on the mode: a branch point
    control : control parameter at which the tangent's lowest eigenvalue reaches zero, extrapolated [its unit]
    load : force on the mesh there, extrapolated: of the obstacle, else of the supports that move, else of all
        supports [N]
    left : that eigenvalue at the last converged state over the one at the state before [-]
    part, place : part, and reference place (dim,) [m], of the node that moves most in its mode
    """

    branch: bool
    control: float
    load: float
    left: float
    part: str
    place: tuple[float, ...]


class ConvergenceError(WorkbenchError):
    """A nonlinear solve did not converge; carries the history and how far the solution came.

    Parameters
    ----------
    message : where it stopped, how far it came, what to try
    history : every increment attempted, in order
    last_good : the partial result up to the last converged increment, or None
    limit : the limit load that ended it, if it was one
    """

    def __init__(
        self,
        message: str,
        history: Sequence[IncrementRecord],
        last_good: object | None = None,
        limit: LimitLoad | None = None,
    ) -> None:
        self.history = tuple(history)
        self.last_good = last_good
        self.limit = limit
        super().__init__(message)
