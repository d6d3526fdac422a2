"""The search of a gear position: where the flanks face each other, with the frictionless equilibrium.

Flanks are searched at given rotations of both gears, and the equilibrium turns one of them on. So the search is made
again until it was made where the equilibrium is, and in a window that holds all of the contact. All friction
coefficients share its results.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext, suppress
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from evolvent.contact.newton.contact_equations import CondensedSystem
from evolvent.contact.newton.equilibrium import Equilibrium, InitialGuess, frictionless, normal_part
from evolvent.contact.newton.snes import NotConverged
from evolvent.fem.parallel.cores import Threads
from evolvent.gears.contact.contact_geometry import ContactGeometry
from evolvent.gears.contact.overlap_check import UnsearchedOverlap, overlap_outside, unsearched_overlaps
from evolvent.gears.contact.pair_contact import TOLERANCE, GearContact, facing_flanks, gear_contact
from evolvent.gears.contact.tangent_stiffness import tangent_stiffness
from evolvent.gears.gear_model import GearModel
from evolvent.gears.kinematics import PairRotation
from evolvent.gears.position_start import PositionStart
from evolvent.gears.sweep.contact_patch import ContactPatch
from evolvent.gears.sweep.rotation_course import RotationCourse
from evolvent_meshes.arrays import Bools
from evolvent_meshes.gears.member import Member

RELOCATE = 1.7e-4
"""A free rotation that moves the flanks further [modules] is made exact and searched again; the gap is linear in a
smaller one but for its square over the curvature radius, 3e-8 modules. Searches are made at rotations that are whole
multiples of twice this, at the nearest one to the solution: so that results do not depend on where a search starts."""
NEAREST = 1.001
"""Largest displacement of the flanks by the free rotation after which a search is accepted, over RELOCATE. It is a
little above 1, since at the very end of an interval two searches could send each other back and forth."""
NEAREST_AGAIN = 1.2
"""Value of NEAREST where the search has been at a place before: on coarse meshes the solution jumps a little between
two neighbouring places, so that each can send it to the other one."""
FIRST_CONTACT = 0.25
"""Fraction of the window that is assumed to press at first; Newton's method needs fewer steps from too few points."""
WIDENED = 1.5
"""Factor by which a window is widened that the contact does not fit into."""
ROUNDS = 8
START = 5e-4
"""Residual, over the load, of a frictionless state that is no result: friction starts from it, the flanks are searched
where it leaves the gears, and the tangent stiffness is that of its contact: of Yang's pair at standard within 1.4e-4 of
that at 1e-8. Newton's method comes there three to five iterations earlier."""


@dataclass(frozen=True)
class SearchedAt:
    """Angle, rotations and window with which a position was searched.

    angle: of the pinion [rad].
    beyond_nominal: rotations of pinion and wheel beyond the nominal ones [rad].
    half_width: of the window [mm of profile arc].
    """

    angle: float
    beyond_nominal: tuple[float, float]
    half_width: float


@dataclass(frozen=True)
class KnownSolution:
    """Earlier solution of a position, from which it starts where it is solved again with another friction history.

    searched: where its flanks were searched.
    smooth: the solution without friction.
    frictional: that with each friction coefficient.
    """

    searched: SearchedAt
    smooth: InitialGuess
    frictional: Mapping[float, InitialGuess]


@dataclass(frozen=True)
class SharedPosition:
    """Search, condensed system and frictionless equilibrium of a position, shared by all friction coefficients.

    contact: the flanks that face each other.
    system: their condensed system.
    smooth: the frictionless equilibrium, to `START` only where no coefficient has it for its result.
    unsearched: where flanks might touch outside the window.
    """

    contact: GearContact
    system: CondensedSystem
    smooth: Equilibrium
    unsearched: tuple[UnsearchedOverlap, ...]

    @cached_property
    def stiffness(self) -> float:
        """Tangent stiffness of the frictionless mesh along the line of action [N/mm; per mm of width in 2D]."""
        return tangent_stiffness(normal_part(self.system), self.smooth)

    @property
    def patch(self) -> ContactPatch:
        """The contact patch without friction."""
        return ContactPatch.of(self.contact.geometry, self.smooth.traction[:, 0])

    @property
    def searched(self) -> SearchedAt:
        """Angle, rotations and window of the search."""
        return SearchedAt(self.contact.stand.angle, self.contact.stand.beyond_nominal, self.contact.geometry.half_width)


