"""The coarse cells of a flank along its profile or its face: which have patches of their own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class Axis:
    """The coarse cells of a flank along its profile or its face.

    below: of each cell, how many lie within reach on the side of the first one.
    above: of each, how many on the side of the last one.
    samples: how many between those near the ends are sampled, and not interpolated between others.
    """

    below: tuple[int, ...]
    above: tuple[int, ...]
    samples: int

    @staticmethod
    def of(corners: Floats, reach: float, samples: int) -> Axis:
        """Cells from their corners (count + 1, 3) along one line. reach: how far patches extend [mm]."""
        within = np.linalg.norm(corners[:, None] - corners, axis=2) < reach
        cells = range(len(corners) - 1)
        below = tuple(int(within[i, 1 : i + 1].sum()) for i in cells)
        return Axis(below, tuple(int(within[i + 1, i + 1 : -1].sum()) for i in cells), samples)

    @property
    def count(self) -> int:
        """Number of cells."""
        return len(self.below)

    def extent(self, cells: Sequence[int]) -> tuple[int, int]:
        """Largest numbers of cells within reach below and above one of these."""
        return max(self.below[i] for i in cells), max(self.above[i] for i in cells)

    @property
    def own(self) -> list[range]:
        """Blocks of cells near the ends, each loaded in one patch: those with the end within reach, and so many that
        the patches of all others fit; all cells if that costs less, by the third power of the patches' extent."""
        first, last = 1 + self.above[0], 1 + self.below[-1]
        while between := range(first, self.count - last):
            below, above = self.extent(between)
            if below <= first and above <= last:
                break
            first, last = max(first, below), max(last, above)
        patch = 1 + sum(self.extent(range(self.count)))
        if self.count <= first + last or self.count**3 <= (2 + self.samples) * patch**3:
            return [range(self.count)]
        return [range(first), range(self.count - last, self.count)]

    @property
    def between(self) -> range:
        """The cells in no block."""
        blocks = self.own
        return range(blocks[0].stop, blocks[-1].start)

    @property
    def loaded(self) -> list[range]:
        """Blocks of cells that are loaded in one patch each: those near the ends, with the sampled cell beside them,
        whose own patch would be hardly smaller; the other sampled cells one by one."""
        blocks, samples = self.own, self.sampled
        if samples and samples[0] == blocks[0].stop:
            blocks[0] = range(blocks[0].start, samples.pop(0) + 1)
        if samples and samples[-1] == blocks[-1].start - 1:
            blocks[-1] = range(samples.pop(), blocks[-1].stop)
        return [*blocks, *(range(i, i + 1) for i in samples)]

    @property
    def sampled(self) -> list[int]:
        """Cells between the blocks whose response stands for the others: that of the middle one, or of several, closer
        towards both ends, as a polynomial through them needs it (Chebyshev)."""
        cells = self.between
        if self.samples == 1 or len(cells) < 2:
            return [cells[len(cells) // 2]] if cells else []
        along = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, self.samples))
        return sorted({cells[round(i)] for i in along * (len(cells) - 1)})
