"""The two gears of a pair: pinion and wheel."""

from __future__ import annotations

from enum import IntEnum
from typing import Literal

MemberName = Literal["pinion", "wheel"]


class Member(IntEnum):
    """One gear of a pair; its value is the index in tuples with one entry for each gear, such as `GearPair.gears`."""

    PINION = 0
    WHEEL = 1

    @property
    def label(self) -> MemberName:
        """Name of the gear in scene files and reports."""
        return "pinion" if self is Member.PINION else "wheel"

    @property
    def sign(self) -> int:
        """Sign of quantities that are opposite on the two gears: +1 for the pinion, −1 for the wheel.

        Tooth pair i consists of the teeth sign·i, the roll length increases by sign·ξ, the gap by sign·u.
        """
        return 1 if self is Member.PINION else -1

    @property
    def mate(self) -> Member:
        """Mating gear."""
        return Member.WHEEL if self is Member.PINION else Member.PINION

    @classmethod
    def named(cls, label: MemberName) -> Member:
        """The gear with this label."""
        return cls.PINION if label == "pinion" else cls.WHEEL
