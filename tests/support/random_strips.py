"""Corrections of a flank with random numbers, as strips and written out as a matrix."""

from __future__ import annotations

import numpy as np

from evolvent.gears.two_level.flank_lattice import FlankLattice
from evolvent.gears.two_level.strips import Strip, StripCorrection
from evolvent_meshes.arrays import Floats

PER_LAYER = 2


def lattice(random: np.random.Generator, rows: int, levels: int) -> FlankLattice:
    """Nodes on part of a cylinder's side, in random order."""
    radius, height = 10.0 + np.arange(rows), 0.5 * np.arange(levels)
    points = np.stack(np.broadcast_arrays(radius[:, None], 0.0, height), axis=-1)
    return FlankLattice(points, random.permutation(rows * levels).reshape(rows, levels))


def strips(random: np.random.Generator, rows: int, layers: int) -> StripCorrection:
    """Four strips with two rows of sources each: at the first layer, at the last, and two at all others between, which
    move nodes of the neighbouring layers; of `rows` ≥ 4 rows and 2·layers + 1 levels of nodes."""
    last = PER_LAYER * (layers - 1)
    made = [
        _strip(random, (2, 2), (4, 3), (0, 0), (0, 1), 1),
        _strip(random, (3, 2), (4, 3), (last, 1), (last - 1, 0), 1),
        _strip(random, (2, 2), (5, rows), (2, 0), (1, 0), layers - 2),
        _strip(random, (2, 2), (3, 2), (2, 2), (2, 2), layers - 2),
    ]
    angle = np.repeat(random.normal(size=layers), PER_LAYER)
    return StripCorrection(lattice(random, rows, 2 * layers + 1), PER_LAYER, np.append(angle, angle[-1]), made)


def _strip(
    random: np.random.Generator, sources: tuple[int, int], moved: tuple[int, int], source: tuple[int, int],
    start: tuple[int, int], layers: int,
) -> Strip:  # fmt: skip
    change = random.normal(size=(3 * sources[0] * sources[1], 3 * moved[0] * moved[1]))
    return Strip(change, sources, moved, source, start, layers)


def written_out(correction: StripCorrection) -> Floats:
    """½ (D + Dᵀ) (n·3, n·3), entry by entry."""
    n = correction.size
    D = np.zeros((n, 3, n, 3))
    for strip in correction.strips:
        change = strip.change.reshape(*strip.sources, 3, *strip.moved, 3)
        for layer in range(strip.layers):
            for source in np.ndindex(strip.sources):
                for moved in np.ndindex(strip.moved):
                    j, to = _node(correction, strip.source, source, layer)
                    i, of = _node(correction, strip.start, moved, layer)
                    D[i, :, j, :] += of @ change[source][:, moved[0], moved[1]].T @ to.T
    matrix = D.reshape(3 * n, 3 * n)
    return 0.5 * (matrix + matrix.T)


def _node(
    correction: StripCorrection, first: tuple[int, int], place: tuple[int, ...], layer: int
) -> tuple[int, Floats]:
    """Number of a node, and the rotation from the frame of its layer."""
    level, row = first[0] + PER_LAYER * layer + place[0], first[1] + place[1]
    c, s = np.cos(correction.angle[level]), np.sin(correction.angle[level])
    return int(correction.numbers[level, row]), np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
