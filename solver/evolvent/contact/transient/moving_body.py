"""A condensed body with inertia: its modes at the contact functionals, and the static response of the other modes.

With F̂ all forces in the mean axes (fem/mean_axes.py), modes W of frequencies ω and q their amplitudes,

    P u = P R δ + Φ_P q + (Ψ K⁻¹ Ψᵀ − Φ_P Ω⁻² Φ_Pᵀ) f + ... ,    Ψ = P − (P R) m⁻¹ RᵀM ,    Φ_P = Ψ W .

docs/transient_method.md has the equations.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from evolvent.contact.problem.condensed_body import CondensedBody
from evolvent.contact.transient.time_schemes.time_scheme import LinearSystem
from evolvent.fem.mean_axes import MeanAxes
from evolvent.fem.natural_modes import NaturalModes, natural_modes
from evolvent_meshes.arrays import Floats, Ints


@dataclass(frozen=True)
class MovingBody:
    """A condensed body with m modes, r rigid motions of which s are free, and k functionals."""

    condensed: CondensedBody
    """Condensed body without inertia."""
    axes: MeanAxes
    """Mass of the body in mean axes."""
    modes: NaturalModes
    """Lowest natural modes of the body."""
    damping_ratio: float
    """Damping ratio ζ of each mode."""

    @staticmethod
    def of(condensed: CondensedBody, count: int, damping_ratio: float) -> MovingBody:
        """Moving body with its lowest `count` modes, or all where there are fewer. Raises CompileError, CacheError."""
        axes = MeanAxes.of(condensed.assembled)
        modes = natural_modes(condensed.stiffness, axes, condensed.factor.solve, count)
        return MovingBody(condensed, axes, modes, damping_ratio)

    @property
    def free(self) -> Ints:
        """Indices (s,) of the free rigid motions."""
        return self.condensed.assembled.motions.free

    @property
    def count(self) -> int:
        """Number m of modes."""
        return len(self.modes.frequencies)

    @cached_property
    def functionals(self) -> Floats:
        """Functionals Φ_P (k, m) of the mode shapes."""
        return self.condensed.functionals @ self.axes.shape(self.modes.shapes)

    @cached_property
    def system(self) -> LinearSystem:
        """Mass, damping and stiffness of modes and rigid motions, (m + r) coordinates. Prescribed rigid motions act on
        the modes by their acceleration."""
        m, ω = self.count, self.modes.frequencies
        mass = np.eye(m + len(self.axes.rigid_mass))
        mass[m:, m:] = self.axes.rigid_mass
        pushed = self.modes.shapes.T @ (self.axes.coupling - self.axes.carried @ self.axes.rigid_mass[self.free])
        mass[:m, m:], mass[m:, :m] = pushed, pushed.T
        nothing = np.zeros(len(self.axes.rigid_mass))
        damping = np.concatenate([2.0 * self.damping_ratio * ω, nothing])
        return LinearSystem(mass, damping, np.concatenate([ω**2, nothing]))

    @cached_property
    def rest(self) -> Floats:
        """Static compliance C_r (k, k) in mean axes without that of the modes [mm/N]."""
        H, bent = self.condensed.motion_shapes[:, self.free], self._carried_response
        inertial = bent @ H.T
        resting = H @ (self.axes.carried.T @ self._carried) @ H.T
        static = self.condensed.compliance - inertial - inertial.T + resting
        return static - (self.functionals / self.modes.frequencies**2) @ self.functionals.T

    def modal_load(self, load: float, resultant: Floats) -> Floats:
        """Forces (m,) on the modes by loads with a factor. resultant: (s,) of the loads on the free rigid motions."""
        force = load * self.condensed.load - self.axes.carried @ resultant
        return np.asarray(self.modes.shapes.T @ force)

    def load_response(self, load: float, resultant: Floats) -> Floats:
        """Functionals Ψ K⁻¹ of the loads without the response of the modes, (k,) [mm]."""
        H = self.condensed.motion_shapes[:, self.free]
        loaded = load * (self.condensed.load_response - H @ (self._carried.T @ self.condensed.load))
        inertial = self._carried_response @ resultant - H @ (self.axes.carried.T @ (self._carried @ resultant))
        modal = self.functionals @ (self.modal_load(load, resultant) / self.modes.frequencies**2)
        return np.asarray(loaded - inertial - modal)

    def load_compliance(self, load: float, resultant: Floats) -> float:
        """Twice the elastic energy of the loads in the static response without the modes [N·mm]."""
        force = load * self.condensed.load - self.axes.carried @ resultant
        moved = load * self._loaded - self._carried @ resultant
        modal = self.modal_load(load, resultant) / self.modes.frequencies
        return float(force @ moved - modal @ modal)

    def at_rest(self, forces: Floats, load: float, resultant: Floats, motion: Floats) -> Floats:
        """Modes and rigid motions (m + r) in static equilibrium under forces on the functionals (k,) and these loads.

        motion: (r,) rigid motions, not in mean axes but of the held or coupled nodes.
        """
        free = self.condensed.assembled.free
        w = self.condensed.factor.solve((self.condensed.functionals.T @ forces)[free] + load * self.condensed.load)
        mean = motion.copy()
        mean[self.free] += self.axes.carried.T @ w
        answer = self.modal_load(load, resultant) + self.functionals.T @ forces
        return np.concatenate([answer / self.modes.frequencies**2, mean])

    def field(self, load: float, resultant: Floats, forces: Floats, modes: Floats, motion: Floats) -> Floats:
        """Displacement of the nodes (N, d) [mm] under these loads and forces on the functionals (k,), at amplitudes of
        the modes (m,) and rigid motions (r,): static but for the modes."""
        w = self._deformation(load, resultant, forces, modes)
        shapes = self.condensed.assembled.motions.shapes
        return self.axes.shape(w).reshape(shapes.shape[:2]) + shapes @ motion

    def _deformation(self, load: float, resultant: Floats, forces: Floats, modes: Floats) -> Floats:
        """Displacement w (n,) [mm] of the free degrees of freedom in mean axes."""
        condensed = self.condensed
        contact = (condensed.functionals.T @ forces)[condensed.assembled.free]
        carried = self.axes.carried @ (resultant + condensed.motion_shapes[:, self.free].T @ forces)
        answer = self.modal_load(load, resultant) + self.functionals.T @ forces
        behind = modes - answer / self.modes.frequencies**2
        static = condensed.factor.solve(load * condensed.load + contact - carried)
        return np.asarray(static + self.modes.shapes @ behind)

    @cached_property
    def _loaded(self) -> Floats:
        """Displacements K⁻¹ of the loads (n,)."""
        return np.asarray(self.condensed.factor.solve(self.condensed.load))

    @cached_property
    def _carried(self) -> Floats:
        """Displacements K⁻¹ M R m⁻¹ (n, s) by the inertia forces of unit resultants."""
        return np.asarray(self.condensed.factor.solve(self.axes.carried))

    @cached_property
    def _carried_response(self) -> Floats:
        """Functionals P K⁻¹ M R m⁻¹ (k, s) under the inertia forces of unit resultants."""
        return np.asarray(self.condensed.functionals[:, self.condensed.assembled.free] @ self._carried)
