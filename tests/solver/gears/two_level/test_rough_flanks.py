"""Groups of nodes that the rough compliance of flanks couples."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from evolvent.gears.two_level import rough_flanks


def test_groups_are_halved_until_few_nodes_are_in_one() -> None:
    """100 nodes on each of 8 levels: of groups 1, 1/2 and 1/4 high, the last have 200 nodes, no more than 250."""
    near, groups = rough_flanks._groups(np.repeat(np.arange(8) / 8, 100), 1.0, 1 / 8)
    assert near == 0.25
    assert [len(each) for each in groups] == [200] * 4


def test_level_with_many_nodes_is_one_group() -> None:
    """A window over the whole profile has more nodes on a level than a group should have: halving ends there."""
    near, groups = rough_flanks._groups(np.repeat(np.arange(4) / 4, 400), 1.0, 1 / 4)
    assert near == 0.25
    assert [len(each) for each in groups] == [400] * 4


def test_sum_of_parts_between_near_nodes() -> None:
    """Σ N S Nᵀ of two parts in three groups, of which one reads no node, against the matrices written out."""
    random = np.random.default_rng(1)
    z = np.sort(random.random(60))[random.permutation(60)]
    near, members = 0.4, [np.flatnonzero((z * 2.5).astype(int) == each) for each in range(3)]
    wanted, parts = np.zeros((60, 60)), []
    for size, density in ((40, 0.1), (7, 0.9)):
        N = sp.random(60, size, density, format="csr", random_state=2).astype(np.float32)
        N = sp.csr_matrix(N.multiply(~np.isin(np.arange(60), members[1])[:, None]))
        S = random.normal(size=(size, size)).astype(np.float32)
        S += S.T
        parts.append((N, lambda rows, columns, S=S: S[slice(*rows), slice(*columns)]))
        wanted += N @ S @ N.T
    found = rough_flanks._near_rows(z, near, members, parts).toarray()
    assert np.abs(found - np.where(np.abs(z[:, None] - z) <= near, wanted, 0.0)).max() < 1e-5 * np.abs(wanted).max()
