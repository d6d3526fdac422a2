"""In which order a symmetric matrix is eliminated: cut in two by a separator, again and again, down to leaves.

The separators are those of the matrix's graph by METIS (Karypis and Kumar 1998, doi 10.1137/S1064827595287997;
METIS_ComputeVertexSeparator of metis.h). What PyPI's packages offer of METIS leaves separators out, so the library is
called by ctypes, as MUMPS is.
"""

from __future__ import annotations

import ctypes
from ctypes.util import find_library
from dataclasses import dataclass
from functools import cache

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from evolvent_meshes.arrays import Ints

FIRST, SECOND, SEPARATOR = 0, 1, 2


@dataclass(frozen=True)
class Part:
    """Rows begin to end of the new order, the separator's last: `parts` tile begin to separator, and no entry joins two
    of them. A leaf has no parts and no separator."""

    begin: int
    separator: int
    end: int
    parts: tuple[Part, ...] = ()

    @property
    def is_leaf(self) -> bool:
        """Whether MUMPS takes all its rows."""
        return not self.parts and self.separator == self.end


@dataclass(frozen=True)
class Vertices:
    """Rows with the same neighbours, as the displacements of a node have, taken together.

    graph: (v, v) without loops, the one to cut. coupled: (v, v) entries beyond it that a cut must not leave either,
    None where there are none. weights: (v,) how many rows each vertex stands for.
    """

    graph: sp.csr_matrix
    coupled: sp.csr_matrix | None
    weights: Ints

    def of(self, chosen: Ints) -> Vertices:
        """Some vertices (sorted), and what joins them."""
        coupled = None if self.coupled is None else self.coupled[chosen][:, chosen]
        return Vertices(self.graph[chosen][:, chosen], coupled, self.weights[chosen])


def planned(matrix: sp.spmatrix, graph: sp.spmatrix | None, leaf: int) -> tuple[Ints, Part]:
    """The new order (n,) of the rows of a symmetric matrix (n × n), and its parts, leaves of at most `leaf` rows.

    Cuts follow `graph` (n × n), which connects no more than the matrix does (None: the matrix itself); what the matrix
    still couples of two parts is taken into the separator, from one of them only. Raises RuntimeError where METIS is
    not installed or fails.
    """
    vertices, place = gathered(matrix.tocsr(), None if graph is None else graph.tocsr())
    order, whole = _planned(vertices, np.arange(len(vertices.weights)), leaf, 0)
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    return np.argsort(rank[place], kind="stable"), whole


def _planned(vertices: Vertices, numbers: Ints, leaf: int, begin: int) -> tuple[Ints, Part]:
    """The order of `numbers`, the names of the vertices, and the part that starts at row `begin`."""
    end = begin + int(vertices.weights.sum())
    if end - begin <= leaf:
        return numbers, Part(begin, end, end)
    side, orders, parts = bisect(vertices), [], []
    at = begin
    for chosen in (np.flatnonzero(side == FIRST), np.flatnonzero(side == SECOND)):
        if len(chosen):
            order, part = _planned(vertices.of(chosen), numbers[chosen], leaf, at)
            orders.append(order)
            parts.append(part)
            at = part.end
    return np.concatenate([*orders, numbers[side == SEPARATOR]]), Part(begin, at, end, tuple(parts))


def bisect(vertices: Vertices) -> Ints:
    """FIRST, SECOND or SEPARATOR for each vertex (v,); neither the graph nor the coupling joins FIRST and SECOND.

    METIS keeps each part below about 60 %. All is SEPARATOR where nothing separates, as in a full graph.
    """
    side = _metis(vertices.graph, vertices.weights)
    if not (np.any(side == FIRST) and np.any(side == SECOND)):
        side[:] = SEPARATOR
    elif vertices.coupled is not None:
        touching = [_touching(vertices.coupled, side, *ends) for ends in ((FIRST, SECOND), (SECOND, FIRST))]
        side[min(touching, key=lambda some: int(vertices.weights[some].sum()))] = SEPARATOR
    return side


def _touching(coupled: sp.csr_matrix, side: Ints, here: int, there: int) -> Ints:
    """The vertices of one part that are coupled with the other."""
    return np.flatnonzero((side == here) & (coupled @ (side == there).astype(np.float32) > 0.0))


def gathered(matrix: sp.csr_matrix, graph: sp.csr_matrix | None) -> tuple[Vertices, Ints]:
    """The vertices of a matrix (n × n) and the one of each row (n,)."""
    patterns = [matrix] if graph is None else [graph, matrix]
    _, first, place = np.unique(_marks(patterns), return_index=True, return_inverse=True)
    quotients = [pattern[first][:, first] for pattern in patterns]
    coupled = None if graph is None else _beyond(quotients[0], quotients[1])
    return Vertices(_without_loops(quotients[0]), coupled, np.bincount(place.ravel())), place.ravel()


def _marks(patterns: list[sp.csr_matrix]) -> NDArray[np.uint64]:
    """A number (n,) for each row, the same for rows with the same neighbours in all patterns, and for no others but by
    one chance in 2^64 a pair: sums of random integers."""
    rng, size = np.random.default_rng(1), patterns[0].shape[0]
    found = rng.integers(0, 2**64, size, dtype=np.uint64)  # of a row without neighbours
    sums = np.zeros(size, dtype=np.uint64)
    for pattern in patterns:
        marks = rng.integers(0, 2**64, size, dtype=np.uint64)
        filled = np.flatnonzero(np.diff(pattern.indptr))
        sums[filled] += np.add.reduceat(marks[pattern.indices], pattern.indptr[filled])
        found[filled] = sums[filled]
    return found


def _beyond(graph: sp.csr_matrix, matrix: sp.csr_matrix) -> sp.csr_matrix:
    """What a matrix joins and a graph does not, which has no more in any row."""
    more = (np.diff(matrix.indptr) > np.diff(graph.indptr)).astype(np.float32)
    ones = [sp.csr_matrix((np.ones(len(p.indices), dtype=np.float32), p.indices, p.indptr), p.shape)
            for p in (matrix, graph)]  # fmt: skip
    found = sp.diags(more) @ ones[0] - sp.diags(more) @ ones[1]
    found.eliminate_zeros()
    return found.tocsr()


def _without_loops(graph: sp.csr_matrix) -> sp.csr_matrix:
    entries = graph.tocoo()
    apart = entries.row != entries.col
    ones = np.ones(np.count_nonzero(apart), dtype=np.float32)
    return sp.csr_matrix((ones, (entries.row[apart], entries.col[apart])), shape=graph.shape)


def _metis(graph: sp.csr_matrix, weights: Ints) -> Ints:
    count, size = ctypes.c_int32(graph.shape[0]), ctypes.c_int32()
    arrays = [array.astype(np.int32) for array in (graph.indptr, graph.indices, weights)]
    part = np.zeros(graph.shape[0], dtype=np.int32)
    pointers = [ctypes.c_void_p(array.ctypes.data) for array in (*arrays, part)]
    # no options: their numbers differ between releases, and the defaults, a fixed seed among them, are what is wanted
    status = _library().METIS_ComputeVertexSeparator(
        ctypes.byref(count), *pointers[:3], None, ctypes.byref(size), pointers[3]
    )
    if status != 1:
        raise RuntimeError(f"METIS could not cut a graph of {graph.shape[0]} vertices, status {status}: report this")
    return part.astype(np.int64)


@cache
def _library() -> ctypes.CDLL:
    name = find_library("metis")
    if name is None:
        raise RuntimeError("METIS' library is wanted, found none: install Debian's libmetis5, or run make setup")
    return ctypes.CDLL(name)
