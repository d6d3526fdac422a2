"""Cells cut out of a mesh: their groups, and where they were cut."""

from __future__ import annotations

import numpy as np

from evolvent_meshes.mesh.patches import CUT, cells_near, cut_out
from evolvent_meshes.shapes.blocks import rectangle


def test_cells_near_have_a_node_within_reach() -> None:
    """Of 8 × 4 unit cells, those within 1.2 of the third top facet: columns 1 to 3 of the two upper rows, and columns
    0 and 4 of the uppermost, which begin at distance 1, and √2 below it. Exact."""
    mesh = rectangle(8.0, 4.0, 8, 4)
    third = np.flatnonzero(np.abs(mesh.points[mesh.facets["top"][:, -1], 0] - 2.5) < 1e-9)
    near = cells_near(mesh, np.unique(mesh.facets["top"][third]), 1.2)
    centres = mesh.points[mesh.cells[near, -1]]
    assert sorted(map(tuple, centres[:, :2])) == [
        (0.5, 3.5), (1.5, 2.5), (1.5, 3.5), (2.5, 2.5), (2.5, 3.5), (3.5, 2.5), (3.5, 3.5), (4.5, 3.5),
    ]


def test_patch_keeps_groups_and_names_its_cut() -> None:
    """A corner of 2 × 2 cells out of 4 × 3: two facets each on left and top, two on each side of the cut, and every
    node has its number in the body. Exact."""
    mesh = rectangle(4.0, 3.0, 4, 3)
    centres = mesh.points[mesh.cells[:, -1]]
    patch = cut_out(mesh, np.flatnonzero((centres[:, 0] < 2.0) & (centres[:, 1] > 1.0)))
    assert {name: len(rows) for name, rows in patch.mesh.facets.items()} == {
        "left": 2, "right": 0, "bottom": 0, "top": 2, CUT: 4,
    }
    assert np.array_equal(mesh.points[patch.nodes], patch.mesh.points)
    cut = patch.mesh.points[patch.mesh.facets[CUT][:, -1]]
    assert np.all((np.abs(cut[:, 0] - 2.0) < 1e-12) | (np.abs(cut[:, 1] - 1.0) < 1e-12))


def test_patch_of_a_patch_is_cut_on_both() -> None:
    """Where the first cut lies on the second patch, it is cut there too: 2 × 1 cells at the inner corner. Exact."""
    mesh = rectangle(4.0, 3.0, 4, 3)
    centres = mesh.points[mesh.cells[:, -1]]
    first = cut_out(mesh, np.flatnonzero(centres[:, 0] < 2.0))
    inner = first.mesh.points[first.mesh.cells[:, -1], 1] > 2.0
    second = cut_out(first.mesh, np.flatnonzero(inner))
    assert {name: len(rows) for name, rows in second.mesh.facets.items()} == {
        "left": 1, "right": 0, "bottom": 0, "top": 2, CUT: 3,
    }
