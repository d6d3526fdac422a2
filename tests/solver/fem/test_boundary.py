"""Supports, loads and rigid couplings that say nothing or too much are refused."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from evolvent.fem.boundary import BodyForce, Fixed, Freedom, Rigid, Traction


@pytest.mark.parametrize("values", [{}, {"load": 1.0, "displacement": 1.0}])
def test_freedom_has_a_load_or_a_displacement(values: dict[str, float]) -> None:
    """Neither and both are refused."""
    with pytest.raises(ValueError, match="exactly one"):
        Freedom("x", **values)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Fixed("top", "xx"), "each once"),
        (lambda: Fixed("top", "xy", 0.1), "one direction for a displacement"),
        (lambda: Traction("top", (1.0,)), "two finite components"),
        (lambda: BodyForce((1.0, float("nan"))), "two finite components"),
        (lambda: Freedom("u", load=1.0), "one of the rigid motions"),
        (lambda: Rigid("top", (Freedom("x", load=1.0), Freedom("x", load=2.0))), "each freedom once"),
    ],
)
def test_impossible_conditions_are_refused(make: Callable[[], object], message: str) -> None:
    """Each is a ValueError that names what was wanted."""
    with pytest.raises(ValueError, match=message):
        make()
