"""Elimination order of a sparse symmetric matrix by nested dissection of its graph.

A vertex separator divides the graph into two parts without a common entry; each part is divided again, until it is
small enough for a direct solver. The parts are numbered first and their separator last.

Sources: nested dissection, George 1973, doi 10.1137/0710032; separators by METIS, Karypis and Kumar 1998,
doi 10.1137/S1064827595287997 (METIS_ComputeVertexSeparator of metis.h). The METIS packages of PyPI leave this function
out, so that the C library is called by ctypes.
"""

from __future__ import annotations

import ctypes
from ctypes.util import find_library
from dataclasses import dataclass
from functools import cache

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import reverse_cuthill_mckee

from evolvent_meshes.arrays import Ints

FIRST, SECOND, SEPARATOR = 0, 1, 2
"""The two parts of a divided graph and the separator between them."""


@dataclass(frozen=True)
class SeparatorTree:
    """A contiguous range of rows in elimination order: the children's rows, then the separator between them.

    begin: first row.
    separator: first row of the separator; the children tile the rows from `begin` to it.
    end: one past the last row.
    children: the parts that the separator divides; no matrix entry couples two of them. Empty for a leaf.
    """

    begin: int
    separator: int
    end: int
    children: tuple[SeparatorTree, ...] = ()

    @property
    def is_leaf(self) -> bool:
        """Whether the range is not divided and has no separator: MUMPS eliminates all of its rows."""
        return not self.children and self.separator == self.end


@dataclass(frozen=True)
class CompressedGraph:
    """Graph of a matrix in which rows with the same neighbours, such as the displacements of a node, are one vertex.

    graph: (v, v) pattern without diagonal that METIS divides.
    coupling: (v, v) further entries of the matrix, which no division may leave between two parts; None: there are none.
    weights: (v,) rows of the matrix that each vertex stands for.
    """

    graph: sp.csr_matrix
    coupling: sp.csr_matrix | None
    weights: Ints

    def subgraph(self, vertices: Ints) -> CompressedGraph:
        """The graph of some vertices (sorted indices) and the edges between them."""
        coupling = None if self.coupling is None else self.coupling[vertices][:, vertices]
        return CompressedGraph(self.graph[vertices][:, vertices], coupling, self.weights[vertices])


def dissect(matrix: sp.spmatrix, graph: sp.spmatrix | None, leaf: int) -> tuple[Ints, SeparatorTree]:
    """Elimination order (n,) of the rows of a symmetric matrix (n × n), and its separator tree.

    graph: (n × n) the pattern to divide, a subset of the matrix's own; None: the matrix's. Entries of the matrix that
        couple two parts of the graph are resolved by moving one of the two vertices into the separator.
    leaf: most rows of a part that is not divided further.
    Raises RuntimeError where METIS is not installed or fails.
    """
    compressed, vertex = compress(matrix.tocsr(), None if graph is None else graph.tocsr())
    order, tree = _dissect(compressed, np.arange(len(compressed.weights)), leaf, 0)
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    return np.argsort(rank[vertex], kind="stable"), tree


def _dissect(compressed: CompressedGraph, numbers: Ints, leaf: int, begin: int) -> tuple[Ints, SeparatorTree]:
    """Elimination order of the vertices called `numbers` (v,), and their tree, whose rows start at `begin`."""
    end = begin + int(compressed.weights.sum())
    if not len(numbers):  # all rows are held
        return numbers, SeparatorTree(begin, end, end)
    if end - begin <= leaf:
        # MUMPS' minimum degree breaks ties in the order it is given: a third fewer operations
        return numbers[reverse_cuthill_mckee(compressed.graph, symmetric_mode=True)], SeparatorTree(begin, end, end)
    side, orders, children = bisect(compressed), [], []
    start = begin
    for vertices in (np.flatnonzero(side == FIRST), np.flatnonzero(side == SECOND)):
        if len(vertices):
            order, child = _dissect(compressed.subgraph(vertices), numbers[vertices], leaf, start)
            orders.append(order)
            children.append(child)
            start = child.end
    return np.concatenate([*orders, numbers[side == SEPARATOR]]), SeparatorTree(begin, start, end, tuple(children))


