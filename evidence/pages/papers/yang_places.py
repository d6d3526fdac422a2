"""Teeth, position and points of Yang et al. 2022 (Figs 8 to 13, Table 5) in a run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.gears.pressure.contact_slices import Slices
from evolvent.results.figures.lines import line_of
from evolvent.results.run_data import RunData
from evolvent_meshes.gears.flank import contact_lines

TEETH = {1: "tooth 1", 0: "tooth 2", -1: "tooth 3"}
"""Index of a tooth pair over the pitch from φ = 0 -> name of that tooth in the paper."""


@dataclass(frozen=True)
class Point:
    """A point of the paper's Fig. 11 on a contact line."""

    name: str
    """Name in the paper."""
    tooth: int
    """Index of the tooth pair."""
    z: float
    """Height [mm]."""
    roll_distance: float
    """Roll distance ξ from the pitch point [mm]."""


def paper_position(run: RunData) -> int:
    """Index of the position nearest to that of the paper: 5.25e-5 s at 1500 r/min, or 0.47° after the start of its
    pitch."""
    return int(np.argmin(np.abs(np.degrees(run.angles) - 0.4725)))


def paper_points(run: RunData, k: int) -> list[Point]:
    """Points A to D at position k. A, B and C lie on tooth 2's contact line: halfway from its root end to the pitch
    line, on the pitch line, and halfway to its tip end. D is the middle of tooth 3's line, near the root. The paper
    describes these places without coordinates."""
    lines = {line.tooth: line for line in contact_lines(run.pair, float(run.angles[k]))}
    second, third = lines[0], lines[-1]
    root, tip = sorted(second.roll_distance)
    places = [
        ("A", second, 0.5 * root),
        ("B", second, 0.0),
        ("C", second, 0.5 * tip),
        ("D", third, float(np.mean(third.roll_distance))),
    ]
    points = []
    for name, line, ξ in places:
        (ξ0, ξ1), (z0, z1) = line.roll_distance, line.z
        z = z0 + (z1 - z0) * (ξ - ξ0) / (ξ1 - ξ0)
        points.append(Point(name, line.tooth, z, ξ))
    return points


def at_point(cut: Slices, point: Point) -> float:
    """Fitted peak pressure at a point of the contact line [MPa], interpolated between slices; NaN outside the line."""
    z, _, peak = line_of(cut, point.tooth)
    return float(np.interp(point.z, z, peak, left=np.nan, right=np.nan)) if len(z) else float("nan")
