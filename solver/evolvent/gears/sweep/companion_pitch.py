"""Positions at which the coarse companion of a run is solved.

The error of a mesh is smooth over the pitch where the contact is in space: contact lines lie across the flank, and
slices enter and leave one after the other. Every second position then tells it as well as all of them, at little more
than half of the cost. In the plane whole teeth take up and shed load at once, between two positions: of He's pair the
mesh's part of the bar of the tangent stiffness fell by a quarter. There a companion costs seconds and is solved at all
positions. So it is where the steps of friction's history would be too long: at 12 positions and μ = 0.2 steps twice as
long doubled the mesh's part of the bar of the peak-to-peak transmission error, at 16 it stayed as it was.
"""

from __future__ import annotations

from dataclasses import replace

from evolvent.gears.sweep.pitch_sweep import Pitch

LEAST = 16
"""Smallest number of positions of an angular pitch of which every second one is enough."""


def companion_pitch(pitch: Pitch, plane: bool) -> Pitch:
    """Every second position of a `uniform_pitch`, which are equal steps of a pitch, too; all of them in the plane, and
    where their number is odd or below `LEAST`. plane: whether the gears are solved in plane strain."""
    count = len(pitch.angles) // pitch.pitches
    return pitch if plane or count % 2 or count < LEAST else replace(pitch, angles=pitch.angles[::2])