def shared_position(
    model: GearModel, angle: float, beyond_nominal: tuple[float, float], frictions: Sequence[float],
    before: ContactPatch | None, threads: Threads = nullcontext, known: KnownSolution | None = None,
    exact: bool = False, overlaps: bool = True,
) -> SharedPosition:
    """Search, compliance and frictionless equilibrium; the free rotation is made exact, and the window wide enough.

    angle: of the pinion [rad].
    beyond_nominal: predicted rotations beyond the nominal ones [rad], for positions that the model has no start of.
    frictions: the coefficients to come; without one that is not 0 only normal components are condensed.
    before: the contact patch of the last position, None where there is none; it is not needed where the model has a
        start of the position.
    threads: in which compliances are put together.
    known: how it was solved before, None where it was not; it replaces beyond_nominal and before.
    exact: solve the frictionless state to the end, also where no coefficient has it for its result; else to `START`.
    overlaps: look for contact outside the window; else that is left to the caller, by `without_overlaps`.

    Raises NotConverged, SearchError.
    """
    normal_only, tolerance = not any(map(model.has_friction_terms, frictions)), _tolerance(model, frictions, exact)
    guess = _guess(model, angle, before) if known is None else None
    first = known.searched if known is not None else _first_search(model, angle, beyond_nominal, guess)
    stand, half_width = PairRotation(model.pair, angle, first.beyond_nominal), first.half_width
    last: tuple[ContactGeometry, InitialGuess] | None = None
    been = set() if known is None else {known.searched.beyond_nominal}
    for _ in range(ROUNDS):
        nearest = NEAREST_AGAIN if stand.beyond_nominal in been else NEAREST
        been.add(stand.beyond_nominal)
        contact = facing_flanks(
            model.bodies, stand, list(model.teeth), half_width,
            apart="the load may bend the teeth further than the search looks: lower the torque",
            remedy="lower the torque",
        )
        system = contact.system(model.load.on, model.load.at(angle), normal_only, threads)
        pressed = partial(_initially_pressed, contact.geometry, before, guess)
        near = known.smooth if known is not None else _on_same_nodes(last, contact.geometry)
        smooth = _near_or_pressed(replace(normal_part(system), tolerance=tolerance), near, pressed)
        shift = free_shift(model, smooth)
        if contact.geometry.reaches_rim(smooth.traction[:, 0] > 0.0):
            half_width *= WIDENED
        elif abs(shift) <= nearest * RELOCATE * model.pair.pinion.normal_module:
            position = SharedPosition(contact, system, smooth, ())
            accepted = without_overlaps(model, position) if overlaps else position
            if accepted is not None:
                return accepted
            half_width = np.inf
        there, on = stand, model.load.on
        stand = _at_a_multiple(model, there.turned(on, float(smooth.motion[0])))
        turned = stand.beyond_nominal[on] - there.beyond_nominal[on]
        last = contact.geometry, InitialGuess(smooth.force, smooth.motion - turned)
        before, known, guess = ContactPatch.of(contact.geometry, smooth.traction[:, 0]), None, None
    raise NotConverged(
        f"pinion at {np.degrees(angle):.3f}°: the free rotation moves {1e3 * shift:.2f} µm after {ROUNDS} searches"
    )


def without_overlaps(model: GearModel, position: SharedPosition) -> SharedPosition | None:
    """The position with where its flanks might touch outside the window; None where they do, so that it has to be
    searched with whole flanks. Raises SearchError."""
    contact, smooth = position.contact, position.smooth
    unsearched = unsearched_overlaps(contact.geometry, model.teeth)
    depth = overlap_outside(contact, unsearched, smooth.force, free_rotation(model, smooth))
    return replace(position, unsearched=unsearched) if depth == 0.0 else None


def _near_or_pressed(
    system: CondensedSystem, near: InitialGuess | None, pressed: Callable[[], Bools]
) -> Equilibrium:
    """Equilibrium near another one; where there is none, or where flanks have turned too far for Newton's method, from
    points that are assumed to press. Raises NotConverged."""
    if near is not None:
        with suppress(NotConverged):
            return frictionless(system, near=near)
    return frictionless(system, pressed())


