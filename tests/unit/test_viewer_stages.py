"""A wheel's stage: its loads, its ground; nothing is interpolated between loads."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.errors import InputError
from tests.small_report_folder import LOADS, POINTS, PRINCIPAL, ring_mesh, write_small_report
from workbench.questions.fe.field_file import write_fields, write_pressures
from workbench.viewer.folder import read_folder
from workbench.viewer.scene import Scene
from workbench.viewer.stages import QUANTITIES, RoverStage, wheel_stage
from workbench.viewer.wheel_body import Cut
from workbench.viewer.wheel_file import read_fields


def test_a_wheel_is_shown_unloaded_and_at_the_loads_that_are_there(tmp_path: Path) -> None:
    write_small_report(tmp_path)
    files = [(one.load, one.path) for one in read_folder(tmp_path).fields if one.orientation == 30.0]
    stage = wheel_stage(30.0, files)
    assert stage.loads == (0.0, 100.0, 200.0)
    assert float(stage.values(0, "stress").max()) == 0.0
    np.testing.assert_allclose(stage.values(2, "stress"), 2.0 * stage.values(1, "stress"))
    down = np.array([np.sin(np.pi / 6), 0.0, -np.cos(np.pi / 6)])
    share = np.clip(ring_mesh().points @ down / 0.14, 0.0, 1.0)
    np.testing.assert_allclose(stage.values(2, "stress"), 4e8 * share, rtol=1e-6)
    assert stage.bar("stress").end == pytest.approx(4e8)
    places = stage.places(2, stage.body)
    corners, _ = stage.ground(2)
    moved = stage.body.places + stage.body.displacement(stage.fields[2])
    np.testing.assert_allclose(-places[:, 2], moved @ down, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(places, axis=1), np.linalg.norm(moved, axis=1))
    np.testing.assert_allclose(corners[:, 2], places[:, 2].min(), atol=1e-3)


def test_a_wheel_is_shown_at_every_point_of_its_curve(tmp_path: Path) -> None:
    write_small_report(tmp_path)
    found = read_folder(tmp_path)
    files = [(one.load, one.path) for one in found.fields if one.orientation == 0.0]
    stage, path = wheel_stage(0.0, files, found.points["fe", 0.0]), found.points["fe", 0.0]
    assert stage.loads == (0.0, *POINTS)
    np.testing.assert_allclose(stage.values(8, "stress"), 8.0 * stage.values(1, "stress"), rtol=1e-6)
    whole = wheel_stage(0.0, files)
    np.testing.assert_allclose(stage.places(8, stage.body), whole.places(2, whole.body), atol=1e-8)
    np.savez(path, allow_pickle=False, load=[1.0], displacement=np.zeros((1, 8, 3)), von_mises=np.zeros((1, 8)))
    with pytest.raises(InputError, match=r"must hold the \d+ nodes of the mesh"):
        wheel_stage(0.0, files, path)


def test_contact_pressure_is_offered_at_the_loads_that_have_one(tmp_path: Path) -> None:
    write_small_report(tmp_path)
    files = [(one.load, one.path) for one in read_folder(tmp_path).fields if one.orientation == 30.0]
    nodes = len(ring_mesh().points)
    path = tmp_path / "fields" / "fe_phi030_pressure.npz"
    write_pressures([(100.0, np.full(nodes, 1e5)), (200.0, np.full(nodes, 2e5))], path)
    assert read_folder(tmp_path).pressures == {("fe", 30.0): path}
    stage, scene = wheel_stage(30.0, files, pressures=path), Scene()
    grounds = []
    for quantity in ("stress", "pressure", "displacement"):
        stage.show(scene, stage.body.surface(), 2, quantity)
        grounds.append(bool(scene._now.below.visibility))
    scene.close()
    assert grounds == [True, False, True], "the ground would hide what presses on it"
    assert set(stage.quantities) == set(QUANTITIES)
    assert [float(stage.values(k, "pressure").max()) for k in range(3)] == pytest.approx([0.0, 1e5, 2e5])
    write_pressures([(100.0, np.full(nodes, 1e5))], path)
    assert wheel_stage(30.0, files, pressures=path).numbers("pressure") == (0, 1)
    write_pressures([], path)
    assert set(QUANTITIES) - set(wheel_stage(30.0, files, pressures=path).quantities) == {"pressure"}
    write_pressures([(100.0, np.ones(8)), (200.0, np.ones(8))], path)
    with pytest.raises(InputError, match=r"must hold the \d+ nodes of the mesh"):
        wheel_stage(30.0, files, pressures=path)
    np.savez(path, load=[100.0])
    with pytest.raises(InputError, match="lacks numbers of load, contact_pressure"):
        wheel_stage(30.0, files, pressures=path)


def test_principal_stresses_are_offered_at_the_loads_that_have_them(tmp_path: Path) -> None:
    """Along a curve there are none; a folder from before them has none at all."""
    write_small_report(tmp_path)
    found = read_folder(tmp_path)
    files = [(one.load, one.path) for one in found.fields if one.orientation == 0.0]
    stage = wheel_stage(0.0, files, found.points["fe", 0.0])
    assert [stage.loads[k] for k in stage.numbers("largest_principal")] == [0.0, *LOADS]
    share = np.clip(-ring_mesh().points[:, 2] / 0.14, 0.0, 1.0)
    number = stage.loads.index(200.0)
    for name, part in (("largest_principal", 0), ("smallest_principal", 2)):
        np.testing.assert_allclose(stage.values(number, name), 2e8 * share * PRINCIPAL[part], rtol=1e-6)
    assert stage.bar("largest_principal").begin == 0.0
    assert stage.bar("smallest_principal").begin == -stage.bar("smallest_principal").end
    for load, path in files:
        field = read_fields(path)[1]
        write_fields(ring_mesh(), field.displacement, field.von_mises, path)
        assert wheel_stage(0.0, [(load, path)]).quantities == ("stress", "displacement")


def test_what_is_drawn_is_what_is_left_by_a_cut(tmp_path: Path) -> None:
    write_small_report(tmp_path)
    files = [(one.load, one.path) for one in read_folder(tmp_path).fields if one.orientation == 30.0]
    stage, scene = wheel_stage(30.0, files), Scene()
    for cut in (Cut(), Cut(axis="y"), Cut(hidden=frozenset({1, 2})), Cut(hidden=frozenset({1}))):
        surface = stage.body.surface(cut)
        for number in (1, 2):
            stage.show(scene, surface, number, "stress")
            (drawn,), actor = scene._now.shapes, scene._now.actors[0]
            assert bool(actor.visibility) == (len(surface.quads) > 0)
            if not actor.visibility:
                continue
            assert (drawn.n_cells, drawn.n_points) == (len(surface.quads), len(surface.places)), cut
            np.testing.assert_allclose(drawn.points, stage.places(number, surface), atol=1e-7)
            expected = stage.bar("stress").colours(stage.values(number, "stress")[surface.nodes])
            np.testing.assert_array_equal(drawn.point_data["colour"], expected)
            assert drawn.active_scalars_name == "colour"
    scene.close()


def test_scene_and_motion_move_what_is_drawn(tmp_path: Path) -> None:
    write_small_report(tmp_path)
    rover, scene = RoverStage(tmp_path / "motions" / "straight_brush.npz"), Scene()
    rover.show(scene, 0)
    first = [actor.user_matrix[0, 3] for actor, _ in scene._now.moving]
    rover.show(scene, len(rover.times) - 1)
    last = [actor.user_matrix[0, 3] for actor, _ in scene._now.moving]
    np.testing.assert_allclose(np.subtract(last, first), 0.5, atol=1e-6)
    camera = rover.camera()
    assert abs(np.linalg.norm(camera.eye) - 1.0) < 1e-12
    assert camera.half_height > 0.3
    scene.close()


def test_the_address_of_an_object_in_the_scene_never_stands_for_another(tmp_path: Path) -> None:
    """The browser knows VTK's objects by address: one that is let go would give its name to another kind of object."""
    write_small_report(tmp_path)
    fields, scene = read_folder(tmp_path).fields, Scene()
    wheels = [wheel_stage(phi, [(f.load, f.path) for f in fields if f.orientation == phi]) for phi in (0.0, 30.0)]
    rover = RoverStage(tmp_path / "motions" / "straight_brush.npz")
    named: dict[str, object] = {}
    renderer = scene._plotter.renderer
    for number in range(12):
        wheel, cut = wheels[number % 2], Cut(hidden=frozenset({number % 3}), axis="xyz"[number % 3])
        wheel.show(scene, wheel.body.surface(cut), number % 3, "stress")
        scene.mark(wheel.body.places[number], 0.01)
        rover.show(scene, number)
        for actor in renderer.GetActors():
            for thing in (actor, actor.GetProperty(), actor.GetMapper(), actor.GetMapper().GetInput()):
                assert named.setdefault(thing.__this__.split("_p_")[0], thing) is thing
    shown = [actor for actor in renderer.GetActors() if actor.GetVisibility()]
    assert len(shown) == len(scene._now.actors) + 1  # and the mark
    scene.close()
