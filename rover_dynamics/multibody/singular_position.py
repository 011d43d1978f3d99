"""What a formulation says where its loops leave the motion undetermined.

Verified by tests/verification/test_multibody_bricard.py.
"""

from __future__ import annotations

__all__ = ["SingularPosition"]


class SingularPosition(Exception):  # noqa: N818  (tells the integrator to step elsewhere)
    """A loop has one freedom more here than elsewhere, so that the equations have no unique solution.

    time : when [s]
    margin : see `formulation.Formulation.margin`
    """

    def __init__(self, t: float, margin: float) -> None:
        self.time, self.margin = t, margin
        super().__init__(f"singular position at t = {t:g} s")
