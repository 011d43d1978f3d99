"""Assembly: bodies given apart come together, redundant equations are named, impossible starts are refused."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.errors import ConvergenceError, InputError
from rover_dynamics.multibody.assembly import assembly
from rover_dynamics.multibody.body import Frame, body
from rover_dynamics.multibody.formulation import AbsoluteCoordinates, packed
from rover_dynamics.multibody.joint import Joint, JointKind, prismatic, revolute
from rover_dynamics.multibody.model import Drive, MultibodyModel
from rover_dynamics.multibody.motion import ImplicitSteps, Motion, StepControl, integrate
from rover_dynamics.multibody.motion_law import Hold, Turn, UserLaw
from rover_dynamics.multibody.singular_position import SingularPosition
from rover_dynamics.multibody.state import State
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.multibody.verification.mechanisms import constraint_defects, n_four_bar, slider_crank

J = (0.1, 0.1, 0.1)
Z = (0.0, 0.0, 1.0)


def pinned_rod(length: float, base: float) -> MultibodyModel:
    """Two rods of the same length, hinged to the ground a base apart, whose other ends must meet."""
    a, b = body("a", 1.0, J, (0.1, 0.4, 0.0)), body("b", 1.0, J, (base, 0.5, 0.1))
    rods = []
    for name, rod, x in (("foot a", a, 0.0), ("foot b", b, base)):
        rods.append(_hinge(name, "ground", rod.name, (x, 0, 0), (0, -0.5 * length, 0)))
    top = _hinge("top", "a", "b", (0, 0.5 * length, 0), (0, 0.5 * length, 0))
    return MultibodyModel(bodies=(a, b), joints=(*rods, top))


def _hinge(name: str, first: str, second: str, here: tuple[float, ...], there: tuple[float, ...]) -> Joint:
    ends = [Frame(position=np.array(p), rotation=np.eye(3)) for p in (here, there)]
    return Joint(
        name=name, kind=JointKind.REVOLUTE, first=first, second=second, first_frame=ends[0], second_frame=ends[1]
    )


def test_bodies_given_apart_come_together() -> None:
    model = pinned_rod(1.0, 1.2)
    state, every, kept = assembly(model)
    assert max(constraint_defects(model, 0.0, state)) < 1e-10
    assert len(every.equations) == 15
    assert len(kept) == 12  # the loop's joints lock three motions out of its plane twice
    y = TreeCoordinates(model).start()
    np.testing.assert_allclose(TreeCoordinates(model).state(0.0, y).positions, state.positions, atol=1e-9)


def test_velocities_given_apart_are_made_to_fit() -> None:
    model = slider_crank()
    fast = body("crank", 1.0, J, (0.05, 0, 0), velocity=(3.0, 1.0, 2.0), angular_velocity=(1.0, 0, 4.0))
    changed = MultibodyModel(bodies=(fast, *model.bodies[1:]), joints=model.joints)
    state, _, _ = assembly(changed)
    assert constraint_defects(changed, 0.0, state)[1] < 1e-10
    assert abs(state.velocities[0, 5]) > 0.1


def test_an_unreachable_start_is_refused_and_the_open_joint_named() -> None:
    with pytest.raises(
        ConvergenceError,
        match=r"cannot be brought together at t = 0 s.*'top': no motion along .* is still open by .* m; start closer",
    ):
        assembly(pinned_rod(1.0, 2.5))


def test_redundant_equations_of_the_four_bars_are_those_out_of_the_plane() -> None:
    redundant = AbsoluteCoordinates(n_four_bar(2)).equations.redundant
    assert len(redundant) == 6
    assert not any(equation.drive for equation in redundant)
    assert {str(e).split(": ")[1] for e in redundant} <= {
        "no motion along z",
        "x of the first at right angles to z of the second",
        "y of the first at right angles to z of the second",
    }


def test_a_drive_that_fights_a_constraint_is_refused() -> None:
    """Two cranks of a parallelogram, each with a drive of its own."""
    model = n_four_bar(1)
    drives = (Drive(joint="base 0", law=Hold()), Drive(joint="base 1", law=Turn(end=1.0, lasts=1.0)))
    with pytest.raises(
        InputError, match="drive of joint 'base 1' = 0 rad, 0 rad/s: moves what the joints and the other"
    ):
        assembly(MultibodyModel(bodies=model.bodies, joints=model.joints, drives=drives))
    assembly(MultibodyModel(bodies=model.bodies, joints=model.joints, drives=drives[1:]))


def test_a_drive_that_starts_against_a_dead_centre_is_refused() -> None:
    """The piston stands at the end of its stroke and is told to go on."""
    model = slider_crank()
    law = UserLaw(function=lambda t: (t, 1.0, 0.0))
    drive = Drive(joint="cylinder", law=law, coordinate="distance")
    with pytest.raises(InputError, match=r"drive|velocity at the start"):
        assembly(MultibodyModel(bodies=model.bodies, joints=model.joints, drives=(drive,)))


@pytest.mark.parametrize("control", [StepControl(), ImplicitSteps()])
def test_a_drive_that_leaves_the_mechanisms_reach_ends_the_motion_there(control: StepControl | ImplicitSteps) -> None:
    """The second foot slides from 1.2 to 3 m off the first; two rods of 1 m reach 2 m, at 0.47 s."""
    rods = pinned_rod(1.0, 1.2)
    foot = body("foot", 1.0, J, (1.2, 0, 0))
    rail = prismatic("rail", "ground", foot, at=(1.2, 0, 0), axis=(1, 0, 0))
    on_foot = _hinge("foot b", "foot", "b", (0, 0, 0), (0, -0.5, 0))
    joints = (rail, rods.joints[0], on_foot, rods.joints[2])
    drive = Drive(joint="rail", law=Turn(end=1.8, lasts=1.0), coordinate="distance")
    model = MultibodyModel(bodies=(*rods.bodies, foot), joints=joints, drives=(drive,))
    with pytest.raises(ConvergenceError, match=r"motion stopped at t = 0\.4\d* s of 1 s: ") as found:
        integrate(TreeCoordinates(model), np.linspace(0.0, 1.0, 11), control)
    assert isinstance(found.value.last_good, Motion)
    assert found.value.last_good.times[-1] == pytest.approx(0.4)


def test_a_hinge_between_free_bodies_needs_no_ground() -> None:
    a, b = body("a", 1.0, J), body("b", 1.0, J, (1, 0, 0))
    model = MultibodyModel(bodies=(a, b), joints=(revolute("hinge", a, b, at=(0.5, 0, 0), axis=Z),))
    assert int(TreeCoordinates(model).tree.v_at[-1]) == 7


def test_a_position_with_one_more_freedom_is_named() -> None:
    """Both windows folded flat: the equations that were independent upright are not any more."""
    formulation = AbsoluteCoordinates(n_four_bar(2))
    flat = [np.sqrt(0.5), 0.0, 0.0, -np.sqrt(0.5)]
    cranks, couplers = [[k + 0.5, 0, 0] for k in range(3)], [[k + 1.5, 0, 0] for k in range(2)]
    folded = State(
        positions=np.array(cranks + couplers, dtype=np.float64),
        orientations=np.array([flat] * 3 + [[1.0, 0, 0, 0]] * 2),
        velocities=np.zeros((5, 6)),
    )
    with pytest.raises(SingularPosition, match="singular position at t = 0 s"):
        formulation.rates(0.0, packed(folded))


@pytest.mark.parametrize(("share", "refused"), [(0.98, True), (1.02, False), (0.0, True)])
def test_dependent_velocities_are_refused_where_they_are_hardly_determined(share: float, refused: bool) -> None:
    """The smallest singular value a little above a thousandth of its share at the start, a little less, or zero."""
    formulation = TreeCoordinates(n_four_bar(2))
    loops = formulation.loops
    matrix = loops.rows(0.0, formulation.motion(0.0, formulation.start())).jacobian[:, loops.dependent]
    left, sizes, right = np.linalg.svd(matrix)
    sizes[-1] *= 1e-3 * share
    wanted = np.linspace(-1.0, 1.0, 2 * len(sizes)).reshape(-1, 2)
    near = (left * sizes) @ right
    if refused:
        with pytest.raises(SingularPosition):
            loops._solved(near, near @ wanted, 0.0)
    else:
        np.testing.assert_allclose(loops._solved(near, near @ wanted, 0.0), wanted, atol=1e-9)
