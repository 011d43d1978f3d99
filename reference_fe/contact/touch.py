"""Whether an obstacle just touches the body before anything moves."""

from __future__ import annotations

from collections.abc import Mapping

from contracts.errors import InputError
from contracts.materials import Material
from reference_fe.contact.obstacle import ObstacleContact
from reference_fe.contact.patch import contact_faces, facet_samples
from reference_fe.problem.domain import Domain

__all__ = ["check_touch"]


def check_touch(domain: Domain, contact: ObstacleContact, materials: Mapping[str, Material]) -> None:
    """Refuse an obstacle that does not just touch the body at 20 C, to a thousandth of its distance and expansion.

    Raises
    ------
    InputError
        If it stands off the undeformed body or inside it.

    Verified by tests/unit/test_fe_contact_touch.py.
    """
    domain.face_tags(contact.faces)
    points, _ = facet_samples(domain.tagged.points, contact_faces(domain.tagged, contact.faces))
    gap = float(contact.gap(points, 0.0).min())
    reach = contact.distance_at_touch - gap
    allowed = 1e-3 + 2.0 * max(abs(material.thermal_strain) for material in materials.values())
    if abs(gap) > allowed * max(abs(reach), abs(contact.distance_at_touch)):
        raise InputError(
            "contact plane at the start",
            f"{abs(gap) * 1e3:.4g} mm {'off' if gap > 0 else 'inside'} the undeformed body",
            "must just touch it, with its normal pointing to the body",
            "flip the normal, or take distance_at_touch from contact_patch.distance_at_touch",
        )
