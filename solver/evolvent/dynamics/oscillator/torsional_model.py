"""The torsional vibration of a gear pair as one oscillator along the line of action.

    m_e s̈ + c (ṡ − ė) + c_g ṡ + F(s − e, φ) = F_0 ,    s = r_b1 θ_1 − r_b2 θ_2 ,   m_e = I_1 I_2/(I_1 r_b2² + I_2 r_b1²)

Kahraman and Singh, J. Sound Vib. 142 (1990) 49-75; He et al., Machines 2022, 10, 69, Eqs 4-13, who write Δx for s − e.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from evolvent.dynamics.oscillator.equation import SIZE, Oscillator
from evolvent.dynamics.oscillator.mesh_law import MeshLaw
from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.oscillator.stepping import STEP, advance
from evolvent_meshes.arrays import Bools, Floats, Ints

Derivatives = Floats
"""(2, 3) derivatives of s [mm] and v [mm/s] after a mesh period, by s and v before it and by ln T."""
BEYOND_MEASURE = 100.0
"""Largest mesh deflection of a gear pair, over the static one and the swing of e. A motion beyond it goes on growing,
as a mesh whose stiffness varies feeds more work in than a weak damper takes out."""


@dataclass(frozen=True, eq=False)
class TorsionalModel:
    """A gear pair's inertia, damping and load on the force of its mesh."""

    mass: float
    """Equivalent mass m_e [t]."""
    load: float
    """Static load F_0, the torque over the base radius [N]."""
    law: MeshLaw
    """Mesh force F(x, φ) of both sides of the teeth."""
    teeth: int | None = field(default=None, kw_only=True)
    """Number of teeth of the pinion, from which messages state its speed; None: they state the mesh period."""
    damping: float = 0.0
    """Damping c of the mesh [N·s/mm]."""
    damping_in_separation: bool = False
    """Whether c acts in free flight, too, as it does in He et al. (Eq. 15); then with ė of the loaded flanks wherever
    flanks touch."""
    ground_damping: float = 0.0
    """Damping c_g of the shafts against the ground [N·s/mm]."""
    bore_offset: float = 0.0
    """Lead of the bores over s under the static load [mm], on elastic bodies (`dynamics.one_degree`)."""
    bore_compliance: float = 0.0
    """Further lead of the bores over s per force by which the mesh force is below the load [mm/N]."""

    def between_bores(self, displacement: Floats, force: Floats) -> Floats:
        """The displacement between the bores, the transmission error (k,) [mm], at displacements s and mesh forces
        (k,); s itself where bodies are rigid."""
        return displacement + self.bore_offset + self.bore_compliance * (self.load - force)

    def place(self, period: float) -> str:
        """A mesh period [s] as messages name it: by the speed of the pinion where that is known."""
        speed = None if self.teeth is None else MeshSpeed.of_period(period, self.teeth)
        return f"a mesh period of {period:.6g} s" if speed is None else f"{speed.rpm:.5g} r/min"

    @cached_property
    def oscillator(self) -> Oscillator:
        """Parameters of the equation of motion for compiled code."""
        return Oscillator(
            float(self.mass), float(self.damping), bool(self.damping_in_separation), float(self.ground_damping),
            float(self.load), self.law.front, self.law.back,
        )

    @cached_property
    def fastest(self) -> float:
        """Angular frequency [rad/s] on the stiffest mesh, from which time steps are chosen."""
        return float(np.sqrt(self.law.stiffest / self.mass))

    @cached_property
    def reach(self) -> float:
        """Largest deflection of the mesh [mm] that is still a motion of a gear pair (`BEYOND_MEASURE`)."""
        swing = max(float(np.ptp(side.offset[:, 0])) for side in (self.law.front, self.law.back))
        return BEYOND_MEASURE * (abs(self.load) / self.law.stiffest + swing)

    def escaped(self, state: Floats) -> bool:
        """Whether a state (2,) at phase 0 is beyond `reach`, or faster than an oscillation of that size, or not a
        number."""
        s, v = state
        depth = max(side.sign * s - side.offset[0, 0] for side in (self.law.front, self.law.back))
        return not (depth <= self.reach and abs(v) <= self.reach * self.fastest)

    @cached_property
    def intervals(self) -> tuple[Floats, Ints]:
        """Phases (k + 1,) between which the force is smooth in time, and the intervals of both sides (k, 2)."""
        return self.law.stops()


@dataclass(frozen=True, eq=False)
class History:
    """Motion over a mesh period, at phases (k + 1,)."""

    phases: Floats
    """(k + 1,) phases [mesh periods]."""
    displacement: Floats
    """(k + 1,) displacement s [mm]."""
    velocity: Floats
    """(k + 1,) velocity ṡ [mm/s]."""
    side: Ints
    """(k + 1,): 1 where the loaded flanks touch, −1 where the back flanks do, 0 where neither."""
    force: Floats
    """(k + 1,) mesh force with damping [N]; below 0 where the back flanks press, or the damper pulls at parting
    flanks."""
    error: Floats
    """(k + 1,) unloaded transmission error e of the loaded flanks [mm]."""
    transmission_error: Floats
    """(k + 1,) displacement between the bores [mm]: s itself where bodies are rigid."""
    separated_share: float
    """Share of the period out of contact."""
    back_contact_share: float
    """Share of the period on the back flanks."""
    smallest_force: float
    """Smallest mesh force [N] of these phases and of both sides of each instant at which contact begins or ends, where
    the damping force jumps."""
    largest_force: float
    """Largest mesh force [N] of these phases and of both sides of each instant at which contact begins or ends."""

    @property
    def separated(self) -> Bools:
        """(k + 1,) whether no side touches."""
        return self.side == 0


def period_map(model: TorsionalModel, period: float, state: Floats) -> tuple[Floats, Derivatives]:
    """The state (2,) [mm, mm/s] after a mesh period of so many seconds, and its derivatives."""
    y = _with_derivatives(state)
    stops, cells = model.intervals
    advance(model.oscillator, stops, cells, period, _longest(model, period), y, np.empty((0, 5)))
    return y[:2], np.stack([y[2:5], y[5:8]])


def history(model: TorsionalModel, period: float, state: Floats, phases: Floats | tuple[float, ...] = ()) -> History:
    """Motion over the mesh period after a state (2,) at phase 0. phases: further ones at which the motion is wanted,
    beside those at which the force is not smooth."""
    y, (stops, cells) = _with_derivatives(state), model.law.stops(phases)
    path = np.empty((len(stops), 5))
    separated, back, low, high = advance(model.oscillator, stops, cells, period, _longest(model, period), y, path)
    s, v, side, force, error = path.T
    smallest, largest = min(low, float(force.min())), max(high, float(force.max()))
    bores = model.between_bores(s, force)
    return History(stops, s, v, side.astype(np.int64), force, error, bores, separated, back, smallest, largest)


def _with_derivatives(state: Floats) -> Floats:
    """Integration state (8,) at phase 0, with the derivatives of a state (2,)."""
    y = np.zeros(SIZE)
    y[:2], y[2], y[6] = state, 1.0, 1.0
    return y


def _longest(model: TorsionalModel, period: float) -> float:
    """Longest time step [mesh periods]."""
    return STEP / (model.fastest * period)
