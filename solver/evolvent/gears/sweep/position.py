"""Equilibrium of a gear pair at one position, for one or several friction coefficients.

The search, the compliance and the frictionless solution are shared by all coefficients; each keeps its own memory.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.newton.equilibrium import (
    CondensedSystem,
    Equilibrium,
    InitialGuess,
    frictional,
    frictionless,
    normal_part,
)
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.newton.tangent_stiffness import tangent_stiffness
from evolvent.fem.parallel.cores import Threads
from evolvent.gears.contact.contact_points import ContactPoints, contact_points
from evolvent.gears.contact.overlap_check import NEARLY, Unwatched, overlap_outside, unwatched
from evolvent.gears.contact.pair_contact import GearContact, gear_contact, relative_velocity
from evolvent.gears.gear_model import GearModel
from evolvent.gears.kinematics import Stand
from evolvent.gears.sweep.friction_history import Footprint, Past, known_heading, slipped
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.member import Member

RELOCATE = 1.7e-4
"""A free rotation that moves the flanks further [modules] is made exact and searched again; the gap is linear in a
smaller one but for its square over the curvature radius, 3e-8 modules. Searches are made at rotations that are whole
multiples of twice this, at the nearest one to the solution: so that results do not depend on where a search starts."""
NEAREST = 1.001  # of half a multiple: at its very end two searches could send each other back and forth
STALE = NEARLY
"""So far [modules] may wear let the flanks move until a position is searched again: He's pair worn by 6 µm in 20 blocks
has then the depths of one that is always searched within 9e-4 (7e-4 at 2e-3) of its volume, and transmission errors
within 3 nm of 5 µm; 24 searches instead of 400."""
FIRST_CONTACT = 0.25
"""Share of the window that is taken for pressed at first; Newton's method needs fewer steps from too few points."""
ROUNDS = 8


@dataclass(frozen=True)
class PositionResult:
    """A converged position at one friction coefficient.

    stand: with the free rotation. torques: (pinion, wheel) moments of the contact forces about the axes [N·mm; per mm
    of width in 2D]. contact: at the quadrature points. Averages at the n nodes of the pinion's flanks within the
    window, for pictures: tooth, node (n,), weights m (n,) [mm²; mm] and traction (n, d) λ, τ [MPa], Σ m t the whole
    force. iterations: Newton's, all stages. residual: relative force residual. stiffness: tangent of the frictionless
    mesh along the line of action [N/mm; per mm of width in 2D], see tangent_stiffness.py. pinion_rows, wheel_rows:
    (m, 2) rows of the gears' chains that carry load, and pinion_forces, wheel_forces (m, d) what it is, in the gears'
    frames [N; per mm of width in 2D].
    """

    stand: Stand
    friction: float
    torques: tuple[float, float]
    contact: ContactPoints
    tooth: Ints
    node: Ints
    weights: Floats
    traction: Floats
    iterations: int
    residual: float
    stiffness: float
    pinion_rows: Ints
    wheel_rows: Ints
    pinion_forces: Floats
    wheel_forces: Floats
    seconds: float = 0.0

    @property
    def pressure(self) -> Floats:
        """Averaged λ (n,) [MPa]."""
        return self.traction[:, 0]

    @property
    def transmission_error(self) -> float:
        """r_b1 φ_1 − r_b2 φ_2 [mm]."""
        pinion, wheel = self.stand.pair.gears
        return float(pinion.base_radius * self.stand.extra[0] + wheel.base_radius * self.stand.extra[1])

    @property
    def friction_loss(self) -> float:
        """Power lost to friction per rad/s of pinion speed [N·mm; per mm of width in 2D]."""
        c = self.contact
        k = c.traction.shape[1]
        return float(np.sum(c.weights[:, None] * c.traction[:, 1:] * c.rate[:, 1:k]))

    @property
    def stored_power(self) -> float:
        """Input − output − friction power per rad/s of pinion speed [N·mm; per mm of width in 2D]: what the deflected
        teeth take in, or give back where it is negative. Over a whole pitch that is nothing."""
        return self.torques[0] - self.torques[1] / self.stand.pair.ratio - self.friction_loss


@dataclass(frozen=True)
class SharedPosition:
    """What all friction coefficients of a position share. smooth: the frictionless state. unwatched: where flanks might
    touch that the window does not look at. stiffness: of the frictionless state, as in PositionResult."""

    contact: GearContact
    system: CondensedSystem
    smooth: Equilibrium
    unwatched: tuple[Unwatched, ...]
    stiffness: float

    @property
    def footprint(self) -> Footprint:
        """Where the flanks are pressed without friction."""
        return Footprint.of(self.contact, self.smooth.traction[:, 0])


@dataclass(frozen=True)
class SearchedAt:
    """Where a position was searched: the pinion's angle and the rotations [rad] beyond the nominal ones, the half-width
    of the window [mm]."""

    angle: float
    extra: tuple[float, float]
    half_width: float


