"""``workbench compare``: two curves from anywhere, with uncertainty and tolerance; a table, and files if wanted.

Verified by tests/end_to_end/test_compare.py.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from contracts.errors import InputError
from workbench.commands.computing import console, tell_kept, warn
from workbench.execution.terminal import empty_table
from workbench.report.folders import check_folder, check_targets
from workbench.report.placing import put_files
from workbench.study.curve_file import MeasuredCurve, load_uncertainty, newtons, read_measured_curve
from workbench.study.magnitudes import require_possible, unusual_curve

if TYPE_CHECKING:
    from workbench.questions.two_curves.pair import CurvePair

__all__ = ["CompareChoices", "run_compare"]

_FINEST = 1e-9
_LEAST_LOAD = 0.01
_RATINGS = ("iso18571",)
_FILES = ("compare.html", "compare.png", "compare.csv", "compare.json")


@dataclass(frozen=True, slots=True, kw_only=True)
class CompareChoices:
    """What a user may say beside the two files.

    Attributes
    ----------
    max_load : the range ends where the reference reaches this load, "250" [N] or with its unit; None for all they share
    uncertainty : of the reference's load, ``"3 %"`` or ``"5 N"``, instead of what its file states
    tolerance : largest relative L2 difference allowed, ``"5 %"``
    out : folder of the page, the picture and the numbers, or None for none
    rating : ``"iso18571"`` for the rating of ISO/TS 18571, which takes seconds to import; None for none
    """

    max_load: str | None = None
    uncertainty: str | None = None
    tolerance: str | None = None
    out: Path | None = None
    rating: str | None = None


def run_compare(curve_path: Path, reference_path: Path, choices: CompareChoices) -> int:
    """Print how far one curve lies from another; 1 if a tolerance was given and is not shown to be met.

    Raises
    ------
    InputError
        For an option or a file that cannot be used.
    """
    from workbench.questions.two_curves.pair import compared

    max_load = None if choices.max_load is None else _max_load(choices.max_load)
    tolerance = None if choices.tolerance is None else _tolerance(choices.tolerance)
    if choices.rating not in (None, *_RATINGS):
        raise InputError("rating", choices.rating, f"must be {' or '.join(_RATINGS)}", "leave it out for none")
    if choices.out is not None:
        check_folder(choices.out)
        check_targets(choices.out, _FILES)
    curve, reference = read_measured_curve(curve_path), read_measured_curve(reference_path)
    for path, one in ((curve_path, curve), (reference_path, reference)):
        warn(path, unusual_curve(one.curve.deflection, one.curve.load))
    if choices.uncertainty is not None:
        stated = load_uncertainty(choices.uncertainty, reference.curve.load)
        reference = replace(reference, uncertainty=stated)
    if max_load is not None:
        _require_in_sight(max_load, reference)
    pair = _rated(compared(curve, reference, max_load, tolerance), choices.rating)
    _print(pair, f"{curve_path.name} against {reference_path.name}")
    if choices.out is not None:
        _write(pair, choices.out)
    return 0 if pair.judgement.outcome in ("passed", "not judged") else 1


def _rated(pair: CurvePair, rating: str | None) -> CurvePair:
    """The pair with the rating asked for."""
    if rating is None:
        return pair
    from workbench.questions.two_curves.rating import iso_18571_rating

    return replace(pair, iso_rating=iso_18571_rating(pair.samples.load, pair.samples.reference))


def _tolerance(text: str) -> float:
    """Largest relative difference [-] from ``"5 %"``."""
    import numpy as np

    try:
        found = float(load_uncertainty(text, np.ones(1), "tolerance")[0])
    except InputError as error:
        raise InputError(error.what, error.value, error.rule, "write it like '5 %'") from error
    if "N" in text or not found > 0.0:
        raise InputError("tolerance", text, "must be a share above zero, not a load", "write it like '5 %'")
    if found < _FINEST:
        rule = f"must not be less than {100.0 * _FINEST:g} %, the digits of a curve file"
        raise InputError("tolerance", text, rule, "write it like '5 %'")
    return found


def _max_load(text: str) -> float:
    """The load to end at [N], one that a wheel may carry."""
    load = newtons("max load", text)
    if not load > 0.0:
        raise InputError("max load", f"{load:g} N", "must be > 0", "give newtons such as 250, or '0.25 kN'")
    require_possible("max load", load, "fe.max_load")
    return load


def _require_in_sight(max_load: float, reference: MeasuredCurve) -> None:
    """Raise InputError for a range that holds next to nothing of the reference: the verdict would be on its first
    points' digits."""
    largest = float(reference.curve.load.max())
    if max_load < _LEAST_LOAD * largest:
        rule = f"is less than {100.0 * _LEAST_LOAD:g} % of the reference's largest load, {largest:.4g} N"
        raise InputError("max load", f"{max_load:g} N", rule, "check its unit, or give a larger one")


def _print(pair: CurvePair, title: str) -> None:
    from workbench.report.compared_page import compared_rows, sentence

    columns = ("quantity", "curve", "reference", "difference")
    table = empty_table(title, columns, texts=["quantity"], folded=columns)
    for row in compared_rows(pair):
        table.add_row(row.quantity, row.curve, row.reference, row.difference)
    console.print(table)
    if pair.judgement.tolerance is not None or pair.judgement.missing:
        text = f"{pair.judgement.outcome}: {sentence(pair)}"
        console.print(text, soft_wrap=True)


def _write(pair: CurvePair, out: Path) -> None:
    from workbench.questions.two_curves.figures import compared_still
    from workbench.report.compared_page import compared_html, compared_table, compared_values
    from workbench.report.outputs import to_json

    contents = {
        "compare.html": compared_html(pair).encode(),
        "compare.png": compared_still(pair),
        "compare.csv": compared_table(pair).encode(),
        "compare.json": to_json(compared_values(pair)).encode(),
    }
    tell_kept(put_files(out, contents, "compare"))
    console.print(f"picture: {out / 'compare.html'}", soft_wrap=True)
