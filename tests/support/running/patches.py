"""Functions that tests put in the place of others, with the parameters of what they replace."""

from __future__ import annotations

from collections.abc import Callable
from typing import ParamSpec, TypeVar

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")


def calling_first(
    original: Callable[Parameters, Result], action: Callable[Parameters, object]
) -> Callable[Parameters, Result]:
    """The function, before each call of which the action is called with the same arguments."""
    def patched(*arguments: Parameters.args, **options: Parameters.kwargs) -> Result:
        action(*arguments, **options)
        return original(*arguments, **options)
    return patched


def with_result(
    original: Callable[Parameters, Result], changed: Callable[[Result], Result]
) -> Callable[Parameters, Result]:
    """The function, whose result is changed."""
    def patched(*arguments: Parameters.args, **options: Parameters.kwargs) -> Result:
        return changed(original(*arguments, **options))
    return patched
