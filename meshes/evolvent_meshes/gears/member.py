"""Which gear of a pair: the pinion or the wheel."""

from __future__ import annotations

from enum import IntEnum
from typing import Literal

MemberName = Literal["pinion", "wheel"]


class Member(IntEnum):
    """One gear of a pair, and its index wherever a pair has one entry a gear, as in `GearPair.gears`."""

    PINION = 0
    WHEEL = 1

    @property
    def label(self) -> MemberName:
        """Its name in scene files and reports."""
        return "pinion" if self is Member.PINION else "wheel"

    @property
    def sign(self) -> int:
        """+1 for the pinion, −1 for the wheel: of what counts the other way on the wheel. Tooth pair i has tooth
        sign·i, the roll length grows by sign·ξ, the flanks open by sign·u."""
        return 1 if self is Member.PINION else -1

    @property
    def mate(self) -> Member:
        """The other gear."""
        return Member.WHEEL if self is Member.PINION else Member.PINION

    @classmethod
    def named(cls, label: MemberName) -> Member:
        """The gear with this label."""
        return cls.PINION if label == "pinion" else cls.WHEEL
