"""Options that commands share."""

from __future__ import annotations

import pytest
import typer

from evolvent.commands.options import given_percents
from evolvent.scene.schema.loading import MOST_TORQUES


def test_a_list_of_torques_is_as_long_as_a_scenes() -> None:
    """30 percentages are taken, 31 refused with their number: each of them costs a run. Once, a thousand were taken."""
    numbers = [str(number) for number in range(1, MOST_TORQUES + 2)]
    assert given_percents(",".join(numbers[:-1])) == tuple(float(number) for number in numbers[:-1])
    with pytest.raises(typer.BadParameter, match=r"--percent: found 31 numbers; allowed: up to 30"):
        given_percents(",".join(numbers))
