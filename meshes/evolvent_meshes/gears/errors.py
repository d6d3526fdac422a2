"""Error of a gear that cannot be cut, or of a pair that cannot run."""

from __future__ import annotations

from numbers import Real

from evolvent_meshes.errors import InputError
from evolvent_meshes.input_checks import shown


class GeometryError(InputError):
    """A gear that cannot be cut, or a pair that cannot run.

    key: name of the field.
    found: its value.
    allowed: the values that are allowed.
    remedy: what to do.
    """

    def __init__(self, key: str, found: object, allowed: str, remedy: str) -> None:
        super().__init__(f"{key}: found {found}, allowed {allowed}. {remedy}")
        self.key, self.found, self.allowed, self.remedy = key, str(found), allowed, remedy


def require_numbers(**values: object) -> None:
    """Raises GeometryError for a value that is no number, such as the text "3.0"; each has its field's name."""
    for key, value in values.items():
        is_number = isinstance(value, Real) and not isinstance(value, bool)
        require(is_number, key, shown(value), "a number", "Give it without quotes.")


def require_instance(value: object, kind: type, key: str, remedy: str) -> None:
    """Raises GeometryError unless the value of a field is of this type."""
    require(isinstance(value, kind), key, shown(value), kind.__name__, remedy)


def require(holds: bool, key: str, found: object, allowed: str, remedy: str) -> None:
    """Raises GeometryError unless a rule holds; numbers are shown with six digits."""
    if not holds:
        raise GeometryError(key, f"{found:.6g}" if isinstance(found, float) else found, allowed, remedy)