@dataclass(frozen=True)
class Solved:
    """The equilibrium of a position at one friction coefficient."""

    friction: float
    state: Equilibrium


def shared_position(
    model: GearModel, angle: float, extra: tuple[float, float], frictions: Sequence[float], before: Footprint | None,
    threads: Threads = nullcontext,
) -> SharedPosition:  # fmt: skip
    """Search, compliance and frictionless equilibrium; the free rotation is made exact, and the window wide enough.

    extra: predicted rotations beyond the nominal ones. frictions: the coefficients that are to come: without one that
    is not 0 only normal components are condensed. before: the footprint of the last position. The frictionless state is
    exact also where it is but a start: the search is made where it leaves the gears, which must not depend on which
    other coefficients there are. Raises NotConverged, SearchError.
    """
    normal_only = not any(map(model.has_friction_terms, frictions))
    stand, half_width = _at_a_multiple(model, Stand(model.pair, angle, extra)), model.half_width
    for _ in range(ROUNDS):
        contact = gear_contact(model.bodies, stand, list(model.teeth), half_width)
        if not contact.teeth:
            raise NotConverged(
                f"pinion at {np.degrees(angle):.3f}°: wanted flanks within reach of each other, found none; the load "
                "may bend the teeth further than the search looks: lower the torque"
            )
        system = contact.system(model.load.on, model.load.torque, normal_only, threads)
        normal = normal_part(system)
        smooth = frictionless(normal, _foreseen(contact, before))
        shift = free_shift(model, smooth)
        if contact.too_deep:
            raise NotConverged(
                f"pinion at {np.degrees(angle):.3f}°: wanted teeth that give way by less than half a module, found "
                "more, too much for small strain: lower the torque"
            )
        if contact.reaches_rim(smooth.traction[:, 0] > 0.0):
            half_width *= 1.5
        elif abs(shift) <= NEAREST * RELOCATE * model.pair.pinion.normal_module:
            places = unwatched(contact, model.teeth)
            if overlap_outside(contact, places, smooth.force, free_rotation(model, smooth)) == 0.0:
                return SharedPosition(contact, system, smooth, places, tangent_stiffness(normal, smooth))
            half_width = np.inf
        stand = _at_a_multiple(model, stand.turned(model.load.on, float(smooth.motion[0])))
    raise NotConverged(
        f"pinion at {np.degrees(angle):.3f}°: the free rotation moves {1e3 * shift:.2f} µm after {ROUNDS} searches"
    )


def searched_at(model: GearModel, place: SearchedAt, frictions: Sequence[float]) -> SharedPosition:
    """A position as a search at this very place leaves it. Raises NotConverged, SearchError."""
    stand = Stand(model.pair, place.angle, place.extra)
    contact = gear_contact(model.bodies, stand, list(model.teeth), place.half_width)
    normal_only = not any(map(model.has_friction_terms, frictions))
    system = contact.system(model.load.on, model.load.torque, normal_only)
    normal = normal_part(system)
    smooth = frictionless(normal, _foreseen(contact, None))
    return SharedPosition(contact, system, smooth, unwatched(contact, model.teeth), tangent_stiffness(normal, smooth))


def _at_a_multiple(model: GearModel, stand: Stand) -> Stand:
    """The nearest stand at which searches are made."""
    on = model.load.on
    step = 2.0 * RELOCATE * model.pair.pinion.normal_module / model.bodies[on].gear.base_radius
    return stand.turned(on, float(np.round(stand.extra[on] / step)) * step - stand.extra[on])


def worn_on(model: GearModel, shared: SharedPosition, pressed: np.ndarray | None = None) -> SharedPosition | None:
    """The same position after the model's flanks have worn on: search and compliance stay, the gap and the frictionless
    state are new. pressed: (q,) bool, points to start from, by default those that were. None where the gears have moved
    so far, or the contact so near to the window's rim, that the position has to be searched again, or where no solution
    is found."""
    contact = shared.contact.on(model.bodies)
    system = replace(shared.system, operator=contact.operator)
    normal = normal_part(system)
    smooth = _smooth(normal, [pressed, shared.smooth.traction[:, 0] > 0.0])
    if smooth is None:
        return None
    shift = free_shift(model, smooth)
    good = abs(shift) <= STALE * model.pair.pinion.normal_module
    good = good and not contact.reaches_rim(smooth.traction[:, 0] > 0.0)
    rotation = free_rotation(model, smooth)
    good = good and overlap_outside(contact, shared.unwatched, smooth.force, rotation) == 0.0
    if not good:
        return None
    return SharedPosition(contact, system, smooth, shared.unwatched, tangent_stiffness(normal, smooth))


