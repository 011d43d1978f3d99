"""Figure of the mesh study. Verified by tests/unit/test_workbench_mesh_study.py."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from contracts.errors import InputError
from workbench.charts.curves import DASHES, MARKERS
from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import ORIENTATION_COLOURS
from workbench.questions.mesh_study.results import MeshStudy

if TYPE_CHECKING:
    from workbench.study.model import Study

__all__ = ["mesh_study_figures"]


def mesh_study_figures(study: Study, results: MeshStudy) -> dict[str, str]:
    """Load over the extrapolated load, or over the finest mesh's, against the square of the element size."""
    figure = empty_figure("(element size / that of the coarsest mesh)²", "load / extrapolated load - 1 [%]")
    for i, (family, deflection) in enumerate(product(results.families, results.deflections)):
        try:
            found = family.convergence(deflection)
        except InputError:
            continue
        sizes = np.array([run.size / family.runs[-1].size for run in family.runs])
        base = found.extrapolated if found.extrapolated is not None else found.values[0]
        figure.add_scatter(
            x=sizes**2,
            y=100.0 * (np.array(found.values) / base - 1.0),
            error_y={"type": "data", "array": [100.0 * found.index_fine, 100.0 * found.index_medium,
                                               100.0 * found.index_coarse], "thickness": 1.2, "width": 5},
            name=f"{family.orientation_deg:g}°, {1e3 * deflection:g} mm",
            mode="lines+markers",
            line={"color": ORIENTATION_COLOURS[i % 6], "width": 2.0, "dash": DASHES[i % 6]},
            marker={"symbol": MARKERS[i % 6], "size": 9},
            hovertemplate="%{y:.3f} %",
        )  # fmt: skip
    return {"mesh_study": figure_html(figure, "mesh-study")}
