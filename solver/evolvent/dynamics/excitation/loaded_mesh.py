"""The mesh under several torques: transmission error and tangent stiffness over the pitch, without friction.

Gears are condensed once; each torque is solved from where the last one, and the last position, have led.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from mpi4py import MPI

from evolvent.fem.parallel.ranks import together
from evolvent.gears.gear_load import GearLoad
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.contact_patch import ContactPatch
from evolvent.gears.sweep.parallel_sweep import division
from evolvent.gears.sweep.position_search import SharedPosition, shared_position
from evolvent.gears.sweep.worn_position import worn_on
from evolvent_meshes.arrays import Floats

Positions = tuple[Mapping[float, SharedPosition], ...]
"""A rank's positions, each by its torque [N·mm]."""


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
    models = under_torques(gears, torques)
    own = angles[division(len(angles), comm.size)[comm.rank]]

    def figures() -> Floats:
        found = np.empty((len(own), len(models), 2))
        for i, row in enumerate(_searched(models, own, solved)):
            found[i] = [_figures(*each) for each in zip(models, row)]
        return found

    return _gathered(models, torques, angles, comm, together(comm, figures))


def loaded_mesh_again(
    gears: Sequence[GearModel], torques: Sequence[float], angles: Floats, comm: MPI.Comm, kept: Positions | None
) -> tuple[LoadedMesh, Positions]:
    """The same, on flanks that wear: positions (of this rank) that were searched before are not searched again as long
    as the gears stand near there (`worn_on`). Returns those to go on from.

    kept: as returned for nearly the same flanks of the same condensed gears; None at first.

    Raises NotConverged, SearchError.
    """
    models = under_torques(gears, torques)
    own = angles[division(len(angles), comm.size)[comm.rank]]
    before = [[row.get(torque) for torque in torques] for row in kept] if kept is not None else None
    rows = together(comm, lambda: tuple(_searched(models, own, lambda: None, before)))
    parts = [[_figures(*each) for each in zip(models, row)] for row in rows]
    found = _gathered(models, torques, angles, comm, np.reshape(parts, (len(own), len(models), 2)))
    return found, tuple(dict(zip(torques, row)) for row in rows)


def under_torques(gears: Sequence[GearModel], torques: Sequence[float]) -> list[GearModel]:
    """Gears each under its torque [N·mm], whose course does not vary."""
    return [
        replace(model, load=GearLoad(torque / model.width_factor, model.load.on))
        for model, torque in zip(gears, torques, strict=True)
    ]


def _gathered(
    models: Sequence[GearModel], torques: Sequence[float], angles: Floats, comm: MPI.Comm, own: Floats
) -> LoadedMesh:
    """own: (k, m, 2) transmission error [mm] and stiffness [N/mm] of this rank's positions."""
    both = np.concatenate(comm.allgather(own))
    radius = models[0].pair.gears[models[0].load.on].base_radius
    return LoadedMesh(angles, np.asarray(torques) / radius, both[..., 0], both[..., 1])


def _figures(model: GearModel, position: SharedPosition) -> tuple[float, float]:
    """Transmission error [mm] and stiffness [N/mm]."""
    stand = position.contact.stand.turned(model.load.on, float(position.smooth.motion[0]))
    return stand.transmission_error, position.stiffness * model.width_factor


def _searched(
    models: Sequence[GearModel], angles: Floats, solved: Callable[[], None],
    kept: Sequence[Sequence[SharedPosition | None]] | None = None,
) -> Iterator[tuple[SharedPosition, ...]]:  # fmt: skip
    """Positions one after the other, each under all torques (m,). kept: those that may do with the present wear."""
    ahead: Sequence[SharedPosition | None] = [None] * len(models)
    for i, angle in enumerate(angles):
        row: list[SharedPosition] = []
        for j, model in enumerate(models):
            old = kept[i][j] if kept is not None else None
            position = worn_on(model, old) if old is not None else None
            if position is None:
                near = old or ahead[j] or (row[-1] if row else None)
                extra = near.contact.stand.extra if near else (0.0, 0.0)
                patch: ContactPatch | None = near.patch if near else None
                position = shared_position(model, float(angle), extra, [0.0], patch, exact=True)
            row.append(position)
            solved()
        ahead = row
        yield tuple(row)
