"""Numbers as they stand in sentences."""

from __future__ import annotations


def signed(value: float, digits: int = 1) -> str:
    """A number with its sign, a true minus; what rounds to zero has no sign."""
    return f"{value:+.{digits}f}".replace("-", "−") if round(value, digits) else fixed(value, digits)


def fixed(value: float, digits: int) -> str:
    """A number with so many digits; what rounds to zero has no sign."""
    return f"{round(value, digits) + 0.0:.{digits}f}"
