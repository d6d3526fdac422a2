"""Checks of input: what passes is converted, what does not says what was wanted, what was found and what to do."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.member import Member
from evolvent_meshes.input_checks import array, members, number, one_of, shown, text, vector

NAN = float("nan")


@pytest.mark.parametrize(
    ("check", "message"),
    [
        (lambda: number("E", "210e3"), "E: wanted a finite number, found '210e3'; give a number"),
        (lambda: number("E", True), "found True"),
        (lambda: number("E", NAN), "found nan"),
        (lambda: number("E", -1.0, "a number > 0", "give one", lambda E: E > 0), "wanted a number > 0, found -1.0"),
        (lambda: number("E", 1e31), "wanted numbers up to 1e+30, found 1e+31; check the unit: mm, N, MPa"),
        (lambda: vector("v", (1.0,), (2, 3), "two or three numbers", "give them"), "found (1.0,); give them"),
        (lambda: vector("v", "xy", (2,), "two numbers", "give them"), "found 'xy'"),
        (lambda: array("a", [[1.0], [2.0, 3.0]], ((2, 2),), "give a matrix"), "wanted finite numbers of shape (2, 2)"),
        (lambda: array("a", np.zeros((9, 9)), ((2, 2),), "give one"), "found an array of shape (9, 9) and type"),
        (lambda: array("a", np.full(9, NAN), ((9,),), "give one"), "of shape (9,), found nan in it; give one"),
        (lambda: vector("v", [1.0] * 8 + [NAN], (9,), "nine numbers", "give them"), "found nan in it; give them"),
        (lambda: text("name", "", "give a name"), "name: wanted a name, found ''; give a name"),
        (lambda: members("loads", 3, (int,), "(1, 2)"), "loads: wanted a tuple of int, found 3; write (1, 2)"),
        (lambda: members("loads", [1, "x"], (int,), "(1, 2)"), "found 'x' in it"),
        (lambda: one_of("order", 3, (1, 2)), "order: wanted 1 or 2, found 3; take one of them"),
        (lambda: one_of("on", "pinion", tuple(Member)), "on: wanted Member.PINION or Member.WHEEL, found 'pinion'"),
        (lambda: one_of("on", Member.WHEEL, ("wheel",)), "on: wanted 'wheel', found Member.WHEEL; take one of them"),
    ],
)
def test_wrong_values_are_refused(check: Callable[[], Any], message: str) -> None:
    """InputError, which is a ValueError, with the message in the wording of all errors."""
    with pytest.raises(InputError) as caught:
        check()
    assert message in str(caught.value)


def test_right_values_are_converted() -> None:
    """An int to float, a list to a tuple, a nested list to an array."""
    assert number("E", 3) == 3.0 and isinstance(number("E", 3), float)
    assert vector("v", [1, 2], (2,), "", "") == (1.0, 2.0)
    assert array("a", [[1, 2], [3, 4]], ((2, 2),), "").dtype == np.float64
    assert members("loads", [1, 2], (int,), "") == (1, 2)


def test_long_values_are_shortened() -> None:
    """A text of 200 characters is shown with 80 of them."""
    assert len(shown("x" * 200)) == 80 and shown("x" * 200).endswith("...")
