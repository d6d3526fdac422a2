"""Numbers formatted for sentences and tables."""

from __future__ import annotations

import math


def signed(value: float, digits: int = 1) -> str:
    """A number with its sign and so many decimal places; a minus is U+2212, a rounded zero has no sign."""
    return f"{value:+.{digits}f}".replace("-", "−") if round(value, digits) else fixed(value, digits)


def brief(value: float, digits: int = 2) -> str:
    """A number with so many significant digits, without an exponent; integer digits are never rounded away."""
    places = digits - 1 - math.floor(math.log10(abs(value))) if value else 0
    return fixed(value, max(0, places))


def fixed(value: float, digits: int) -> str:
    """A number with so many decimal places; a rounded zero has no sign."""
    return f"{round(value, digits) + 0.0:.{digits}f}"


def cycles_label(cycles: float) -> str:
    """A number of cycles in words, such as "0.4 million" or "20 thousand"."""
    for size, name in ((1e9, " billion"), (1e6, " million"), (1e3, " thousand")):
        if cycles >= 0.1 * size:
            return f"{cycles / size:.4g}{name}"
    return f"{cycles:.4g}"
