"""Boundary conditions and loads of a body: supports, tractions, body forces, rigid coupling."""

from __future__ import annotations

from dataclasses import dataclass

from evolvent_meshes.errors import InputError
from evolvent_meshes.input_checks import members, number, refuse, text, vector

DIRECTIONS = {2: ("x", "y", "rz"), 3: ("x", "y", "z", "rx", "ry", "rz")}
"""Dimension -> its rigid motions, in the order of `rigid_modes`."""
AXES = "xyz"


@dataclass(frozen=True)
class Fixed:
    """A support: the displacement of a facet group is zero in some directions, or has a prescribed value in one.

    group: name of the facet group.
    directions: letters of "xyz"; by default all directions of the body.
    displacement: prescribed displacement [mm], multiplied by the load factor of a step; it needs a single direction.
    Raises InputError.

    >>> Fixed("symmetry_x", "x")
    Fixed(group='symmetry_x', directions='x', displacement=0.0)
    """

    group: str
    directions: str = "xyz"
    displacement: float = 0.0

    def __post_init__(self) -> None:
        text("support", self.group, 'give the name of a facet group, as in Fixed("bottom")')
        what, letters = f"support of {self.group!r}", self.directions
        if not (
            isinstance(letters, str) and letters and set(letters) <= set(AXES) and len(set(letters)) == len(letters)
        ):
            refuse(what, 'directions out of "xyz", each once', letters, 'write "x", "xy" or "xyz"')
        number(what, self.displacement, "a finite displacement [mm]", "give a number")
        if self.displacement and len(letters) != 1:
            refuse(what, "one direction for a displacement", letters, 'name it, as in Fixed("top", "y", 0.1)')


@dataclass(frozen=True)
class Traction:
    """A constant traction on a facet group, in the frame of the body.

    group: name of the facet group; on a rigidly coupled one the resultant loads the freedoms of the coupling.
    vector: (d,) components [MPa].
    Raises InputError.
    """

    group: str
    vector: tuple[float, ...]

    def __post_init__(self) -> None:
        text("traction", self.group, 'give the name of a facet group, as in Traction("top", (0.0, -1.0))')
        wanted = "two finite components [MPa] in 2D, three in 3D"
        components = vector(f"traction on {self.group!r}", self.vector, (2, 3), wanted, "give one number a direction")
        object.__setattr__(self, "vector", components)


@dataclass(frozen=True)
class BodyForce:
    """A constant body force, in the frame of the body.

    vector: (d,) components [N/mm³]; the weight ϱg of steel is 7.7e-5 N/mm³.
    Raises InputError.
    """

    vector: tuple[float, ...]

    def __post_init__(self) -> None:
        wanted = "two finite components [N/mm³] in 2D, three in 3D"
        components = vector("body force", self.vector, (2, 3), wanted, "give one number a direction")
        object.__setattr__(self, "vector", components)


@dataclass(frozen=True)
class Freedom:
    """A rigid motion of a coupled facet group, either loaded or prescribed.

    direction: "x", "y", "z", or "rx", "ry", "rz" about the centre of the coupling.
    load: force [N] or moment [N·mm], in 2D per mm of thickness; None where the motion is prescribed.
    displacement: displacement [mm] or small angle [rad]; None where the motion is loaded.
    Raises InputError.

    >>> Freedom("y", load=-1000.0)
    Freedom(direction='y', load=-1000.0, displacement=None)
    """

    direction: str
    load: float | None = None
    displacement: float | None = None

    def __post_init__(self) -> None:
        if not (isinstance(self.direction, str) and self.direction in DIRECTIONS[3]):
            refuse(
                "freedom", f"one of the rigid motions {', '.join(DIRECTIONS[3])}", self.direction, "name one of these"
            )
        what = f"freedom {self.direction!r}"
        if (self.load is None) == (self.displacement is None):
            found = "neither" if self.load is None else "both"
            raise InputError(f"{what}: wanted either a load or a displacement, found {found}; give exactly one")
        given = self.displacement if self.load is None else self.load
        number(what, given, "a finite load or displacement", "give a number in N, N·mm, mm or rad")


@dataclass(frozen=True)
class Rigid:
    """A rigid coupling: a facet group that moves as a rigid body.

    group: name of the facet group.
    freedoms: motions that are loaded or prescribed; all others are zero.
    centre: point about which the group rotates [mm].
    Raises InputError.
    """

    group: str
    freedoms: tuple[Freedom, ...] = ()
    centre: tuple[float, ...] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        text("rigid coupling", self.group, 'give the name of a facet group, as in Rigid("top")')
        what = f"rigid coupling of {self.group!r}"
        freedoms = members(what, self.freedoms, (Freedom,), '(Freedom("y", load=-1.0),)')
        names = [f.direction for f in freedoms]
        if len(set(names)) < len(names):
            refuse(what, "each freedom once", names, "give a motion one load or one displacement")
        wanted = "a centre of two or three finite coordinates [mm]"
        object.__setattr__(self, "freedoms", freedoms)
        object.__setattr__(self, "centre", vector(what, self.centre, (2, 3), wanted, "write (x, y, z)"))
