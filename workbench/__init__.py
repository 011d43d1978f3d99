"""Command line, study files, task graph and result store, comparison, figures and report.

From Python, with nothing loaded before it is needed:

    >>> import workbench as ww
    >>> study = ww.read_study("my.toml")
    >>> curve = ww.stiffness(study, model="fe", orientation=15)
    >>> curve.load_at(0.01)

`read_study`, `stiffness`, `read_report` and what they return, `Study`, `Curve` and `Report`, are in `workbench.api`;
errors are those of `contracts.errors`. How to: docs/python.md.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from workbench.api import Curve, Report, Series, Study, read_report, read_study, stiffness

__all__ = ["Curve", "Report", "Series", "Study", "read_report", "read_study", "stiffness"]


def __getattr__(name: str) -> object:
    """Load the interface when one of its names is used first."""
    if name not in __all__:
        raise AttributeError(f"module 'workbench' has no attribute {name!r}")
    from workbench import api

    return getattr(api, name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
