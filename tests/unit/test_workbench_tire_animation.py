"""Deforming tires in a rover's animation: where the vectors put them, coloured by their strain.

Claim: a tire is drawn where its vectors put it, in the colour of its strain: the first colour at rest wherever it
rolls, the last one where it is strained most. Source: a linear map has the same known strain everywhere.
Negative control: a strained tire in the colour of one at rest is noticed, and rigid wheels have no tires to draw.
"""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.skin import tire_skin
from contracts.errors import InputError
from contracts.terrain import Plane
from rover_dynamics.flexible.flexible_vehicle import FlexibleMotion
from tests.unit.test_workbench_rover_animation import DESIGN, WHEELS, constant, rolling
from workbench.charts.palette import STRAIN_COLOURS
from workbench.charts.stills import View, draw_motion
from workbench.charts.tire_animation import strain_colours, strained_tires
from workbench.questions.rover.animation import write_animation

TIRE = build_tire(replace(thesis_preset(), quadrature=(3, 3, 2)))
REST = tire_skin(TIRE, 2, 2).coordinates.restrict(TIRE.mesh.reference_coordinates())
FloatArray = NDArray[np.float64]


def places() -> NDArray[np.int64]:
    """Rows of a tire's vectors that are positions."""
    return np.asarray(tire_skin(TIRE, 2, 2).coordinates.position_rows)


def on_wheels(squeeze: float = 1.0) -> FloatArray:
    """Vectors (n, 6, n_vectors, 3) of tires that roll with the wheels of `rolling`, squeezed upright by a factor."""
    motion = rolling()
    turned = np.array(
        [[REST @ (np.diag([1.0, 1.0, squeeze]) @ motion.rotations[k, w]).T for w in WHEELS] for k in range(4)]
    )
    turned[:, :, places()] += motion.positions[:, WHEELS, None]
    return turned


def flexible(squeeze: float = 1.0) -> FlexibleMotion:
    motion = rolling()
    known = {field.name: getattr(motion, field.name) for field in fields(motion)}
    vectors = on_wheels(squeeze)
    return FlexibleMotion(**known, vectors=vectors, rates=np.zeros_like(vectors))


def first_colour() -> list[int]:
    return [int(STRAIN_COLOURS[0][i : i + 2], 16) for i in (1, 3, 5)]


def test_colours_run_from_the_first_to_the_last() -> None:
    found = strain_colours(np.array([0.0, 1.0, 7.0]))
    last = [int(STRAIN_COLOURS[-1][i : i + 2], 16) for i in (1, 3, 5)]
    assert found.tolist() == [first_colour(), last, last]


def test_tires_roll_unstrained_and_are_strained_when_squeezed() -> None:
    assert strained_tires(TIRE, flexible().vectors).largest < 1e-12
    squeezed = strained_tires(TIRE, flexible(0.8).vectors)
    assert squeezed.largest == pytest.approx(0.5 * (1.0 - 0.8**2))
    assert squeezed.end == pytest.approx(squeezed.largest)
    assert squeezed.surfaces[0].colours[0, 0].tolist() != first_colour()


def test_a_tire_is_drawn_where_its_vectors_put_it() -> None:
    """From the side, the rim of the deformed tire and nothing else is in the picture."""
    motion, made = flexible(0.8), strained_tires(TIRE, flexible(0.8).vectors)
    hub = motion.positions[2, WHEELS[1]]
    view = View(eye=(0.0, -1.0, 0.0), up=(0.0, 0.0, 1.0), centre=tuple(hub), scale=500.0, size=(240, 240))
    pictures = list(draw_motion([], motion.positions, motion.rotations, view, [made.surfaces[1]]))
    rows, columns = np.nonzero((pictures[2].astype(int).sum(axis=-1)) < 740)
    radius = TIRE.preset.outer_radius * view.scale
    assert (columns.max() - columns.min()) / 2.0 == pytest.approx(radius, abs=2.5)
    assert (rows.max() - rows.min()) / 2.0 == pytest.approx(0.8 * radius, abs=2.5)
    assert columns.mean() == pytest.approx(119.5, abs=2.0)


def test_a_page_on_tires_has_a_legend_and_rigid_wheels_have_none(tmp_path: Path) -> None:
    page = tmp_path / "rover.html"
    write_animation(flexible(0.9), DESIGN, Plane(), page, tire=TIRE, most=2)
    text = page.read_text(encoding="utf-8")
    assert len(constant(text, "frames")) == 2
    assert "9.5 %" in text
    with pytest.raises(InputError, match="shapes of tires"):
        write_animation(rolling(), DESIGN, Plane(), page, tire=TIRE)
