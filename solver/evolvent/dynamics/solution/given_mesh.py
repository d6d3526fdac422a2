"""Vibration over the speed of an oscillator whose mesh stiffness and unloaded error are given, from Python.

    m s̈ + c (ṡ − ė) + k(φ) (s − e(φ)) = F_0

while the flanks touch, s > e; with a backlash the back flanks, too (`mesh_law`). Stiffness and error are splines
through their values over a mesh.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from evolvent.dynamics.excitation.force_surface import paper_law
from evolvent.dynamics.mesh_oscillator import GivenMesh, sweep_at
from evolvent.dynamics.oscillator.mesh_law import MeshLaw, linear_side, no_side
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel
from evolvent.dynamics.pair_model import check_damping
from evolvent.dynamics.solution.swept_vibration import SweptVibration, checked_speeds, swept_tables
from evolvent_meshes.arrays import Floats
from evolvent_meshes.input_checks import array, is_index, number, refuse

FEWEST = 3
"""Least number of values over a mesh: two do not show its first harmonic."""


@dataclass(frozen=True, eq=False)
class GivenMeshVibration(SweptVibration):
    """Vibration over the speed on a given mesh."""

    mass: float
    """Mass m [t]."""
    mean_stiffness: float
    """Mean stiffness of the mesh [N/mm]."""

    def plot(self, path: Path | str) -> Path:
        """Draws amplitude, dynamic factor and time out of contact over the speed to a PNG file, and returns its path;
        creates missing folders. Raises InputError for another ending, WriteError."""
        from evolvent.dynamics.figures.response import given_mesh_figure
        from evolvent.results.solution.user_files import save_picture

        words = (
            f"Natural speed {self.natural_speed:.0f} r/min, of {1e3 * self.mass:.4g} kg on a given mean stiffness of "
            f"{1e-3 * self.mean_stiffness:.4g} N/µm."
        )
        return save_picture(path, given_mesh_figure, self.natural_speed, words, self.rows, self.branch)


def given_mesh_vibration(
    stiffness: Sequence[float] | Floats, error: Sequence[float] | Floats, speeds: Sequence[float] | Floats, *,
    mass: float, load: float, teeth: int, damping_ratio: float, backlash: float | None = None,
    damping_in_separation: bool = False,
) -> GivenMeshVibration:
    """Vibration of an oscillator that runs up and down through some speeds on a mesh of your own.

    stiffness: k (n,) of the whole face along the line of action at equidistant phases of a mesh, the end left out
        [N/mm].
    error: e (n,) unloaded transmission error at the same phases [mm].
    speeds: of the pinion, two at least, ascending [r/min].
    mass: equivalent mass I_1 I_2/(I_1 r_b2² + I_2 r_b1²) [t]; load: static mesh force F_0 [N].
    teeth: of the pinion, from which the mesh frequency follows.
    damping_ratio: of the mesh, over the critical damping 2√(k m) at the mean stiffness; from 0.001 to 1.
    backlash: along the line of action, from flank to flank [mm]; the back flanks have the stiffness of the loaded ones
        at the same phase. None: there are none.
    damping_in_separation: whether the damping acts on separated flanks, too.

    Raises InputError, NoSteadyState.
    """
    k, e = _over_a_mesh(stiffness, error)
    for name, value, unit in (("mass", mass, "t"), ("load", load, "N")):
        number(name, value, f"a number above 0, in {unit}", "give a positive one", lambda given: given > 0.0)
    check_damping(damping_ratio, damping_in_separation)
    if backlash is not None:
        number("backlash", backlash, "a number from 0 on, in mm, or None", "leave it out for none", lambda j: j >= 0.0)
    if not (is_index(teeth) and teeth >= 1):
        refuse("teeth", "a whole number from 1 on", teeth, "give the number of teeth of the pinion")
    values, side, mean = checked_speeds(speeds), linear_side(k, e), float(np.mean(k))
    law = MeshLaw(side, no_side()) if backlash is None else paper_law(side, backlash)
    damping = damping_ratio * 2.0 * np.sqrt(mean * mass)
    model = TorsionalModel(mass, load, law, damping, damping_in_separation, teeth=int(teeth))
    pair = GivenMesh(model, int(teeth), mean)
    own = swept_tables(pair, sweep_at(pair, values), None)
    return GivenMeshVibration(own.rows, own.branch, own.natural_speed, own.jumps_up, own.jumps_down, mass, mean)


def _over_a_mesh(stiffness: Any, error: Any) -> tuple[Floats, Floats]:
    """Stiffness and error as arrays. Raises InputError unless they have the same length, three at least, and the
    stiffness is above 0."""
    count = max(np.size(stiffness), FEWEST)
    k = array("stiffness", stiffness, ((count,),), f"give its values at {FEWEST} phases of a mesh or more")
    e = array("error", error, ((count,),), "give it at the phases of the stiffness; np.zeros(n) for none")
    if not (k > 0.0).all():
        refuse("stiffness", "numbers above 0, in N/mm", float(k.min()), "teeth in contact have a stiffness")
    return k, e
