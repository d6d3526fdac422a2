"""The error of a gear or a pair that cannot exist."""

from __future__ import annotations

from evolvent_meshes.errors import InputError


class GeometryError(InputError):
    """A gear or a pair that can't exist: which key, what was found, what is allowed, what to do."""

    def __init__(self, key: str, found: object, allowed: str, remedy: str) -> None:
        super().__init__(f"{key}: found {found}, allowed {allowed}. {remedy}")
        self.key, self.found, self.allowed, self.remedy = key, str(found), allowed, remedy


def require(holds: bool, key: str, found: object, allowed: str, remedy: str) -> None:
    """Raise GeometryError unless a rule holds; figures are shown with six digits."""
    if not holds:
        raise GeometryError(key, f"{found:.6g}" if isinstance(found, float) else found, allowed, remedy)