def _smooth(system: CondensedSystem, starts: Sequence[np.ndarray | None]) -> Equilibrium | None:
    """From the first of the starts, (q,) bool or none, that leads to a solution; None where none does."""
    for start in (start for start in starts if start is not None):
        try:
            return frictionless(system, start if start.any() else None)
        except NotConverged:
            continue
    return None


def free_rotation(model: GearModel, found: Equilibrium) -> tuple[float, float]:
    """By how much the solution turns pinion and wheel [rad] from where they were searched."""
    free = float(found.motion[0])
    return (free, 0.0) if model.load.on == Member.PINION else (0.0, free)


def free_shift(model: GearModel, found: Equilibrium) -> float:
    """How far [mm] that moves the flanks."""
    return float(found.motion[0]) * model.bodies[model.load.on].gear.base_radius


def _foreseen(contact: GearContact, before: Footprint | None) -> np.ndarray:
    """(q,) bool: the points that are taken for pressed at first: where they were at the last position; without one, or
    where the contact has moved on altogether, those by the contact lines."""
    pressed = None if before is None else before.at(contact)
    if pressed is not None and pressed.any():
        return pressed
    # on a coarse mesh the contact line may lie between two rows of points: then the nearest ones
    return contact.distance <= max(FIRST_CONTACT, float(contact.distance.min()))


def solve_position(
    model: GearModel, shared: SharedPosition, friction: float, before: Past | None, span: float,
    solved: Sequence[Solved] = (),
) -> tuple[PositionResult, Solved]:  # fmt: skip
    """Equilibrium with friction, from the past (None without friction). span: Δφ [rad] since then; solved: states at
    other coefficients, the last ones near by, to start from.

    Raises NotConverged.
    """
    contact, smooth = shared.contact, shared.smooth
    found = smooth
    if before is not None:
        near = foretold(friction, [Solved(0.0, smooth), *solved])
        found = rubbing(model, contact, shared.system, friction, smooth, before, span, near)
    result = position_result(model, contact, found, friction, shared.stiffness, smooth.iterations)
    return result, Solved(friction, found)


def rubbing(
    model: GearModel, contact: GearContact, system: CondensedSystem, friction: float, smooth: Equilibrium,
    before: Past, span: float, near: InitialGuess | None = None,
) -> Equilibrium:  # fmt: skip
    """Equilibrium with friction, from the past; smooth: the one without; near: a guess of it. Raises NotConverged."""
    ξ_before = contact.ξ - model.pair.pinion.base_radius * span
    rate = relative_velocity(contact)
    slip = slipped(model, contact, before, rate, ξ_before, span)
    return frictional(system, friction, slip, known_heading(contact, rate), smooth, near)


def foretold(friction: float, solved: Sequence[Solved]) -> InitialGuess | None:
    """Forces and motions continued in a straight line from the last two coefficients, in which sliding friction is
    nearly linear; None where there is but one, or both are the same."""
    if len(solved) < 2 or solved[-1].friction == solved[-2].friction:
        return None
    older, last = solved[-2:]
    share = (friction - last.friction) / (last.friction - older.friction)
    earlier = np.zeros_like(last.state.force)
    earlier[:, : older.state.force.shape[1]] = older.state.force
    force = last.state.force + share * (last.state.force - earlier)
    return InitialGuess(force, last.state.motion + share * (last.state.motion - older.state.motion))


def position_result(
    model: GearModel, contact: GearContact, found: Equilibrium, friction: float, stiffness: float,
    extra_iterations: int,
) -> PositionResult:  # fmt: skip
    """Torques, tractions and flags of a converged state."""
    k = found.force.shape[1]
    torques = [float(np.sum(spin[:, :k] * found.force)) for spin in contact.spins]
    weights, traction = contact.operator.averaged(found.traction)
    stand = contact.stand.turned(model.load.on, float(found.motion[0]))
    (pinion_rows, pinion_forces), (wheel_rows, wheel_forces) = (_carried(contact, gear, found) for gear in Member)
    return PositionResult(
        stand=stand,
        friction=friction,
        torques=(torques[0], torques[1]),
        contact=contact_points(contact, found.traction, friction, stand.extra),
        tooth=contact.tooth,
        node=contact.node,
        weights=weights,
        traction=traction,
        iterations=found.iterations + (extra_iterations if model.has_friction_terms(friction) else 0),
        residual=found.residual / float(np.sum(found.force[:, 0])),
        stiffness=stiffness,
        pinion_rows=pinion_rows,
        wheel_rows=wheel_rows,
        pinion_forces=pinion_forces,
        wheel_forces=wheel_forces,
    )


def _carried(contact: GearContact, gear: Member, found: Equilibrium) -> tuple[Ints, Floats]:
    """Rows (m, 2) of a gear's chain that carry load, and the forces (m, d) on them."""
    rows, forces = contact.rows(gear)[0], contact.pushed(gear, found.force)
    loaded = forces.any(axis=1)
    return rows[loaded], forces[loaded]
