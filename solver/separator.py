"""Vertex separators of a matrix's graph, by METIS: rows whose elimination comes last, so that the others fall apart.

Source: Karypis and Kumar 1998, doi 10.1137/S1064827595287997; METIS_ComputeVertexSeparator of metis.h. The functions of
METIS that PyPI's packages offer leave separators out, so the library is called by ctypes, as MUMPS is.
"""

from __future__ import annotations

import ctypes
from ctypes.util import find_library
from functools import cache

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

Ints = NDArray[np.int64]

FIRST, SECOND, SEPARATOR = 0, 1, 2


def vertex_separator(graph: sp.spmatrix) -> Ints:
    """FIRST, SECOND or SEPARATOR for each row (n,) of a symmetric graph (n × n): no entry joins FIRST and SECOND.

    Each part has at most about 60 % of the rows. All is SEPARATOR where nothing separates, as in a full graph. Raises
    RuntimeError where METIS is not installed or fails.
    """
    quotient, place, weights = _quotient(graph.tocsr())
    part = _metis(quotient, weights)[place].astype(np.int64)
    if not (np.any(part == FIRST) and np.any(part == SECOND)):
        part[:] = SEPARATOR
    return part


def _quotient(graph: sp.csr_matrix) -> tuple[sp.csr_matrix, Ints, NDArray[np.int32]]:
    """One vertex for all rows with the same neighbours, as the displacements of a node have: their graph without loops,
    each row's vertex (n,), and how many rows a vertex stands for."""
    # sums of random integers tell sets of neighbours apart, but for one chance in 2^64 a pair
    marks = np.random.default_rng(1).integers(0, 2**64, graph.shape[0], dtype=np.uint64)
    filled = np.flatnonzero(np.diff(graph.indptr))
    sums = np.zeros(graph.shape[0], dtype=np.uint64)
    sums[filled] = np.add.reduceat(marks[graph.indices], graph.indptr[filled])
    # a row on its own has no neighbours to share
    sums = np.where(np.diff(graph.indptr) <= 1, marks, sums)
    _, first, place = np.unique(sums, return_index=True, return_inverse=True)
    place = place.ravel()
    rows = graph[first].tocoo()
    column = place[rows.col]
    apart = rows.row != column
    entries = np.ones(np.count_nonzero(apart), dtype=np.float32), (rows.row[apart], column[apart])
    quotient = sp.csr_matrix(entries, shape=(len(first), len(first)))  # sums what is there twice
    return quotient, place, np.bincount(place).astype(np.int32)


def _metis(graph: sp.csr_matrix, weights: NDArray[np.int32]) -> NDArray[np.int32]:
    count, size = ctypes.c_int32(graph.shape[0]), ctypes.c_int32()
    starts, neighbours = graph.indptr.astype(np.int32), graph.indices.astype(np.int32)
    part = np.zeros(graph.shape[0], dtype=np.int32)
    arrays = [ctypes.c_void_p(array.ctypes.data) for array in (starts, neighbours, weights)]
    # no options: their numbers differ between releases, and the defaults, a fixed seed among them, are what is wanted
    status = _library().METIS_ComputeVertexSeparator(
        ctypes.byref(count), *arrays, None, ctypes.byref(size), ctypes.c_void_p(part.ctypes.data)
    )
    if status != 1:
        raise RuntimeError(f"METIS could not cut a graph of {graph.shape[0]} vertices, status {status}: report this")
    return part


@cache
def _library() -> ctypes.CDLL:
    name = find_library("metis")
    if name is None:
        raise RuntimeError("METIS' library is wanted, found none: install Debian's libmetis5, or run make setup")
    return ctypes.CDLL(name)
