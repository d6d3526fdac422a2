"""The contact across a line where the gap is no parabola, as over the kink at which a linear relief starts.

Half-planes in contact over an interval of middle m and half-width b, under a load q per length, approach each other by

    δ(q) = least over m, b of  Ḡ(m, b) − c q ln(b/2),      c = 2/(π E*),      dδ/dq = −c ln(b/2)

Ḡ is the mean of the gap over the interval with the weights of a flat punch's pressure, 1/√(1 − t²): below a flat punch
the displacement is the same everywhere, −c ln(b/2) under a unit load (Johnson, Contact Mechanics, 1985, 2.8), so by
reciprocity any pressure q on the interval displaces it by −c q ln(b/2) in this mean. A Hertz contact of half-width b
and gap Ḡ − c q/2 has the same approach and the same stiffness, and stands for this one in the equilibrium.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from evolvent.gears.line.line_gap import GapProfile, LineGap
from evolvent_meshes.arrays import Bools, Floats, Ints

POINTS = 32
"""Points of the mean over the interval: Chebyshev's, at which its weights are equal."""
SAMPLES, REACH = 65, 2.2
"""Samples of the gap about the vertex, and how far they reach, in half-widths of the flanks without modifications."""
STEPS, DIFFERENCE = 8, 0.05
"""Newton steps, and the difference for derivatives, in half-widths: the kink is smooth over it."""
BESIDE = tuple((i, j) for i in (-1, 0, 1) for j in (-1, 0, 1))
"""Differences in middle and half-width of the intervals whose means make the derivatives, in steps of `DIFFERENCE`."""
PARTS = (0.0, 0.125, 0.25, 0.5, 1.0)
"""Parts of a Newton step of which that with the least value is taken: over a kink whole ones go to and fro."""
FLATTEST, NEARLY = 0.1, 0.95
"""Least second derivative by the middle, over c q/b², and largest mixed one, over that of a valley."""
LEAST = 1e-3
"""Least load, over the largest one, under which a contact is looked at."""
PROBED, STRAIGHT = (-1.1, -0.7, -0.3, 0.3, 0.7, 1.1), 0.01
"""Distances from the vertex at which the gap is compared with the fitted parabola, in half-widths, and the difference
from which on it is none, over what the parabola rises within a half-width."""
FARTHEST = 0.5
"""Largest step of middle and half-width, in half-widths."""


@dataclass(frozen=True, eq=False)
class SampledGap:
    """Gaps (k,) across lines, each sampled at equal distances."""

    middle: Floats
    """(k,) distance of the middle sample from the line of flanks without modifications [mm]."""
    spacing: Floats
    """(k,) distance of the samples [mm]."""
    values: Floats
    """(k, SAMPLES) gaps [mm]."""

    @staticmethod
    def of(across: Callable[[Floats], Floats], middle: Floats, half_width: Floats) -> SampledGap:
        """Samples of a function of distances (k, n), about middles (k,). half_width: of the contact (k,) [mm]."""
        spacing = 2.0 * REACH * half_width / (SAMPLES - 1)
        places = middle[:, None] + spacing[:, None] * (np.arange(SAMPLES) - (SAMPLES - 1) / 2)
        return SampledGap(middle, spacing, across(places))

    def mean(self, middle: Floats, half_width: Floats) -> Floats:
        """Means Ḡ (..., k) [mm] over intervals of middles (..., k) and half-widths (..., k) [mm], the gap between two
        samples being a cubic."""
        t = np.cos((np.arange(POINTS) + 0.5) * np.pi / POINTS)
        at = (middle - self.middle)[..., None] + half_width[..., None] * t
        place = at / self.spacing[:, None] + (SAMPLES - 1) / 2
        i = np.clip(np.floor(place).astype(int), 1, SAMPLES - 3)
        s, row = place - i, np.arange(len(self.middle))[:, None]
        before, low, high, after = (self.values[row, i + k] for k in (-1, 0, 1, 2))
        bend = (before - low - high + after) / 4.0  # mean of second differences of both ends
        return np.asarray((low + s * (high - low) + s * (s - 1.0) * bend).mean(axis=-1))


