"""What a contact problem states: bodies, the surfaces that may touch, the steps of a sweep."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshes.data import Floats
from solver.body import Body, Freedom
from solver.traction import SAFETY

Side = tuple[int, str]


@dataclass(frozen=True)
class Contact:
    """Two facet groups that may touch: (body index, group name) each.

    first: carries the pressure; the coarser surface. friction: Coulomb's μ. reach: the gap [mm] up to which a node can
    come into contact within a step; by default a tenth of the first surface's extent.
    """

    first: Side
    second: Side
    friction: float = 0.0
    reach: float | None = None


@dataclass(frozen=True)
class Nitsche:
    """γ over its coercivity limit, and θ ∈ {1, 0, −1}: symmetric, incomplete, skew variant."""

    safety: float = SAFETY
    theta: float = 1.0


@dataclass(frozen=True)
class Problem:
    """Bodies and the contacts between them. Raises ValueError for a body or a group that does not exist, and for a body
    in no contact: it feels nothing of the others."""

    bodies: tuple[Body, ...]
    contacts: tuple[Contact, ...]
    nitsche: Nitsche = Nitsche()

    def __post_init__(self) -> None:
        for contact in self.contacts:
            for index, group in (contact.first, contact.second):
                if not 0 <= index < len(self.bodies):
                    raise ValueError(f"contact: wanted a body index below {len(self.bodies)}, found {index}")
                if group not in self.bodies[index].mesh.facets:
                    known = ", ".join(sorted(self.bodies[index].mesh.facets))
                    raise ValueError(f"contact: wanted the facet group {group!r}, found {known}; name one of these")
        touched = {index for contact in self.contacts for index, _ in (contact.first, contact.second)}
        alone = [f"body {index} ({body.name!r})" for index, body in enumerate(self.bodies) if index not in touched]
        if alone or not self.contacts:
            raise ValueError(
                f"problem: wanted at least one contact, and every body in one, found {len(self.contacts)} and none for "
                f"{', '.join(alone) or 'no body'}; add a contact, or leave the body out"
            )


@dataclass(frozen=True)
class Placement:
    """Where a body stands: x = rotation·X + translation, (d, d) and (d,) [mm]."""

    rotation: Floats
    translation: Floats

    @staticmethod
    def at_rest(d: int) -> Placement:
        return Placement(np.eye(d), np.zeros(d))


@dataclass(frozen=True)
class Step:
    """One position of a sweep: a factor on all loads and prescribed motions, and the bodies' placements (None: rest).

    freedoms: (body index, Freedom) pairs that replace, in this step, the body's freedom of the same direction; their
    values are not multiplied by `load`. So a normal load can come first and a tangential one after it.
    """

    load: float = 1.0
    placements: tuple[Placement, ...] | None = None
    freedoms: tuple[tuple[int, Freedom], ...] = ()
