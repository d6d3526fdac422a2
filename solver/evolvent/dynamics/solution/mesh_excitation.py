"""Excitation of condensed gears from Python: unloaded transmission error, and the mesh under a list of torques.

On several ranks all of them call the function, and all get the result.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from mpi4py import MPI

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.line_mesh import LineFigures
from evolvent.dynamics.excitation.loaded_mesh import (
    LoadedMesh,
    certify_torques,
    in_line_contact,
    mesh_of,
    solved_figures,
)
from evolvent.gears.gear_model import GearModel
from evolvent.gears.problem.flank_deviations import FlankChart, FlankCharts
from evolvent.gears.solution.certified_pitch import balanced
from evolvent.gears.solution.solver import check_condensed
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.gears.unloaded_error import RigidFlanks, unloaded_error
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.input_checks import Words, both_gears, is_index, number, numbers, refuse

FEWEST_POSITIONS = 3
"""Least number of positions of a pitch: two do not show the first mesh harmonic."""


@dataclass(frozen=True, eq=False)
class GearExcitation:
    """Excitation of a gear pair by its mesh, at n positions of a pitch under m torques, without friction."""

    pair: GearPair
    """Gear pair."""
    torque_on: Member
    """Gear on which the torques act."""
    moduli: tuple[float, float]
    """Young's moduli of pinion and wheel [MPa]."""
    mesh: MeshExcitation
    """Unloaded transmission error, and the mesh under the torques."""

    @property
    def base_radius(self) -> float:
        """Base radius of the gear with the torque [mm]."""
        return self.mesh.loaded.base_radius

    @property
    def angles(self) -> Floats:
        """Pinion rotations (n,) [rad]; 0: tooth pair 0 touches at the pitch point, in the mid-face section."""
        return self.mesh.loaded.angles

    @property
    def torques(self) -> Floats:
        """Torques (m,), ascending [N·mm]."""
        return self.mesh.loaded.torques

    @property
    def unloaded_error(self) -> Floats:
        """Unloaded transmission error (n,) [mm]: displacement at which the flanks just touch."""
        return self.mesh.unloaded_error

    @property
    def transmission_error(self) -> Floats:
        """Transmission error (n, m) r_b1 φ_1 − r_b2 φ_2 under each torque [mm]."""
        return self.mesh.loaded.errors

    @property
    def tangent_stiffness(self) -> Floats:
        """Tangent mesh stiffness (n, m) of the whole face [N/mm]."""
        return self.mesh.loaded.stiffness

    @property
    def face_load_factor(self) -> Floats:
        """Face load factor K_Hβ (m,) (ISO 6336-1:2006, 7.2.2) under each torque. Raises InputError for gears in the
        plane, or whose contact is resolved."""
        if self._line.is_plane:
            refuse("gears", "gears in space, which have a face load factor", Words("gears in the plane"),
                   "condense them with GearOptions(in_space=True)")
        return self._line.face_load_factor

    @property
    def largest_pressure(self) -> Floats:
        """Largest of Hertz' p_0 (m,) under each torque [MPa], away from edges of tips and from starts of linear
        reliefs. Raises InputError for gears whose contact is resolved."""
        return self._line.largest_pressure_MPa

    @property
    def _line(self) -> LineFigures:
        if self.mesh.loaded.line is None:
            refuse("gears", 'gears of mesh level "line"', Words("gears whose contact is resolved"),
                   "solve_pitch has their pressures and their load over the face")
        return self.mesh.loaded.line

    @property
    def secant_stiffness(self) -> Floats:
        """Secant mesh stiffness (n, m) [N/mm]: mesh force over what the torque adds to the unloaded error."""
        return self.mesh.secant

    def save(self, path: Path | str) -> Path:
        """Writes the curves to a CSV file with the columns of excitation.csv, and returns its path; creates missing
        folders. Raises InputError for another ending, WriteError."""
        from evolvent.dynamics.results.tables import excitation_rows
        from evolvent.results.solution.user_files import save_rows

        return save_rows(path, excitation_rows(self.mesh))

    def plot(self, path: Path | str) -> Path:
        """Draws the curves, the force over the deflection and the peak-to-peak transmission error over the torque to a
        PNG file, and returns its path; creates missing folders. Raises InputError for another ending, WriteError."""
        from evolvent.dynamics.figures.excitation import excitation_figure
        from evolvent.dynamics.results.curves import NO_COMPANION
        from evolvent.dynamics.results.design_load import excitation_facts
        from evolvent.dynamics.results.tables import excitation_rows, harmonic_rows
        from evolvent.results.solution.user_files import save_picture

        title = f"Gear pair {self.pair.pinion.z}/{self.pair.wheel.z}"
        facts = excitation_facts(title, "as condensed", self.mesh, NO_COMPANION, self.pair)
        return save_picture(path, excitation_figure, facts, excitation_rows(self.mesh), harmonic_rows(self.mesh))


