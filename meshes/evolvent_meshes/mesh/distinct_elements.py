"""Elements that a mesh file has more than once: those with the same nodes are one.

A cell or facet may be in several groups. MSH 4.1 has it once, by its tag; MSH 2.2 once for each group, with other tags.
"""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Ints


def unique_cells(groups: dict[str, tuple[Ints, Ints]]) -> tuple[Ints, dict[str, Ints]]:
    """Nodes of the cells by ascending tag, and the indices of each group's cells; a cell may be in several groups.

    groups: tags (n,) and nodes (n, nodes) of each one's elements.
    """
    tags, first = np.unique(np.concatenate([t for t, _ in groups.values()]), return_index=True)
    nodes = np.concatenate([n for _, n in groups.values()])[first]
    kept, number = distinct(nodes)
    return nodes[kept], {name: np.unique(number[np.searchsorted(tags, t)]) for name, (t, _) in groups.items()}


def distinct(elements: Ints) -> tuple[Ints, Ints]:
    """Indices of the different elements (n, nodes), in their order, and the number of each one among these (n,)."""
    _, first, which = np.unique(np.sort(elements, axis=1), axis=0, return_index=True, return_inverse=True)
    kept = np.sort(first)
    return kept, np.searchsorted(kept, first[which.ravel()])


def each_once(elements: Ints) -> Ints:
    """The different elements (m, nodes) of these (n, nodes), in their order."""
    return np.asarray(elements[distinct(elements)[0]])
