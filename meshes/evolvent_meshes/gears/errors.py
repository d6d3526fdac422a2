"""Error of a gear that cannot be cut, or of a pair that cannot run."""

from __future__ import annotations

from evolvent_meshes.errors import InputError


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


def require(holds: bool, key: str, found: object, allowed: str, remedy: str) -> None:
    """Raises GeometryError unless a rule holds; numbers are shown with six digits."""
    if not holds:
        raise GeometryError(key, f"{found:.6g}" if isinstance(found, float) else found, allowed, remedy)