def mesh_excitation(
    gears: GearModel, torques: Sequence[float], positions: int = 20, flanks: FlankCharts = (None, None),
    comm: MPI.Comm = MPI.COMM_WORLD,
) -> GearExcitation:
    """Excitation of condensed gears, as of `evolvent excitation`, without error bars. Where energy does not balance
    over the pitch under one of the torques, all are solved again on deflected flanks.

    torques: ascending [N·mm], over the whole face, on the gear that holds the load of the problem. Meshes are made for
        the problem's own torque; `GearProblem(mesh_torques=(lightest, heaviest))` makes them for a range.
    positions: steps of the pitch 2π/z_1, three at least.
    flanks: charts of pinion and wheel, those of the problem that was condensed.

    Raises InputError, NotConverged, SearchError, BalanceError, and NoForceSurface where deflections do not grow with
    the torque; in line contact EdgeContact where edges of tips bear under one of the torques, and TooWide.
    """
    check_condensed(gears)
    _check(gears, torques, positions, flanks)
    angles = np.array(uniform_pitch(gears.pair.pinion.z, int(positions)).angles)

    def solved(deflected: bool) -> LoadedMesh:
        found = solved_figures(replace(gears, deflected=deflected), torques, angles, comm)
        certify_torques(found, torques)
        mesh = mesh_of(found, torques, gears.base_radius, angles, deflected)
        return in_line_contact(mesh, torques[-1])[0]

    loaded = balanced(solved, gears.deflected)
    unloaded = unloaded_error(RigidFlanks(gears.pair, flanks), angles, gears.load.on)
    pinion, wheel = (body.material.youngs_modulus for body in gears.bodies)
    return GearExcitation(gears.pair, gears.load.on, (pinion, wheel), MeshExcitation(unloaded, loaded))


def _check(gears: GearModel, torques: Sequence[float], positions: int, flanks: FlankCharts) -> None:
    """Raises InputError for torques that do not ascend from above 0, too few positions, and charts that are not those
    of the condensed gears."""
    numbers("torques", torques)
    for torque in torques:
        number("torques", torque, "numbers above 0, in N·mm", "170e3 are 170 N·m", lambda T: T > 0.0)
    if len(torques) == 0 or not (np.diff(np.asarray(torques, dtype=float)) > 0.0).all():
        refuse("torques", "one or several, ascending", list(torques), "write sorted(torques)")
    if not (is_index(positions) and positions >= FEWEST_POSITIONS):
        refuse("positions", f"a whole number from {FEWEST_POSITIONS} on", positions, "20 are usual, 40 show each step")
    both_gears("flanks", flanks, FlankChart, optional=True)
    for member, body, chart in zip(Member, gears.bodies, flanks, strict=True):
        if (body.worn is None) != (chart is None):
            found = "none for a gear that has one" if chart is None else "one for a gear as designed"
            refuse("flanks", "the charts that the gears were condensed with", Words(f"{member.label}: {found}"),
                   "write flanks=problem.flanks")
