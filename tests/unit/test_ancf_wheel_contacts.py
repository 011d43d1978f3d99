"""Contact inside an ANCF wheel: closest points, gaps, slopes, tangents, springs on rim, hub and each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array

from ancf_reduced.thin_plates.plates import ThinPlates
from ancf_reduced.thin_plates.shape_functions import shape_tables
from ancf_reduced.wheel.closest import PlateFace
from ancf_reduced.wheel.contacts import HubContact, Near, PlateContact
from ancf_reduced.wheel.inner_contacts import InnerContacts, inner_contacts
from ancf_reduced.wheel.mesh import AncfWheel, build_ancf_wheel
from ancf_reduced.wheel.static import WheelOnGround, press
from contracts.errors import InputError
from geometry.wheel import exomars_hoops

Array = NDArray[np.float64]
PENALTY = 1e11


@pytest.fixture(scope="module")
def wheel() -> AncfWheel:
    """Three inner hoops without grousers: two legs of neighbours face each other."""
    hoops = exomars_hoops()
    inner = replace(hoops.spring_sets[1], bands=((-60e-3, 60e-3),), thickness=1e-3, phase=0.0)
    design = replace(hoops, grousers=None, spring_sets=(inner,), tire=replace(hoops.tire, thickness=1e-3))
    return build_ancf_wheel(design, element_size=25e-3, axial_size=60e-3)


def shaken(plates: ThinPlates, seed: int, size: float = 3e-4) -> Array:
    """The reference with every vector moved a little."""
    random = np.random.default_rng(seed)
    moved = size * random.standard_normal(plates.reference.shape)
    moved[:, 1:3] *= 30.0
    return np.asarray(plates.reference + moved)


def rim_face(wheel: AncfWheel) -> PlateFace:
    height = 0.5 * np.array([layers[0].thickness for layers in wheel.plates.layers]) * wheel.strips.facing
    return PlateFace(wheel.plates, np.flatnonzero(wheel.strips.strip == 0), height)


def test_closest_points_stand_upright_and_are_found_across_edges(wheel: AncfWheel) -> None:
    """Points put 4 mm above known places of a bent rim are found again, on whichever plate the search began."""
    q, face = shaken(wheel.plates, 3), rim_face(wheel)
    random = np.random.default_rng(0)
    plate = random.choice(face.which, 200)
    place = random.random((200, 2))
    place[:40] = np.clip(place[:40], 0.001, 0.02)  # close to an edge
    rows = shape_tables(wheel.plates.sizes[plate].T, *place.T)
    r, r1, r2 = np.moveaxis(
        np.einsum("ndk,nki->ndi", rows[:, :3], q[wheel.plates.plates[plate]].reshape(-1, 16, 3)), 1, 0
    )
    N = np.cross(r1, r2)
    points = r + 4e-3 * N / np.linalg.norm(N, axis=1)[:, None]
    number, found, tables = face.closest(q, points, 30e-3)
    at = np.einsum("nk,nki->ni", tables[:, 0], q[wheel.plates.plates[found]].reshape(-1, 16, 3))
    assert len(number) == 200
    np.testing.assert_allclose(at, r[number], atol=1e-10)


def test_a_point_beyond_the_rims_side_has_no_closest_point(wheel: AncfWheel) -> None:
    face = rim_face(wheel)
    outside = np.array([[0.0, 65e-3, -0.135], [0.0, 30e-3, -0.135], [0.0, 30e-3, -0.05]])
    assert face.closest(wheel.plates.reference, outside, 20e-3)[0].tolist() == [1]


@pytest.mark.parametrize("kind", ["hub", "rim", "spring"])
def test_slopes_and_tangents_are_derivatives(wheel: AncfWheel, kind: str) -> None:
    """Of gaps by moving closest points, and of the forces they carry: by differences, curvature of both sides in it."""
    plates = wheel.plates
    contacts = inner_contacts(wheel, PENALTY)
    contact: HubContact | PlateContact = {"hub": contacts[0], "rim": contacts[1], "spring": contacts[2]}[kind]
    q = brought_together(wheel, kind)
    contact.search(q)
    forces = np.random.default_rng(5).random(contact.count)
    none = np.zeros((len(plates.plates), 16, 3, 16, 3))

    def at(x: Array) -> tuple[dict[int, float], Array]:
        near = contact.near(x, 0.0 * forces, 0.0 * none)
        held = forces[near.points] * (np.abs(near.gaps) < 1e-3)
        return dict(zip(near.points.tolist(), near.gaps.tolist(), strict=True)), -(near.slopes.T @ held)

    near = contact.near(q, forces * 0.0, 0.0 * none)
    kept = np.abs(near.gaps) < 1e-3
    assert kept.sum() >= 3
    direction = np.random.default_rng(6).standard_normal(plates.reference.shape) * [[1e-2], [1.0], [1.0], [1e1]]
    step = 1e-7
    ahead, behind = at(q + step * direction), at(q - step * direction)
    common = [p for p in near.points[kept].tolist() if p in ahead[0] and p in behind[0]]
    slope = dict(zip(near.points.tolist(), (near.slopes @ direction.ravel()).tolist(), strict=True))
    numeric = np.array([(ahead[0][p] - behind[0][p]) / (2.0 * step) for p in common])
    np.testing.assert_allclose([slope[p] for p in common], numeric, rtol=1e-5, atol=1e-7)
    blocks, loads = none.copy(), np.zeros(contact.count)
    loads[near.points[kept]] = forces[near.points[kept]]
    added = contact.near(q, loads, blocks).tangent
    tangent = plates.assembled(blocks)
    if added is not None:
        tangent = csc_array(coo_array((added[2], added[:2]), shape=tangent.shape))
    change = (ahead[1] - behind[1]) / (2.0 * step)
    assert np.abs(change).max() > 0.0
    np.testing.assert_allclose(tangent @ direction.ravel(), change, atol=2e-5 * np.abs(change).max())


@pytest.mark.parametrize("kind", ["hub", "rim", "spring"])
def test_what_is_near_is_found_although_searches_are_rare(wheel: AncfWheel, kind: str) -> None:
    """From rest to contact and back, a tenth of a millimetre at a time, as a search at every eighth place finds it.

    Without any search after the first nothing is near at the end.
    """
    end, start = brought_together(wheel, kind), wheel.plates.reference
    inner, fresh, once = (InnerContacts(wheel, PENALTY) for _ in range(3))
    none = np.zeros((0, 16, 3, 16, 3))
    forces = [np.zeros(count) for count in inner.counts]
    furthest = float(np.linalg.norm(end - start, axis=2)[:, 0].max())
    shares = np.linspace(0.0, 1.0, max(int(furthest / 1e-4), 10))
    searches = place = 0
    for share in [*shares.tolist(), *shares[::-1].tolist()]:
        q = start + share * (end - start)
        before = inner.parts[0]._near
        found = inner.near(q, forces, none)
        searches += inner.parts[0]._near is not before
        place += 1
        if place % 8 and share < 1.0:
            continue
        for part, near, held in zip(fresh.parts, found, forces, strict=True):
            part.search(q)
            wanted = part.near(q, held, none)
            assert wanted.points.tolist() == near.points.tolist()
            np.testing.assert_allclose(near.gaps, wanted.gaps, rtol=0.0, atol=1e-11)
    assert searches < 0.2 * len(shares)
    lost = [len(part.near(end, held, none).points) for part, held in zip(once.parts, forces, strict=True)]
    there = [len(near.points) for near in fresh_near(fresh, end, forces)]
    assert (sum(lost) < sum(there)) == (kind == "spring")


def fresh_near(inner: InnerContacts, q: Array, forces: list[Array]) -> list[Near]:
    for part in inner.parts:
        part.search(q)
    return [part.near(q, held, np.zeros((0, 16, 3, 16, 3))) for part, held in zip(inner.parts, forces, strict=True)]


def brought_together(wheel: AncfWheel, kind: str) -> Array:
    """A state with points within 1 mm of what they may touch: the first leg moved as a whole, all shaken.

    Its front faces that of the fourth: the next hoop's other leg.
    """
    plates, strips = wheel.plates, wheel.strips
    q = shaken(plates, 7, 3e-5)
    one, four = (np.unique(plates.plates[strips.strip == k]) for k in (1, 4))
    apart = plates.reference[four, 0][:, None] - plates.reference[one, 0][None]
    i, j = np.unravel_index(np.linalg.norm(apart, axis=-1).argmin(), apart.shape[:2])
    length = float(np.linalg.norm(apart[i, j]))
    to_four = apart[i, j] * (1.0 - 1.3e-3 / length)
    q[one, 0] += {"hub": np.array([0.0, 0.0, 0.6e-3]), "rim": np.array([0.0, 0.0, -0.3e-3]), "spring": to_four}[kind]
    return q


def test_what_lies_beside_a_weld_is_left_out_and_nothing_touches_at_rest(wheel: AncfWheel) -> None:
    none = np.zeros((len(wheel.plates.plates), 16, 3, 16, 3))
    for contact in inner_contacts(wheel, PENALTY):
        near = contact.near(wheel.plates.reference, np.zeros(contact.count), none)
        assert (near.gaps >= 10e-6).all()
    assert not none.any()


def test_springs_rest_on_the_rim_instead_of_passing_through() -> None:
    """The hoops' wheel pressed until its springs touch: with contact it is stiffer, and nothing lies 0.1 mm deep.

    Without it points of springs are half a millimetre and more within the rim.
    """
    hoops = exomars_hoops()
    wheel = build_ancf_wheel(hoops, element_size=25e-3, axial_size=60e-3)
    loads, deepest = [], []
    for penalty in (PENALTY, 0.0):
        state = list(
            press(WheelOnGround(wheel, np.pi / 6.0, inner_contact_stiffness=penalty), [6e-3, 12e-3, 18e-3, 24e-3])
        )[-1]
        q = wheel.coordinates(state.free)
        rim = inner_contacts(wheel, PENALTY)[1]
        rim.search(q)
        none = np.zeros((len(wheel.plates.plates), 16, 3, 16, 3))
        deepest.append(float(rim.near(q, np.zeros(rim.count), none).gaps.min()))
        loads.append(state.load)
        assert (state.inner.sum() > 1.0) == (penalty > 0.0)
        assert state.negative == 0
    assert loads[0] > 1.05 * loads[1]
    assert deepest[0] > -0.1e-3
    assert deepest[1] < -0.5e-3


def test_a_penalty_below_zero_is_refused(wheel: AncfWheel) -> None:
    with pytest.raises(InputError, match="inner contact stiffness"):
        WheelOnGround(wheel, 0.0, inner_contact_stiffness=-1.0)