def _guess(model: GearModel, angle: float, before: ContactPatch | None) -> PositionStart | None:
    """Start of a position without the one before; None where it has none. In the plane it takes half as long as a
    position, more than it saves where there is one before."""
    if model.starts is None or (before is not None and model.bodies[Member.PINION].d == 2):
        return None
    return model.starts(model, angle)


def _first_search(
    model: GearModel, angle: float, beyond_nominal: tuple[float, float], guess: PositionStart | None
) -> SearchedAt:
    """Where a position is searched at first: at its guess or, without one, at predicted rotations [rad]."""
    half_width = model.half_width
    if guess is not None:
        beyond_nominal = guess.beyond_nominal
        while half_width < guess.reach:
            half_width *= WIDENED
    stand = _at_a_multiple(model, PairRotation(model.pair, angle, beyond_nominal))
    return SearchedAt(angle, stand.beyond_nominal, half_width)


def _on_same_nodes(
    last: tuple[ContactGeometry, InitialGuess] | None, geometry: ContactGeometry
) -> InitialGuess | None:
    """Equilibrium of the last search of a position, as seen from this one, where its nodes are the same."""
    if last is None:
        return None
    same = all(np.array_equal(getattr(last[0], name), getattr(geometry, name)) for name in ("tooth", "z", "arc"))
    return last[1] if same else None


def searched_at(model: GearModel, place: SearchedAt, frictions: Sequence[float]) -> SharedPosition:
    """A position searched at a given place, once. Raises NotConverged, SearchError."""
    stand = PairRotation(model.pair, place.angle, place.beyond_nominal)
    contact = gear_contact(model.bodies, stand, list(model.teeth), place.half_width)
    normal_only = not any(map(model.has_friction_terms, frictions))
    system = contact.system(model.load.on, model.load.at(place.angle), normal_only)
    start = _initially_pressed(contact.geometry, None)
    smooth = frictionless(normal_part(system), start)
    return SharedPosition(contact, system, smooth, unsearched_overlaps(contact.geometry, model.teeth))


def _tolerance(model: GearModel, frictions: Sequence[float], exact: bool) -> float:
    """Tolerance of the frictionless state: it is the result of coefficients without friction terms."""
    return START if all(map(model.has_friction_terms, frictions)) and not exact else TOLERANCE


def free_rotation(model: GearModel, equilibrium: Equilibrium) -> tuple[float, float]:
    """Rotations of pinion and wheel [rad] from the search to the equilibrium."""
    free = float(equilibrium.motion[0])
    return (free, 0.0) if model.load.on == Member.PINION else (0.0, free)


def course_after(model: GearModel, shared: SharedPosition, before: RotationCourse | None) -> RotationCourse:
    """The course of the free rotation with this position; before: without it."""
    stand, (pinion, wheel) = shared.contact.stand, free_rotation(model, shared.smooth)
    found = stand.beyond_nominal[0] + pinion, stand.beyond_nominal[1] + wheel
    return RotationCourse(stand.angle, found) if before is None else before.followed_by(stand.angle, found)


def free_shift(model: GearModel, equilibrium: Equilibrium) -> float:
    """Displacement [mm] of the flanks by the free rotation from the search to the equilibrium."""
    return float(equilibrium.motion[0]) * model.base_radius


def _at_a_multiple(model: GearModel, stand: PairRotation) -> PairRotation:
    """The nearest stand at which searches are made."""
    on = model.load.on
    step = 2.0 * RELOCATE * model.pair.pinion.normal_module / model.base_radius
    return stand.turned(on, float(np.round(stand.beyond_nominal[on] / step)) * step - stand.beyond_nominal[on])


def _initially_pressed(
    geometry: ContactGeometry, before: ContactPatch | None, guess: PositionStart | None = None
) -> Bools:
    """Points that are assumed to press at first, (q,) bool: those of the guess, else those in the last position's
    contact patch. Without either, or where it has none of them, those near the contact lines."""
    pressed = None if before is None else before.at(geometry)
    if guess is not None:
        z = geometry.operator.shape @ geometry.z
        pressed = guess.pressed(geometry.point_tooth, z, geometry.across)
    if pressed is not None and pressed.any():
        return pressed
    # on a coarse mesh the contact line may lie between two rows of points: then the nearest ones
    return geometry.window_distance <= max(FIRST_CONTACT, float(geometry.window_distance.min()))
