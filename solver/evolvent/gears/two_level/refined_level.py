"""One level of a flank, finer than the one before."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import scipy.sparse as sp

from evolvent.gears.two_level.normal_strips import NormalStrips
from evolvent.gears.two_level.strips import StripCorrection
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class RefinedLevel:
    """A flank finer than the one before.

    transfer: (n, c) shape functions of the level before at the nodes.
    correction: that by its cells, in the frame of tooth 0.
    normals: (n, 3) at the nodes of the flank.
    """

    transfer: sp.csr_matrix
    correction: StripCorrection
    normals: Floats

    @cached_property
    def normal(self) -> NormalStrips:
        """The correction between normal components."""
        return NormalStrips.of(self.correction, self.normals)
