"""Vertex separators: what they must do to a graph, whatever METIS does inside."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from solver import separator
from solver.separator import FIRST, SECOND, SEPARATOR, vertex_separator


def grid(n: int, m: int, dofs: int = 1) -> sp.csr_matrix:
    """The graph of an n × m grid of nodes that meet their eight neighbours, `dofs` rows a node."""
    line = [sp.diags([1.0, 1.0, 1.0], [-1, 0, 1], shape=(k, k)) for k in (n, m)]
    return sp.kron(sp.kron(*line), np.ones((dofs, dofs)), format="csr")


@pytest.mark.parametrize("dofs", [1, 3])
def test_strip_is_cut_across(dofs: int) -> None:
    """A strip of 40 × 5 nodes: the smallest separator is one column of 5 nodes, with all their rows."""
    graph = grid(40, 5, dofs)
    side = vertex_separator(graph)
    assert np.count_nonzero(side == SEPARATOR) == 5 * dofs
    assert graph[side == FIRST][:, side == SECOND].nnz == 0
    assert min(np.count_nonzero(side == part) for part in (FIRST, SECOND)) >= 0.35 * graph.shape[0]


def test_rows_of_a_node_stay_together() -> None:
    """Rows with the same neighbours, however they are numbered, are on the same side."""
    order = np.random.default_rng(0).permutation(12 * 9 * 3)
    graph = grid(12, 9, 3)[order][:, order].tocsr()
    side = np.empty(len(order), dtype=int)
    side[order] = vertex_separator(graph)
    assert (side.reshape(-1, 3) == side.reshape(-1, 3)[:, :1]).all()


def test_nothing_separates_a_full_graph() -> None:
    """Everything is in the separator, so that whoever recurses comes to an end."""
    assert (vertex_separator(sp.csr_matrix(np.ones((6, 6)))) == SEPARATOR).all()


def test_loose_rows_are_shared_out() -> None:
    """Rows without neighbours, with or without a diagonal: two parts, nothing between them."""
    for graph in (sp.eye(10, format="csr"), sp.csr_matrix((10, 10))):
        side = vertex_separator(graph)
        assert np.count_nonzero(side == SEPARATOR) <= 1
        assert min(np.count_nonzero(side == part) for part in (FIRST, SECOND)) >= 3


def test_same_cut_every_time() -> None:
    """Runs repeat bit for bit, so the seed is fixed."""
    assert np.array_equal(vertex_separator(grid(30, 30)), vertex_separator(grid(30, 30)))


def test_without_metis(monkeypatch: pytest.MonkeyPatch) -> None:
    """The message says what to install."""
    separator._library.cache_clear()
    monkeypatch.setattr(separator, "find_library", lambda _: None)
    with pytest.raises(RuntimeError, match="install Debian's libmetis5"):
        vertex_separator(grid(3, 3))
    separator._library.cache_clear()