def bisect(compressed: CompressedGraph) -> Ints:
    """FIRST, SECOND or SEPARATOR for each vertex (v,); neither graph nor coupling joins FIRST and SECOND.

    METIS keeps each part below about 60 % of the rows. All vertices are SEPARATOR where nothing separates them, as in a
    full graph. Raises RuntimeError where METIS is not installed or fails.
    """
    side = _vertex_separator(compressed.graph, compressed.weights)
    if not (np.any(side == FIRST) and np.any(side == SECOND)):
        side[:] = SEPARATOR
    elif compressed.coupling is not None:
        coupled = [_coupled(compressed.coupling, side, *parts) for parts in ((FIRST, SECOND), (SECOND, FIRST))]
        side[min(coupled, key=lambda vertices: int(compressed.weights[vertices].sum()))] = SEPARATOR
    return side


def _coupled(coupling: sp.csr_matrix, side: Ints, part: int, other: int) -> Ints:
    """The vertices of one part that are coupled with the other one."""
    return np.flatnonzero((side == part) & (coupling @ (side == other).astype(np.float32) > 0.0))


def compress(matrix: sp.csr_matrix, graph: sp.csr_matrix | None) -> tuple[CompressedGraph, Ints]:
    """The compressed graph of a matrix (n × n), and the vertex of each row (n,); graph: as for `dissect`."""
    patterns = [matrix] if graph is None else [graph, matrix]
    _, first, vertex = np.unique(_row_hashes(patterns), return_index=True, return_inverse=True)
    quotients = [pattern[first][:, first] for pattern in patterns]
    coupling = None if graph is None else _further_entries(quotients[0], quotients[1])
    return CompressedGraph(_without_diagonal(quotients[0]), coupling, np.bincount(vertex.ravel())), vertex.ravel()


def _row_hashes(patterns: list[sp.csr_matrix]) -> NDArray[np.uint64]:
    """Hashes (n,) of the rows' patterns: sums of a random integer for each column.

    Rows with the same columns in all patterns have the same hash; others share one with a chance of 2^-64 a pair.
    """
    rng, size = np.random.default_rng(1), patterns[0].shape[0]
    hashes = rng.integers(0, 2**64, size, dtype=np.uint64)  # of rows without entries
    sums = np.zeros(size, dtype=np.uint64)
    for pattern in patterns:
        columns = rng.integers(0, 2**64, size, dtype=np.uint64)
        filled = np.flatnonzero(np.diff(pattern.indptr))
        sums[filled] += np.add.reduceat(columns[pattern.indices], pattern.indptr[filled])
        hashes[filled] = sums[filled]
    return hashes


def _further_entries(graph: sp.csr_matrix, matrix: sp.csr_matrix) -> sp.csr_matrix:
    """The entries of a matrix that its subset `graph` has not."""
    more = (np.diff(matrix.indptr) > np.diff(graph.indptr)).astype(np.float32)
    ones = [sp.csr_matrix((np.ones(len(p.indices), dtype=np.float32), p.indices, p.indptr), p.shape)
            for p in (matrix, graph)]
    difference = sp.diags(more) @ ones[0] - sp.diags(more) @ ones[1]
    difference.eliminate_zeros()
    return difference.tocsr()


def _without_diagonal(graph: sp.csr_matrix) -> sp.csr_matrix:
    entries = graph.tocoo()
    apart = entries.row != entries.col
    ones = np.ones(np.count_nonzero(apart), dtype=np.float32)
    return sp.csr_matrix((ones, (entries.row[apart], entries.col[apart])), shape=graph.shape)


def _vertex_separator(graph: sp.csr_matrix, weights: Ints) -> Ints:
    """FIRST, SECOND or SEPARATOR for each vertex (v,), by METIS with its default options, a fixed seed among them.

    No options are passed, as their numbers differ between releases.
    """
    count, size = ctypes.c_int32(graph.shape[0]), ctypes.c_int32()
    arrays = [array.astype(np.int32) for array in (graph.indptr, graph.indices, weights)]
    side = np.zeros(graph.shape[0], dtype=np.int32)
    pointers = [ctypes.c_void_p(array.ctypes.data) for array in (*arrays, side)]
    status = _library().METIS_ComputeVertexSeparator(
        ctypes.byref(count), *pointers[:3], None, ctypes.byref(size), pointers[3]
    )
    if status != 1:
        raise RuntimeError(f"METIS could not cut a graph of {graph.shape[0]} vertices, status {status}: report this")
    return side.astype(np.int64)


@cache
def _library() -> ctypes.CDLL:
    name = find_library("metis")
    if name is None:
        raise RuntimeError("METIS' library is wanted, found none: install Debian's libmetis5, or run make setup")
    return ctypes.CDLL(name)
