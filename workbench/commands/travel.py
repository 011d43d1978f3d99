"""``workbench stiffness --travel``: the hub of the pressed wheel moved over the ground.

Verified by tests/end_to_end/test_travel.py and tests/unit/test_workbench_travel_files.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from contracts.errors import InputError
from contracts.hub_travel import Way
from contracts.stiffness_matrix import MOTIONS, StiffnessMatrix, stiffness_matrix, write_matrix
from contracts.travel_curve import TravelCurve, write_travel
from workbench.commands.computing import (
    complain_of_early_ends,
    computed,
    console,
    naming,
    read_and_warn,
    tell_kept,
)
from workbench.commands.stiffness import check_orientation
from workbench.execution.result_files import early_ends
from workbench.execution.runner import Computing
from workbench.execution.terminal import empty_table
from workbench.questions.travel_files import travel_curves
from workbench.questions.travels import WORKING_LOAD, travel_tasks
from workbench.report.folders import check_folder, check_targets
from workbench.report.outputs import publish
from workbench.study.orientation import degrees, orientation_name

__all__ = ["check_ways", "run_matrix", "run_travel"]

_SHORT = {name: name.replace("about_", "turn ") for name in MOTIONS}
_NOISE = 1e-4
"""Share of the diagonals' geometric mean below which an entry is not printed [-]."""


def check_ways(names: Sequence[str]) -> tuple[Way, ...]:
    """The ways of some names, each once; ``all`` for each of them."""
    for name in names:
        if name not in (*Way, "all"):
            raise InputError("travel", repr(name), "is not known", f"give {', '.join(Way)} or all")
    return tuple(Way) if "all" in names else tuple(dict.fromkeys(map(Way, names)))


def run_travel(
    study_path: Path,
    model: str,
    travel: tuple[Sequence[str], float | None],
    orientations: tuple[float, ...],
    out: Path,
    store: Path,
    computing: Computing,
) -> int:
    """Curves of force and moment against the hub's travel at the orientations asked for.

    travel : names of ways, a curve each, and load from which the hub moves [N]; None for `WORKING_LOAD`
    """
    ways = check_ways(travel[0])
    check_targets(out, ("travels/any",))
    curves, folders = _solved(study_path, model, (ways, travel[1]), orientations, out, (store, computing), small=False)
    tell_kept(_published(out, model, ways, curves))
    _print(curves)
    _tell_load(travel[1])
    if curves:
        console.print(f"curves: {out / 'travels'}", soft_wrap=True)
    complain_of_early_ends(study_path, early_ends(folders))
    return 0


def run_matrix(
    study_path: Path,
    model: str,
    load: float | None,
    orientations: tuple[float, ...],
    out: Path,
    store: Path,
    computing: Computing,
) -> int:
    """Stiffness matrix of the wheel that stands under a load [N], None for `WORKING_LOAD`, at each orientation."""
    check_targets(out, ("matrices/any",))
    ways = tuple(Way)
    curves, folders = _solved(study_path, model, (ways, load), orientations, out, (store, computing), small=True)
    complain_of_early_ends(study_path, early_ends(folders))
    with naming(study_path):
        asked = dict.fromkeys(curve.orientation_deg for curve in curves)
        found = [stiffness_matrix([curve for curve in curves if curve.orientation_deg == one]) for one in asked]
    texts = dict[str, str]()
    with TemporaryDirectory() as folder:
        for matrix in found:
            path = Path(folder) / "matrix.csv"
            write_matrix(matrix, path)
            texts[f"matrices/{orientation_name(model, matrix.orientation_deg)}.csv"] = path.read_text(encoding="utf-8")
    tell_kept(publish(out, f"stiffness {model} matrix", texts))
    for matrix in found:
        _print_matrix(matrix)
    _tell_load(load)
    console.print(f"matrices: {out / 'matrices'}", soft_wrap=True)
    return 0


def _tell_load(asked: float | None) -> None:
    """Why the load in the table is not that asked for [N]."""
    load = WORKING_LOAD if asked is None else asked
    console.print(
        f"load: the wheel is pressed to where its curve without friction bears {load:g} N; friction adds what is more",
        soft_wrap=True,
    )


def _solved(
    study_path: Path,
    model: str,
    asked: tuple[tuple[Way, ...], float | None],
    orientations: tuple[float, ...],
    out: Path,
    where: tuple[Path, Computing],
    *,
    small: bool,
) -> tuple[list[TravelCurve], dict[str, Path]]:
    """Curves of the ways asked for from a load [N], and the folders of all tasks."""
    ways, load = asked[0], WORKING_LOAD if asked[1] is None else asked[1]
    for orientation in orientations:
        check_orientation(orientation)
    study = read_and_warn(study_path)
    check_folder(out)
    with naming(study_path):
        tasks = travel_tasks(study, model, ways, load, tuple(dict.fromkeys(orientations)), small=small)
    entries = computed(study_path, tasks, *where)
    folders = {name: entry.path for name, entry in entries.items()}
    each = tuple(dict.fromkeys(orientations)) or tuple(degrees(o) for o in study.fe.orientations)
    with naming(study_path):
        return travel_curves(model, ways, each, folders, small=small), folders


def _print_matrix(matrix: StiffnessMatrix) -> None:
    at = f"{matrix.orientation_deg:g} deg, {matrix.load:.0f} N at {1e3 * matrix.deflection:.1f} mm"
    table = empty_table(f"stiffness at {at}", ("resists", *(_SHORT[name] for name in MOTIONS)), texts=["resists"])
    least = _NOISE * np.sqrt(np.abs(np.outer(np.diag(matrix.values), np.diag(matrix.values))))
    for name, row, small in zip(MOTIONS, matrix.values, least, strict=True):
        shown = (f"{value:.4g}" if abs(value) > one else "." for value, one in zip(row, small, strict=True))
        table.add_row(_SHORT[name], *shown)
    console.print(table)
    console.print(
        "each column is a motion of the hub by 1 m or 1 rad, each row the force or moment that resists it, N or N m; "
        f"K differs from its transpose by {matrix.asymmetry:.2%}",
        soft_wrap=True,
    )


def _published(out: Path, model: str, ways: Sequence[Way], curves: Sequence[TravelCurve]) -> list[str]:
    """Write the curves of each way as a set of its own: those of other ways in the folder stay."""
    told = list[str]()
    for way in ways:
        told += publish(out, f"stiffness {model} travel {way}", _texts([one for one in curves if one.way is way]))
    return told


def _texts(curves: Sequence[TravelCurve]) -> dict[str, str]:
    found = {}
    with TemporaryDirectory() as folder:
        for curve in curves:
            path = Path(folder) / "travel.csv"
            write_travel(curve, path)
            name = orientation_name(f"{curve.model}_{curve.way}", curve.orientation_deg)
            found[f"travels/{name}.csv"] = path.read_text(encoding="utf-8")
    return found


def _print(curves: Sequence[TravelCurve]) -> None:
    table = empty_table("what resists the hub", ("way", "orientation", "load", "stiffness", "most"), texts=["way"])
    for curve in curves:
        turn = curve.way.turns
        stiffness = f"{curve.stiffness:.1f} N m/rad" if turn else f"{1e-3 * curve.stiffness:.2f} N/mm"
        most = float(curve.resistance.max())
        largest = f"{most:.3g} N m" if turn else f"{most:.3g} N"
        at = f"{curve.columns['load_N'][0]:.0f} N at {1e3 * curve.deflection:.1f} mm"
        table.add_row(curve.way.value, f"{curve.orientation_deg:g} deg", at, stiffness, largest)
    console.print(table)
