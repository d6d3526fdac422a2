"""Which positions of a pitch the coarse companion is solved at."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.gears.sweep.companion_pitch import LEAST, companion_pitch
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent_meshes.gears.member import Member


@pytest.mark.parametrize("driving", list(Member))
@pytest.mark.parametrize("pitches", [1, 3])
def test_every_second_position_in_space(driving: Member, pitches: int) -> None:
    """20 positions of 1 and of 3 pitches, passed in either direction: 10 a pitch, in equal steps of twice the length
    across the end of a pitch, too, and in the order of the run."""
    whole = uniform_pitch(17, 20, pitches, driving)
    thinned = companion_pitch(whole, plane=False)
    assert thinned.pitches == pitches and thinned.angles == whole.angles[::2] and len(thinned.angles) == 10 * pitches
    step = np.diff([*thinned.angles, thinned.angles[0] + driving.sign * pitches * 2.0 * np.pi / 17])
    assert step == pytest.approx(driving.sign * 2.0 * np.pi / 17 / 10)


@pytest.mark.parametrize(("positions", "plane"), [(20, True), (LEAST + 1, False), (LEAST - 2, False), (1, False)])
def test_all_positions_in_the_plane_and_of_few_or_odd_ones(positions: int, plane: bool) -> None:
    """In plane strain, of an odd number and of fewer than 16: all positions. Several pitches count as one."""
    for pitches in (1, 2):
        whole = uniform_pitch(17, positions, pitches)
        assert companion_pitch(whole, plane) == whole
