"""The force of a mesh over its deflection and the rotation, from a pitch under several torques.

At each position the force over x = s − e goes through (0, 0) and each torque's point, with the tangent stiffness that
was computed there: a cubic Hermite interpolant. All positions are read off at common depths, those of the loads in the
mean and halfway between. Between the positions the force is a periodic spline, see `mesh_law.force_side`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import brentq

from evolvent.dynamics.excitation.loaded_mesh import LoadedMesh
from evolvent.dynamics.oscillator.mesh_law import MeshLaw, MeshSide, behind, force_side, linear_side, mirrored
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import ResultError
from evolvent_meshes.gears.pair import GearPair

SAME_LOAD = 1e-9
"""Relative difference below which two loads are the same."""
DEPTH_ACCURACY = 1e-15
"""Accuracy of the deflection under a load between those that were solved [mm]."""


class NoForceSurface(ResultError):
    """Error for deflections that do not grow with the torque."""


@dataclass(frozen=True, eq=False)
class MeshExcitation:
    """Excitation by a mesh: unloaded transmission error, and the mesh under several torques."""

    unloaded_error: Floats
    """(n,) unloaded transmission error e [mm] at equidistant phases of a pitch."""
    loaded: LoadedMesh
    """Mesh at the same positions under (m,) torques."""

    def __post_init__(self) -> None:
        """Raises NoForceSurface where deflections do not grow with the torque."""
        depths = np.column_stack([np.zeros(len(self.unloaded_error)), self.depths])
        if not (np.diff(depths) > 0.0).all():
            i, j = np.argwhere(~(np.diff(depths) > 0.0))[0]
            raise NoForceSurface(
                f"deflection at {np.degrees(self.loaded.angles[i]):.3f}° under {self.loaded.forces[j]:.4g} N: wanted "
                f"more than under the load before, found {1e3 * (depths[i, j + 1] - depths[i, j]):.2e} µm more; refine "
                "the mesh (mesh.level), or leave out the lightest loads"
            )

    @property
    def depths(self) -> Floats:
        """(n, m) deflection x = s − e [mm]."""
        return self.loaded.errors - self.unloaded_error[:, None]

    @property
    def secant(self) -> Floats:
        """(n, m) secant stiffness F/x [N/mm]."""
        return self.loaded.forces / self.depths

    def in_series(self, stiffness: float) -> MeshExcitation:
        """The mesh behind a spring [N/mm] along the line of action, without inertia."""
        errors = self.loaded.errors + self.loaded.forces / stiffness
        slope = 1.0 / (1.0 / self.loaded.stiffness + 1.0 / stiffness)
        return replace(self, loaded=replace(self.loaded, errors=errors, stiffness=slope))

    def force_surface(self) -> MeshSide:
        """F(x, φ) of the loaded flanks, as computed."""
        loads = np.concatenate([[0.0], self.depths[:, :-1].mean(axis=0), [self.depths.max()]])
        depths = np.sort(np.concatenate([loads, 0.5 * (loads[1:] + loads[:-1])]))
        force = np.array([self._over_depth(i, depths) for i in range(len(self.unloaded_error))])
        return force_side(depths, force, self.unloaded_error, last_slope=self.loaded.stiffness[:, -1])

    def under(self, load: float) -> tuple[Floats, Floats]:
        """Deflection x (n,) [mm] and tangent stiffness (n,) [N/mm] under a load [N]: as solved, or between two solved
        loads as the force over x has them at each position. Raises ValueError beyond the heaviest one."""
        forces = self.loaded.forces
        near = int(np.argmin(np.abs(forces - load)))
        if abs(forces[near] - load) <= SAME_LOAD * load:
            return self.depths[:, near], self.loaded.stiffness[:, near]
        if not 0.0 < load < forces[-1]:
            raise ValueError(f"load of a mesh: wanted above 0 up to the heaviest, {forces[-1]:.6g} N, found {load:.6g}")
        j, (x, slope) = int(np.searchsorted(forces, load)), np.empty((2, len(self.unloaded_error)))
        for i, depths in enumerate(self.depths):
            curve, ends = self._force(i), np.append(0.0, depths)[j : j + 2]
            x[i] = brentq(lambda depth, curve=curve: curve(depth) - load, *ends, xtol=DEPTH_ACCURACY)
            slope[i] = curve(x[i], 1)
        return x, slope

    def stiffness_side(self, load: float, secant: bool = False) -> MeshSide:
        """Mesh force k(φ) x with the tangent or the secant stiffness under a load [N] (He et al. 2022, Eq. 12). Raises
        ValueError as `under`."""
        x, tangent = self.under(load)
        return linear_side(load / x if secant else tangent, self.unloaded_error)

    def _force(self, i: int) -> CubicHermiteSpline:
        """F [N] over x [mm] at position i, up to the heaviest torque."""
        x, force, slope = self.depths[i], self.loaded.forces, self.loaded.stiffness[i]
        first = force[0] / x[0]
        return CubicHermiteSpline(np.append(0.0, x), np.append(0.0, force), np.append(2.0 * first - slope[0], slope))

    def _over_depth(self, i: int, depths: Floats) -> Floats:
        """F (k,) [N] at position i, at depths (k,); linear beyond the heaviest torque."""
        heaviest, slope = self.depths[i, -1], self.loaded.stiffness[i, -1]
        beyond = np.maximum(depths - heaviest, 0.0)
        return np.asarray(self._force(i)(np.minimum(depths, heaviest)) + slope * beyond)


def mirrored_law(side: MeshSide, pair: GearPair, backlash: float, begin: float = 0.0) -> MeshLaw:
    """Back flanks alike the loaded ones, their modifications included: at rotation φ of the pinion they stand as those
    do, seen in a mirror, at 2ψ − φ, with ψ the half angle of its tooth on the working pitch circle. backlash: [mm]
    along the line of action; begin: phase of the pitch at which that of `side` is 0."""
    meeting = 2.0 * pair.pinion.half_angle(pair.working_pitch_diameters[0]) * pair.pinion.z / (2.0 * np.pi)
    return MeshLaw(side, mirrored(side, meeting - 2.0 * begin, backlash))


def paper_law(side: MeshSide, backlash: float) -> MeshLaw:
    """Mesh force of both sides of the teeth, the same at the same phase (He et al. 2022, Eq. 6). backlash: [mm] along
    the line of action, from flank to flank."""
    return MeshLaw(side, behind(side, backlash))
