"""The two gears of a pair: index, name, sign and mate."""

from __future__ import annotations

import pytest

from evolvent_meshes.gears.member import Member
from tests.support.paper_pairs import he


@pytest.mark.parametrize("member", Member)
def test_member_is_the_index_of_its_gear_in_a_pair(member: Member) -> None:
    """Problem: a pair's gears, picked by member. Exact: the attribute of the member's name."""
    pair = he()
    assert pair.gears[member] is getattr(pair, member.label)
    assert Member.named(member.label) is member


def test_mates_have_opposite_signs() -> None:
    """Exact: each is the mate of its mate, the pinion's sign is +1."""
    assert list(Member) == [Member.PINION, Member.WHEEL]
    assert (Member.PINION.mate, Member.WHEEL.mate) == (Member.WHEEL, Member.PINION)
    assert (Member.PINION.sign, Member.WHEEL.sign) == (1, -1)
