"""The definition of a contact problem: bodies, pairs of surfaces that may touch, steps."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any

import numpy as np

from evolvent.contact.nitsche.flux_recovery import SAFETY
from evolvent.contact.problem.body_names import body_number, freedom_pairs, is_body
from evolvent.fem.body import Body, Freedom
from evolvent.fem.surface import boundary_group
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError
from evolvent_meshes.input_checks import Words, array, members, number, refuse

Side = tuple[int, str]
"""One side of a contact: index of the body in the problem, name of a facet group."""
BodySide = tuple[Body, str]
"""A side with the body itself, as body["top"] gives it."""
ORTHONORMAL = 1e-9  # largest entry of |RᵀR − I| of a rotation


@dataclass(frozen=True, init=False)
class Contact:
    """Two surfaces that may touch: body["top"], or (body index, facet group), each.

    first: the surface that carries the pressure, unless its body is more than ten times as stiff as the other one
        (pressure_carrier.py); take the coarser one.
    second: the other surface; it may belong to the same body.
    friction: Coulomb's coefficient of friction μ.
    reach: the largest gap [mm] at which a point can come into contact within a step; by default a tenth of the first
        surface's extent.

    A problem's contacts have indices in place of bodies.
    Raises InputError.

    >>> contact = Contact((0, "arc"), (1, "top"), friction=0.15)
    >>> contact.second
    (1, 'top')
    """

    first: Side
    second: Side
    friction: float = 0.0
    reach: float | None = None

    def __init__(
        self, first: Side | BodySide, second: Side | BodySide, friction: float = 0.0, reach: float | None = None
    ) -> None:
        for name, side in (("first", first), ("second", second)):
            pair = isinstance(side, tuple | list) and len(side) == 2
            if not (pair and is_body(side[0]) and isinstance(side[1], str)):
                wanted = "a body's index and a facet group, or a body's side"
                refuse(f"contact, {name} side", wanted, side, 'write block["top"], or (0, "top")')
            object.__setattr__(self, name, tuple(side))
        object.__setattr__(self, "friction", friction)
        object.__setattr__(self, "reach", reach)
        self._check()

    def _check(self) -> None:
        if self.first == self.second:
            refuse("contact", "two different surfaces", Words(f"{self.first[1]!r} twice"), "name the other surface")
        remedy = "give Coulomb's μ, 0 without friction"
        number("contact, friction", self.friction, "a finite number >= 0", remedy, lambda μ: μ >= 0.0)
        if self.reach is not None:
            remedy = "leave it out for a tenth of the first surface's extent"
            number("contact, reach", self.reach, "a finite number > 0 [mm]", remedy, lambda reach: reach > 0.0)

    def numbered(self, bodies: Sequence[Body]) -> Contact:
        """The contact with indices in place of bodies. Raises InputError for a body that is not among `bodies`."""
        first, second = (
            (body_number(bodies, body, f"contact, {name} side"), group)
            for name, (body, group) in (("first", self.first), ("second", self.second))
        )
        return replace(self, first=first, second=second)


@dataclass(frozen=True)
class Nitsche:
    """Settings of Nitsche's method; the defaults suit nearly all problems.

    safety: stabiliser γ over its coercivity limit, > 0; θ = 1 needs about 1.2.
    theta: variant θ in [−1, 1]: 1 symmetric, 0 incomplete, −1 skew-symmetric.
    Raises InputError.

    Source: Chouly, Fabre, Hild, Mlika, Pousin, Renard 2017, An overview of recent results on Nitsche's method for
    contact problems.
    """

    safety: float = SAFETY
    theta: float = 1.0

    def __post_init__(self) -> None:
        number("nitsche, safety", self.safety, "a finite number > 0", f"{SAFETY:g} is the default", lambda x: x > 0.0)
        number("nitsche, theta", self.theta, "−1 <= θ <= 1", "take 1, 0 or −1", lambda θ: abs(θ) <= 1.0)


@dataclass(frozen=True)
class Problem:
    """Bodies and the contacts between them; `solve` and `sweep` find its equilibria.

    bodies: all 2D or all 3D, each in at least one contact; a body in none has nothing to do with the others.
    contacts: every pair of surfaces once.
    nitsche: settings of the method.
    Raises InputError; MeshError for a facet group that cannot be in contact.

    >>> from evolvent import Body, Fixed, Freedom, Rigid
    >>> from evolvent_meshes.shapes.blocks import rectangle
    >>> base = Body(rectangle(2.0, 1.0, 4, 2), supports=(Fixed("bottom"),), name="base")
    >>> punch = Body(rectangle(1.0, 1.0, 3, 3, origin=(0.5, 1.0)), rigid=Rigid("top", (Freedom("y", load=-100.0),)))
    >>> problem = Problem((base, punch), (Contact(base["top"], punch["bottom"]),))
    >>> problem.contacts[0].first
    (0, 'top')
    """

    bodies: tuple[Body, ...]
    contacts: tuple[Contact, ...]
    nitsche: Nitsche = Nitsche()

    def __post_init__(self) -> None:
        object.__setattr__(self, "bodies", members("problem, bodies", self.bodies, (Body,), "(punch, block)"))
        example = '(Contact((0, "face"), (1, "top")),)'
        contacts = members("problem, contacts", self.contacts, (Contact,), example)
        object.__setattr__(self, "contacts", tuple(contact.numbered(self.bodies) for contact in contacts))
        if not isinstance(self.nitsche, Nitsche):
            refuse("problem, nitsche", "a Nitsche", self.nitsche, "write Nitsche(theta=-1.0), or leave it out")
        for contact in self.contacts:
            for side in (contact.first, contact.second):
                self._check_side(side)
        self._check_all_touched()
        self._check_distinct()
        if len({body.mesh.dimension for body in self.bodies}) > 1:
            refuse("problem", "all bodies in 2D or all in 3D", Words("both"), "model all of them in the same dimension")

    def _check_side(self, side: Side) -> None:
        index, group = side
        if not 0 <= index < len(self.bodies):
            raise InputError(
                f"contact: wanted a body index below {len(self.bodies)}, found {index}; bodies are counted from 0"
            )
        boundary_group(self.bodies[index].mesh, group, f"contact, body {index} ({self.bodies[index].name!r})")

    def _check_all_touched(self) -> None:
        touched = {index for contact in self.contacts for index, _ in (contact.first, contact.second)}
        alone = [f"body {index} ({body.name!r})" for index, body in enumerate(self.bodies) if index not in touched]
        if alone or not self.contacts:
            raise InputError(
                f"problem: wanted at least one contact, and every body in one, found {len(self.contacts)} and none for "
                f"{', '.join(alone) or 'no body'}; add a contact, or leave the body out"
            )

    def _check_distinct(self) -> None:
        """Refuses facets that are in contact with the same facets twice: their pressure would count twice."""
        for contact in self.contacts:
            if contact.first[0] == contact.second[0] and self._shared(contact.first, contact.second):
                refuse("contact", "two surfaces without common facets", (contact.first, contact.second), "part them")
        for one, other in combinations(self.contacts, 2):
            for sides in ((other.first, other.second), (other.second, other.first)):
                if self._shared(one.first, sides[0]) and self._shared(one.second, sides[1]):
                    refuse("problem", "every pair of surfaces in one contact", (one, other), "leave out one of the two")

    def _shared(self, one: Side, other: Side) -> bool:
        """Whether two sides have a facet in common."""
        if one[0] != other[0]:
            return False
        facets = self.bodies[one[0]].mesh.facets
        rows = (np.unique(np.sort(facets[group], axis=1), axis=0) for group in (one[1], other[1]))
        both = np.concatenate(list(rows))
        return one == other or len(np.unique(both, axis=0)) < len(both)


@dataclass(frozen=True)
class Placement:
    """Rigid placement of a body before it deforms: x = rotation·X + translation.

    rotation: (d, d), with orthonormal columns and determinant 1.
    translation: (d,) [mm].
    Raises InputError.
    """

    rotation: Floats
    translation: Floats

    def __post_init__(self) -> None:
        R = array("placement, rotation", self.rotation, ((2, 2), (3, 3)), "np.eye(3) turns nothing")
        d = len(R)
        if not (np.abs(R.T @ R - np.eye(d)).max() <= ORTHONORMAL and np.linalg.det(R) > 0.0):
            remedy = "make it of cosines and sines in full precision; a body cannot be scaled or mirrored"
            refuse("placement, rotation", "a rotation: RᵀR = I, det R = 1", R.tolist(), remedy)
        object.__setattr__(self, "rotation", R)
        x = array("placement, translation", self.translation, ((d,),), f"give {d} coordinates [mm]")
        object.__setattr__(self, "translation", x)

    @staticmethod
    def at_rest(d: int) -> Placement:
        """The placement that leaves a body of dimension d where its mesh is."""
        return Placement(np.eye(d), np.zeros(d))


@dataclass(frozen=True, init=False)
class Step:
    """One load step of a sweep.

    load: factor on all loads, prescribed displacements and motions.
    placements: rigid placements of the bodies, one each; None: all as meshed.
    freedoms: {body: Freedom or several} or pairs of a body and a Freedom, a body itself or its index, that replace, in
        this step, the body's freedom of the same direction. Their values are not multiplied by `load`, so that a
        tangential load can follow a normal one.

    The step of a solution has pairs with indices.
    Raises InputError.

    >>> from evolvent import Freedom
    >>> press, drag = Step(), Step(freedoms={0: Freedom("x", displacement=0.01)})
    >>> drag.load, drag.freedoms[0][0]
    (1.0, 0)
    """

    load: float = 1.0
    placements: tuple[Placement, ...] | None = None
    freedoms: tuple[tuple[int, Freedom], ...] = ()

    def __init__(
        self,
        load: float = 1.0,
        placements: Iterable[Placement] | None = None,
        freedoms: Iterable[tuple[int | Body, Freedom]] | Mapping[Any, Freedom | Iterable[Freedom]] = (),
    ) -> None:
        number("step, load", load, "a finite factor", "give a number, 1 for the whole load")
        if placements is not None:
            example = "(Placement.at_rest(2), Placement(R, x)), one a body"
            placements = members("step, placements", placements, (Placement,), example)
        object.__setattr__(self, "load", load)
        object.__setattr__(self, "placements", placements)
        object.__setattr__(self, "freedoms", freedom_pairs(freedoms))


def numbered_step(problem: Problem, step: Step) -> Step:
    """The step with indices in place of bodies. Raises InputError for a step that does not fit the problem."""
    if not isinstance(step, Step):
        refuse("step", "a Step", step, "write Step(0.5), or a list of steps for a sweep")
    count, d = len(problem.bodies), problem.bodies[0].mesh.dimension
    if step.placements is not None and len(step.placements) != count:
        given = Words(f"{len(step.placements)}")
        remedy = f"Placement.at_rest({d}) moves nothing"
        refuse("step, placements", f"one for each of the {count} bodies", given, remedy)
    if any(len(placement.translation) != d for placement in step.placements or ()):
        refuse("step, placements", f"rotations ({d}, {d})", step.placements, f"the bodies are {d}D")
    freedoms = ((body_number(problem.bodies, body, "step, freedoms"), each) for body, each in step.freedoms)
    step = replace(step, freedoms=tuple(freedoms))
    for index, freedom in step.freedoms:
        if not 0 <= index < count:
            raise InputError(f"step, freedoms: wanted body indices below {count}, found {index}; count them from 0")
        body = problem.bodies[index]
        names = [f.direction for f in body.rigid.freedoms] if body.rigid else []
        if freedom.direction not in names:
            raise InputError(
                f"step: wanted one of the freedoms {names} of {body.name!r} (body {index}), found "
                f"{freedom.direction!r}; declare it in the body's Rigid first"
            )
    return step
