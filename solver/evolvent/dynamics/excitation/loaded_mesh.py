"""The mesh under several torques: transmission error and tangent stiffness over the pitch, without friction.

Gears are condensed once; each torque is solved from where the last one, and the last position, have led.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from mpi4py import MPI

from evolvent.fem.parallel.ranks import together
from evolvent.gears.gear_load import GearLoad
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.contact_patch import ContactPatch
from evolvent.gears.sweep.position_search import SharedPosition, shared_position
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True, eq=False)
class LoadedMesh:
    """A pitch under several torques."""

    angles: Floats
    """(n,) pinion rotations [rad]."""
    forces: Floats
    """(m,) along the line of action, in the transverse section: torque over base radius [N], ascending."""
    errors: Floats
    """(n, m) transmission error r_b1 φ_1 − r_b2 φ_2 [mm]."""
    stiffness: Floats
    """(n, m) tangent stiffness dF/ds [N/mm], of the whole face."""


def loaded_mesh(
    gears: Sequence[GearModel], torques: Sequence[float], angles: Floats, comm: MPI.Comm = MPI.COMM_WORLD,
    solved: Callable[[], None] = lambda: None,
) -> LoadedMesh:  # fmt: skip
    """Solves all positions under all torques; the ranks divide the positions.

    gears: as condensed for each torque.
    torques: (m,) ascending, on the gear that holds the load [N·mm].
    solved: called after each position under a torque that this rank has solved.

    Raises NotConverged, SearchError.
    """
    models = [
        replace(model, load=GearLoad(torque / model.width_factor, model.load.on))
        for model, torque in zip(gears, torques, strict=True)
    ]
    ends = [len(angles) * rank // comm.size for rank in range(comm.size + 1)]
    own = angles[ends[comm.rank] : ends[comm.rank + 1]]
    parts = comm.allgather(together(comm, lambda: _solved(models, own, solved)))
    both = np.concatenate(parts)
    radius = models[0].pair.gears[models[0].load.on].base_radius
    return LoadedMesh(angles, np.asarray(torques) / radius, both[..., 0], both[..., 1])


def _solved(models: Sequence[GearModel], angles: Floats, solved: Callable[[], None]) -> Floats:
    """Transmission error [mm] and stiffness [N/mm] (n, m, 2) at positions one after the other."""
    found = np.empty((len(angles), len(models), 2))
    ahead: list[SharedPosition | None] = [None] * len(models)
    for i, angle in enumerate(angles):
        lighter: SharedPosition | None = None
        for j, model in enumerate(models):
            near = ahead[j] or lighter
            extra = near.contact.stand.extra if near else (0.0, 0.0)
            patch: ContactPatch | None = near.patch if near else None
            position = shared_position(model, float(angle), extra, [0.0], patch, exact=True)
            stand = position.contact.stand.turned(model.load.on, float(position.smooth.motion[0]))
            found[i, j] = stand.transmission_error, position.stiffness * model.width_factor
            ahead[j] = lighter = position
            solved()
    return found

