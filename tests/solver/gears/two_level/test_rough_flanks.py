"""Groups of nodes that the rough compliance of flanks couples."""

from __future__ import annotations

import numpy as np

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
