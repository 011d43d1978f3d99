"""Claim: L-, T- and V-frames of plates that share their corner nodes bend as closed-form frames, to 1 %.

Source: unit-load theorem, bending only; the model is ancf_reduced/verification/frames.py. The plates' slopes differ at
the corner by any angle and no constraint equation joins them (thesis eqs. 2.17 to 2.19). Eight plates a leg: six times
as long as thick. Tolerance 1 %: the shared node lets the corner shear, with a stiffness in proportion to the plates'
length (see `plates.mesh`), which is measured below: plates half as long as thick are far too soft. Negative control: 2
% of thickness.
"""

from __future__ import annotations

import pytest

from ancf_reduced.verification.frames import FRAMES, LENGTH, THICKNESS, frame_drop, loaded_frame


@pytest.mark.parametrize("name", FRAMES)
def test_frames_bend_as_frames(name: str) -> None:
    frame = loaded_frame(FRAMES[name])
    assert frame.drop == pytest.approx(frame.expected, rel=0.01)
    assert frame.nodes == 2 * (8 * (1 + len(FRAMES[name])) + 1)  # the corner is shared


def test_short_plates_soften_the_corner() -> None:
    """The limit stated in `plates.mesh`: plates half as long as thick have a soft corner; longer ones do not."""
    thick = 0.2 * LENGTH
    soft, stiff = (loaded_frame((0.0,), n, thick).drop / frame_drop(0.0, thick) for n in (10, 2))
    assert soft > 1.15
    assert soft > stiff + 0.05


def test_a_thicker_strip_is_caught() -> None:
    """Negative control: 2 % of thickness is 6 % of stiffness."""
    frame = loaded_frame(FRAMES["L"], thickness=1.02 * THICKNESS)
    assert frame.drop / frame.expected < 0.96
