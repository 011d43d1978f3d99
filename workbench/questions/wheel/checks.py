"""Checks of the meshes. Verified by tests/unit/test_workbench_checks.py."""

from __future__ import annotations

from contracts.records import Check, Role
from workbench.questions.wheel.results import MeshNumbers
from workbench.study.sections import ToleranceSection
from workbench.verdict.rules import Claim, at_least, near

__all__ = ["mesh_checks"]

_SHAPE = "scaled Jacobian of a hexahedron, Stimpson et al. 2007, SAND2007-1751; the limit is ours"


def mesh_checks(mesh: MeshNumbers, whole: MeshNumbers, tolerances: ToleranceSection) -> list[Check]:
    """Volume and mass of the whole wheel against closed form; the worst cell of both meshes."""
    form = "closed form of the design"

    def worst() -> float:
        return min(m.quality.min_scaled_jacobian for m in (mesh, whole))

    return [
        near(
            _claim("mesh.volume", "Mesh of the whole wheel: volume", "volume", "m^3", "gate", form),
            lambda: whole.volume,
            whole.volume_closed_form,
            tolerances.mesh_mass,
        ),
        near(
            _claim("mesh.mass", "Mesh of the whole wheel: mass", "mass", "kg", "gate", form),
            lambda: whole.mass,
            whole.mass_closed_form,
            tolerances.mesh_mass,
        ),
        at_least(
            _claim(
                "mesh.min_scaled_jacobian",
                "Smallest scaled Jacobian of any cell",
                "scaled Jacobian",
                "-",
                "gate",
                _SHAPE,
            ),
            worst,
            tolerances.min_scaled_jacobian,
        ),
    ]


def _claim(id: str, title: str, quantity: str, unit: str, role: Role, source: str) -> Claim:
    return Claim(id=id, title=title, quantity=quantity, unit=unit, role=role, source=source)
