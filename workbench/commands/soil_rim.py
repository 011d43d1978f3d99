"""How the rim of a study's wheel gives way on soil, by the name of a tire: kept beside the study, or found and kept.

Verified by tests/end_to_end/test_drawbar.py.
"""

from __future__ import annotations

import shlex
import time
from pathlib import Path

from contracts.errors import InputError
from soil.carcass import RIGID, Carcass
from workbench.commands.computing import computed, console, warn
from workbench.execution.result_files import read_result
from workbench.execution.runner import Computing
from workbench.questions.kept import keep, kept, require_numbers, require_place
from workbench.questions.soil.bench import carcass_of
from workbench.questions.soil.graph import CARCASS_MODELS, carcass_name, carcass_tasks
from workbench.questions.soil.held_climbs import brush_rim
from workbench.study.model import Study
from workbench.study.reading import built_in_study

__all__ = ["SOIL_TIRES", "check_soil_tire", "rim_of"]

SOIL_TIRES = ("rigid", "brush", *CARCASS_MODELS)


def check_soil_tire(name: str) -> None:
    """Refuse a tire that does not know soil."""
    if name not in SOIL_TIRES:
        raise InputError("tire on soil", repr(name), "is not known there", f"give {', '.join(SOIL_TIRES)}")


def rim_of(study: Study, tire: str, study_path: Path | None, where: tuple[Path, Computing]) -> Carcass:
    """The rim of the study's wheel by a model; the brush tire's keeps its circle and shifts against the hub.

    study_path : as the user named it; None for the built-in study
    where : store, and how tasks are run
    """
    if tire == "rigid":
        return RIGID
    if tire == "brush":
        return brush_rim(study)
    path = study_path or built_in_study()
    tasks, name = carcass_tasks(study, tire), carcass_name(tire)
    record = kept(study, name, _read)
    state = "stale" if record is None else record.state(tasks)
    if record is not None and state != "stale":
        if state == "older sources":
            console.print(f"rim: kept record of {record.date[:10]}, by older sources of ours", soft_wrap=True)
        return _read(record.found)
    begun = time.monotonic()
    entries = computed(path, tasks, *where)
    found = read_result(entries[name].path)
    try:
        require_place(study, name)
    except InputError as error:
        warn(path, [f"the rim's compliance is not kept beside it: {error}"])
    else:
        typed = "" if study_path is None else f"{shlex.quote(str(study_path))} "
        keep(study, name, f"workbench drawbar {typed}--tire {tire}", tasks, time.monotonic() - begun, found)
    return _read(found)


def _read(found: object) -> Carcass:
    assert isinstance(found, dict)
    require_numbers([*found["compliance"], found["load_N"], *(x for pair in found["curve"] for x in pair)])
    return carcass_of(found)
