"""Corrections of a flank with random numbers, as strips and written out as a matrix."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.gears.two_level.flank_lattice import FlankLattice
from evolvent.gears.two_level.strips import StripCorrection
from evolvent.gears.two_level.symmetric_strips import Strip
from evolvent_meshes.arrays import Floats

PER_LAYER = 2


@dataclass(frozen=True)
class RandomCorrection:
    """A correction, and ½ (D + Dᵀ) (n·3, n·3) written out. D holds small whole numbers, exact in single precision."""

    strips: StripCorrection
    matrix: Floats


def lattice(random: np.random.Generator, rows: int, levels: int) -> FlankLattice:
    """Nodes on part of a cylinder's side, in random order."""
    radius, height = 10.0 + np.arange(rows), 0.5 * np.arange(levels)
    points = np.stack(np.broadcast_arrays(radius[:, None], 0.0, height), axis=-1)
    return FlankLattice(points, random.permutation(rows * levels).reshape(rows, levels))


def random_correction(random: np.random.Generator, rows: int, layers: int) -> RandomCorrection:
    """Six strips, of the rows below and from the third on: at the first layer, at the last, and at all others between,
    which move nodes of the neighbouring layers; of `rows` ≥ 4 rows and 2·layers + 1 levels of nodes."""
    last, upper, inner = PER_LAYER * (layers - 1), rows - 2, layers - 2
    made = [
        _strip(random, (2, 2), (4, 3), (0, 0), (0, 0), 1),
        _strip(random, (2, upper), (3, 3), (0, 2), (0, 1), 1),
        _strip(random, (3, 2), (4, 3), (last, 0), (last - 1, 0), 1),
        _strip(random, (3, upper), (4, rows), (last, 2), (last - 1, 0), 1),
        _strip(random, (2, 2), (5, rows), (2, 0), (1, 0), inner),
        _strip(random, (2, upper), (3, 2), (2, 2), (2, 2), inner),
    ]
    angle = np.repeat(random.normal(size=layers), PER_LAYER)
    nodes, angle = lattice(random, rows, 2 * layers + 1), np.append(angle, angle[-1])
    correction = StripCorrection.of(nodes, PER_LAYER, angle, made)
    return RandomCorrection(correction, _written_out(correction, made))


def _strip(
    random: np.random.Generator, sources: tuple[int, int], moved: tuple[int, int], source: tuple[int, int],
    start: tuple[int, int], layers: int,
) -> Strip:
    change = random.integers(-99, 99, size=(3 * sources[0] * sources[1], 3 * moved[0] * moved[1])).astype(float)
    return Strip(change, sources, moved, source, start, layers)


def _written_out(correction: StripCorrection, responses: Sequence[Strip]) -> Floats:
    """½ (D + Dᵀ), entry by entry."""
    n = correction.size
    D = np.zeros((n, 3, n, 3))
    for strip in responses:
        change = strip.blocks()
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
