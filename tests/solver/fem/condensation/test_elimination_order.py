"""Elimination order: properties that separators must have, whichever METIS finds."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent.fem.condensation import elimination_order
from evolvent.fem.condensation.elimination_order import (
    FIRST,
    SECOND,
    SEPARATOR,
    SeparatorTree,
    bisect,
    compress,
    dissect,
)
from evolvent_meshes.arrays import Ints


def grid(n: int, m: int, dofs: int = 1) -> sp.csr_matrix:
    """The graph of an n × m grid of nodes that meet their eight neighbours, `dofs` rows a node."""
    line = [sp.diags([1.0, 1.0, 1.0], [-1, 0, 1], shape=(k, k)) for k in (n, m)]
    graph = sp.kron(sp.kron(*line), np.ones((dofs, dofs)), format="csr")
    graph.eliminate_zeros()  # of dense blocks that kron makes
    return graph


def cut(matrix: sp.csr_matrix, graph: sp.csr_matrix | None = None) -> Ints:
    """FIRST, SECOND or SEPARATOR for each row."""
    vertices, place = compress(matrix, graph)
    return bisect(vertices)[place]


def leaves(tree: SeparatorTree) -> Iterator[SeparatorTree]:
    """The ranges of rows that are not divided."""
    if not tree.children:
        yield tree
    for child in tree.children:
        yield from leaves(child)


@pytest.mark.parametrize("dofs", [1, 3])
def test_strip_is_cut_across(dofs: int) -> None:
    """A strip of 40 × 5 nodes: the smallest separator is one column of 5 nodes, with all their rows."""
    graph = grid(40, 5, dofs)
    side = cut(graph)
    assert np.count_nonzero(side == SEPARATOR) == 5 * dofs
    assert graph[side == FIRST][:, side == SECOND].nnz == 0
    assert min(np.count_nonzero(side == part) for part in (FIRST, SECOND)) >= 0.35 * graph.shape[0]


def test_rows_of_a_node_are_one_vertex() -> None:
    """Rows with the same neighbours, however they are numbered: 12 × 9 vertices of three rows."""
    order = np.random.default_rng(0).permutation(12 * 9 * 3)
    vertices, place = compress(grid(12, 9, 3)[order][:, order].tocsr(), None)
    assert (vertices.weights == 3).all()
    assert len(vertices.weights) == 12 * 9
    vertex = np.empty(len(order), dtype=int)
    vertex[order] = place
    assert (vertex.reshape(-1, 3) == vertex.reshape(-1, 3)[:, :1]).all()
    assert vertices.graph.diagonal().sum() == 0.0


def test_nothing_separates_a_full_graph() -> None:
    """All rows are in the separator, so that the recursion ends."""
    assert (bisect(compress(sp.csr_matrix(np.diag(np.arange(1.0, 7.0)) + 1.0), None)[0]) == SEPARATOR).all()
    full = sp.csr_matrix(np.ones((6, 6)) + np.eye(6))
    order, tree = dissect(full, None, 2)
    assert np.array_equal(np.sort(order), np.arange(6))
    assert tree == SeparatorTree(0, 0, 6)


def test_rows_without_neighbours_are_divided() -> None:
    """Rows without neighbours, with or without a diagonal: two parts, nothing between them."""
    for graph in (sp.eye(10, format="csr"), sp.csr_matrix((10, 10))):
        side = cut(graph)
        assert np.count_nonzero(side == SEPARATOR) <= 1
        assert min(np.count_nonzero(side == part) for part in (FIRST, SECOND)) >= 3


@pytest.mark.parametrize("sizes", [(9, 2, 3, 2), (2, 3, 9, 2), (4, 4, 4)])
def test_disconnected_graphs_are_divided_between_pieces(sizes: tuple[int, ...]) -> None:
    """A graph in pieces, the largest no more than 70 % of it, is cut between pieces or across one, wherever in the
    numbering they are: at most one row in the separator, and at least 30 % of the rows on either side."""
    pieces = sp.block_diag([sp.diags([1.0, 1.0, 1.0], [-1, 0, 1], shape=(n, n)) for n in sizes], format="csr")
    side = cut(pieces)
    assert np.count_nonzero(side == SEPARATOR) <= 1
    assert min(np.count_nonzero(side == part) for part in (FIRST, SECOND)) >= 0.3 * sum(sizes)
    assert pieces[side == FIRST][:, side == SECOND].nnz == 0


def test_wide_coupling_joins_the_separator() -> None:
    """A strip of 40 × 5 nodes whose first row of nodes couples over four columns (as Nitsche's constant term on a
    flank). Cut along the strip's graph: one column of nodes, and of one side those that couple across it."""
    graph = grid(40, 5)
    wide = sp.kron(sp.diags([1.0] * 9, list(range(-4, 5)), shape=(40, 40)), sp.diags([1.0, 0, 0, 0, 0]), format="csr")
    wide.eliminate_zeros()
    matrix = (graph + 0.1 * wide).tocsr()
    side = cut(matrix, graph)
    assert matrix[side == FIRST][:, side == SECOND].nnz == 0
    column = np.arange(200) // 5
    middle = np.flatnonzero(np.bincount(column[side == SEPARATOR]) == 5)
    assert len(middle) == 1
    beside = column[side == SEPARATOR] - middle[0]
    assert sorted(beside[beside != 0] * np.sign(beside.sum())) == [1, 2, 3]


def test_separator_tree_tiles_the_rows() -> None:
    """Children begin where the one before ends, a range of rows is divided or no larger than a leaf, and no entry of
    the matrix in elimination order joins two children."""
    matrix = grid(30, 30, 2)
    order, tree = dissect(matrix, None, 100)
    assert np.array_equal(np.sort(order), np.arange(matrix.shape[0]))
    new = matrix[order][:, order]
    assert max(leaf.end - leaf.begin for leaf in leaves(tree)) <= 100

    def check(part: SeparatorTree) -> None:
        if not part.children:
            return
        assert [part.begin, *(p.end for p in part.children)] == [*(p.begin for p in part.children), part.separator]
        first, second = part.children
        assert new[first.begin : first.end, second.begin : second.end].nnz == 0
        for inner in part.children:
            check(inner)

    check(tree)
    assert len(list(leaves(tree))) >= 16


def test_elimination_order_is_reproducible() -> None:
    """Seeds are fixed: the same graph has the same order twice."""
    assert np.array_equal(dissect(grid(30, 30), None, 50)[0], dissect(grid(30, 30), None, 50)[0])


def test_missing_metis_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """The message says what to install."""
    elimination_order._library.cache_clear()
    monkeypatch.setattr(elimination_order, "find_library", lambda _: None)
    with pytest.raises(RuntimeError, match="install Debian's libmetis5"):
        cut(grid(3, 3))
    elimination_order._library.cache_clear()
