"""An obstacle must just touch the body at the start."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.materials import TI_6AL_4V
from reference_fe.contact.obstacle import ObstacleContact
from reference_fe.contact.touch import check_touch
from reference_fe.problem.domain import Domain
from reference_fe.verification.structured_hexahedra import block_mesh

BLOCK = Domain.from_tagged(block_mesh((1, 1, 1), lambda X: X + np.array([0.0, 0.0, 1.0])))
TOUCHING = ObstacleContact(faces=("z0",), normal=(0.0, 0.0, 1.0), distance_at_touch=-1.0)


def test_a_plane_that_touches_to_a_thousandth_is_taken() -> None:
    for distance in (-1.0, -1.0005, -0.9995):
        check_touch(BLOCK, replace(TOUCHING, distance_at_touch=distance), {"body": TI_6AL_4V})


@pytest.mark.parametrize(("distance", "words"), [(-0.99, "10 mm off"), (-1.01, "10 mm inside")])
def test_one_off_or_inside_is_refused_with_its_distance(distance: float, words: str) -> None:
    with pytest.raises(InputError, match=f"{words} the undeformed body: must just touch it"):
        check_touch(BLOCK, replace(TOUCHING, distance_at_touch=distance), {"body": TI_6AL_4V})