def with_kinks(
    profile: GapProfile, gap: LineGap, vertex: Floats, load: Floats, half_width: Floats, modulus: float
) -> LineGap:
    """The least gap with what stands for a contact whose gap is no parabola over its width.

    gap: as fitted by parabolas over the width.
    vertex: (p,) where it is least without load [mm].
    load: (p,) per length at the points [N/mm].
    half_width: (p,) of the contact without modifications [mm].
    modulus: E* [MPa].
    """
    if not profile.kinked:  # over the start of a parabolic relief parabolas are right to 2e-5 of the deflection
        return gap
    rows = np.flatnonzero((load > LEAST * load.max()) & ~gap.edge)
    rows = rows[_bent(profile, gap, half_width, rows) | (np.abs(gap.shift - vertex)[rows] > half_width[rows])]
    if not rows.size:
        return gap
    c = 2.0 / (np.pi * modulus)
    samples = SampledGap.of(lambda places: profile.across(places, rows), vertex[rows], half_width[rows])
    found, m, b = equal_hertz(samples, half_width[rows], load[rows], c)
    own, place, radius = gap.gap.copy(), gap.shift.copy(), gap.radius.copy()
    own[rows], place[rows], radius[rows] = found, m, b**2 / (2.0 * c * load[rows])
    return LineGap(own, place, radius, gap.edge)


def _bent(profile: GapProfile, gap: LineGap, half_width: Floats, rows: Ints) -> Bools:
    """Rows whose gap is no parabola over the width of the contact. half_width: (p,) [mm]."""
    distances = half_width[rows, None] * np.array(PROBED)
    off = profile.across(gap.shift[rows, None] + distances, rows) - gap.gap[rows, None]
    off -= distances**2 / (2.0 * gap.radius[rows, None])
    allowed = STRAIGHT * half_width[rows] ** 2 / (2.0 * gap.radius[rows])
    return np.asarray(np.abs(off).max(axis=1) > allowed)


def equal_hertz(gap: SampledGap, half_width: Floats, load: Floats, c: float) -> tuple[Floats, Floats, Floats]:
    """Gaps (k,), middles m (k,) and half-widths b (k,) [mm] of the Hertz contacts that stand for some others.

    half_width: b (k,) from which the search starts [mm]; it starts at the middle of the samples.
    load: q (k,) per length [N/mm]. c: 2/(π E*) [1/MPa].
    """
    m, b, parts = gap.middle, half_width, np.array(PARTS)[:, None]
    i, j = np.array(BESIDE).T[..., None]

    def approach(m: Floats, b: Floats) -> Floats:
        return gap.mean(m, b) - c * load * np.log(b)

    for _ in range(STEPS):
        h, unit = DIFFERENCE * b, c * load / b**2
        Ḡ = dict(zip(BESIDE, gap.mean(m + i * h, b + j * h)))
        by_m, by_b = (Ḡ[1, 0] - Ḡ[-1, 0]) / (2.0 * h), (Ḡ[0, 1] - Ḡ[0, -1]) / (2.0 * h) - unit * b
        mm = np.maximum((Ḡ[-1, 0] - 2.0 * Ḡ[0, 0] + Ḡ[1, 0]) / h**2, FLATTEST * unit)
        bb = np.maximum((Ḡ[0, -1] - 2.0 * Ḡ[0, 0] + Ḡ[0, 1]) / h**2, 0.0) + unit
        mb = (Ḡ[1, 1] - Ḡ[1, -1] - Ḡ[-1, 1] + Ḡ[-1, -1]) / (4.0 * h**2)
        mb = np.clip(mb, -NEARLY * np.sqrt(mm * bb), NEARLY * np.sqrt(mm * bb))
        steps = (mb * by_b - bb * by_m) / (mm * bb - mb**2), (mb * by_m - mm * by_b) / (mm * bb - mb**2)
        m_step, b_step = (np.clip(step, -FARTHEST * b, FARTHEST * b) for step in steps)
        tried = approach(m + parts * m_step, b + parts * b_step)
        part = parts[tried.argmin(axis=0), 0]
        m, b = m + part * m_step, b + part * b_step
    return gap.mean(m, b) - 0.5 * c * load, m, b
