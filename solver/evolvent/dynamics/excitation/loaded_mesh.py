"""The mesh under several torques: transmission error and tangent stiffness over the pitch, without friction.

Gears are condensed once; each torque is solved from where the last one, and the last position, have led. Every position
is certified. Without friction the input of a whole pitch is its output under each torque, as no energy stays in the
teeth: so the pitch is certified as that of a sweep is, with the same limit (`certify_torques`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from mpi4py import MPI

from evolvent.dynamics.excitation.line_mesh import LineFigures, line_figures
from evolvent.fem.parallel.ranks import together
from evolvent.gears.gear_load import GearLoad
from evolvent.gears.gear_model import GearModel
from evolvent.gears.kinematics import PairRotation
from evolvent.gears.line.line_gears import MOST_ON_EDGES, LineGears
from evolvent.gears.line.line_result import EdgeContact
from evolvent.gears.solution.certificates import certify, energy_imbalance, require_balance
from evolvent.gears.sweep.deflected_flanks import deflected_equilibrium
from evolvent.gears.sweep.parallel_sweep import division
from evolvent.gears.sweep.position_result import position_result
from evolvent.gears.sweep.position_search import SharedPosition, shared_position
from evolvent.gears.sweep.worn_position import worn_on
from evolvent_meshes.arrays import Floats

Positions = tuple[Mapping[float, SharedPosition], ...]
"""Positions of a rank, each by its torque [N·mm]."""
Figures = Mapping[int, Floats]
"""Number of a position -> (m, 4) under each torque: `figures_of`; in line contact (m, 6 + l): `line_figures`."""
COLUMNS = 4
"""Number of figures of a position under a torque where the contact is resolved: transmission error, stiffness, pinion
torque, stored power."""
LINE_COLUMNS = COLUMNS + 3
"""Least number of them in line contact: the part of the load on edges, p_0 and the load of a layer besides."""


@dataclass(frozen=True, eq=False)
class LoadedMesh:
    """A mesh over a pitch under several torques."""

    angles: Floats
    """(n,) pinion rotations [rad]."""
    torques: Floats
    """(m,) torques, ascending [N·mm]."""
    base_radius: float
    """Base radius of the gear with the torques [mm]."""
    errors: Floats
    """(n, m) transmission error r_b1 φ_1 − r_b2 φ_2 [mm]."""
    stiffness: Floats
    """(n, m) tangent stiffness dF/ds [N/mm], of the whole face."""
    deflected: bool = False
    """Whether contact was searched again on deflected flanks."""
    line: LineFigures | None = None
    """Further figures of a line contact; None where the contact is resolved."""

    def lightest(self, count: int) -> LoadedMesh:
        """The mesh under its lightest torques alone."""
        line = None if self.line is None else self.line.lightest(count)
        return replace(
            self, torques=self.torques[:count], errors=self.errors[:, :count], stiffness=self.stiffness[:, :count],
            line=line,
        )

    def without(self, number: int) -> LoadedMesh:
        """The mesh under all torques but one, without further figures."""
        errors, stiffness = (np.delete(values, number, axis=1) for values in (self.errors, self.stiffness))
        return replace(self, torques=np.delete(self.torques, number), errors=errors, stiffness=stiffness, line=None)

    @property
    def forces(self) -> Floats:
        """(m,) mesh forces along the line of action, in the transverse section: torque over base radius [N]."""
        return self.torques / self.base_radius


def loaded_mesh(
    model: GearModel, torques: Sequence[float], angles: Floats, comm: MPI.Comm = MPI.COMM_WORLD
) -> LoadedMesh:
    """The mesh at some positions, see `solved_figures`, which need not be a pitch."""
    found = solved_figures(model, torques, angles, comm)
    return mesh_of(found, torques, model.base_radius, angles, model.deflected)


def solved_figures(
    model: GearModel, torques: Sequence[float], angles: Floats, comm: MPI.Comm,
    known: Figures = MappingProxyType({}), keep: Callable[[Figures], None] = lambda _: None,
) -> Figures:
    """Solves all positions under all torques; the ranks divide the positions, and each solves one at a time.

    model: of the gears under any torque.
    torques: (m,) ascending, on the gear that holds the load [N·mm].
    known: positions that were solved before.
    keep: called with all positions that are solved, on all ranks, each time that they have solved another one.

    Raises NotConverged, SearchError, BalanceError.
    """
    models, found = under_torques(model, torques), dict(known)
    missing = [i for i in range(len(angles)) if i not in known]
    shares = [missing[part] for part in division(len(missing), comm.size)]
    own = shares[comm.rank]
    if model.is_line:
        rows = line_figures(LineGears.of(model), torques, angles[own])
    else:
        rows = _resolved_figures(models, angles[own])

    for k in range(max(map(len, shares))):
        solved_now = together(comm, lambda: {own[k]: next(rows)} if k < len(own) else {})  # noqa: B023  called at once
        for each in comm.allgather(solved_now):
            found |= each
        keep(found)
    return found


def _resolved_figures(models: Sequence[GearModel], angles: Floats) -> Iterator[Floats]:
    """Figures (m, 4) of positions one after the other, under each torque, with the contact resolved."""
    for row in searched_positions(models, angles):
        yield np.array([figures_of(*each) for each in zip(models, row)])


def certify_torques(found: Figures, torques: Sequence[float]) -> None:
    """Raises PitchImbalance where the pitch is out of balance under one of the torques (m,) [N·mm]. found: of equal
    steps of a whole pitch."""
    _, _, given, stored = np.moveaxis(np.array(list(found.values()))[..., :COLUMNS], -1, 0)
    for torque, imbalance in zip(torques, energy_imbalance(stored, given)):
        require_balance(float(imbalance), f"under {1e-3 * torque:.4g} N·m")


def in_line_contact(mesh: LoadedMesh, least: float) -> tuple[LoadedMesh, str]:
    """The mesh under the torques below the first one that edges of tips bear in line contact, and a sentence on those
    left out, empty if there are none.

    least: torque [N·mm] that has to be among them. Raises EdgeContact where it is not.
    """
    if mesh.line is None:
        return mesh, ""
    bearing = mesh.line.on_edges > MOST_ON_EDGES
    first = int(np.append(bearing.any(axis=0), True).argmax())
    if first == len(mesh.torques):
        return mesh, ""
    torque, most = float(mesh.torques[first]), 100 * float(mesh.line.on_edges[:, first].max())
    why = (
        f"under {1e-3 * torque:.4g} N·m they bear up to {most:.2g} % of the load, at {int(bearing[:, first].sum())} of "
        f"{len(mesh.angles)} positions"
    )
    remedy = 'relieve the tips (tip_relief_um), or resolve the contact (mesh.level = "quick")'
    if torque <= least:
        raise EdgeContact(
            f"line contact: wanted tips whose edges bear at most {100 * MOST_ON_EDGES:g} % of the load, found that "
            f"{why}; {remedy}"
        )
    left_out = f"Torques from {1e-3 * torque:.4g} N·m on have no figures, for edges of tips are no line contact: {why}"
    return mesh.lightest(first), f"{left_out}; {remedy}."


def mesh_of(
    found: Figures, torques: Sequence[float], radius: float, angles: Floats, deflected: bool = False
) -> LoadedMesh:
    """Mesh from the figures of all positions. torques: (m,) [N·mm]; radius: base radius of their gear [mm]."""
    figures = np.array([found[i] for i in range(len(angles))])
    ascending = np.array(torques, dtype=float)
    line = LineFigures.of(figures[..., COLUMNS:]) if figures.shape[-1] >= LINE_COLUMNS else None
    return LoadedMesh(angles, ascending, radius, figures[..., 0], figures[..., 1], deflected, line)


def loaded_mesh_again(
    model: GearModel, torques: Sequence[float], angles: Floats, comm: MPI.Comm, kept: Positions | None
) -> tuple[LoadedMesh, Positions]:
    """Mesh under several torques on flanks that wear. Positions (of this rank) that were searched before are not
    searched again as long as the gears stand near there (`worn_on`). Returns the mesh, and the positions to start from
    the next time.

    kept: positions as returned for nearly the same flanks of the same condensed gears; None at first.

    Raises NotConverged, SearchError.
    """
    models = under_torques(model, torques)
    own = angles[division(len(angles), comm.size)[comm.rank]]
    before = [[row.get(torque) for torque in torques] for row in kept] if kept is not None else None
    rows = together(comm, lambda: tuple(searched_positions(models, own, before)))
    figures = [np.array([figures_of(*each) for each in zip(models, row)]) for row in rows]
    found = dict(enumerate(each for part in comm.allgather(figures) for each in part))
    mesh = mesh_of(found, torques, model.base_radius, angles)
    return mesh, tuple(dict(zip(torques, row)) for row in rows)


def under_torques(model: GearModel, torques: Sequence[float]) -> list[GearModel]:
    """The gears under each constant torque [N·mm]."""
    loads = [GearLoad(torque / model.width_factor, model.load.on) for torque in torques]
    return [replace(model, load=load) for load in loads]


def figures_of(model: GearModel, position: SharedPosition) -> tuple[float, float, float, float]:
    """Transmission error [mm] and stiffness [N/mm] of a position, its torque on the pinion and the power that its teeth
    store (`PositionResult.stored_power`). Raises NotConverged and SearchError on deflected flanks; BalanceError."""
    contact, smooth, stiffness = position.contact, position.smooth, position.stiffness
    if model.deflected:
        found = deflected_equilibrium(model, contact, smooth, 0.0, None, 0.0)
        contact, smooth, stiffness = found.contact, found.equilibrium, found.stiffness
    result = position_result(model, contact, smooth, 0.0, stiffness, 0)
    certify([result])
    return result.transmission_error, stiffness * model.width_factor, result.torques[0], result.stored_power


def equilibrium(model: GearModel, position: SharedPosition) -> PairRotation:
    """Angular position of both gears in equilibrium under their torque."""
    return position.contact.stand.turned(model.load.on, float(position.smooth.motion[0]))


def searched_positions(
    models: Sequence[GearModel], angles: Floats,
    kept: Sequence[Sequence[SharedPosition | None]] | None = None,
) -> Iterator[tuple[SharedPosition, ...]]:
    """Positions one after the other, each under all torques (m,). kept: those that may do with the present wear."""
    ahead: tuple[SharedPosition, ...] = ()
    for i, angle in enumerate(angles):
        row: tuple[SharedPosition, ...] = ()
        for j, model in enumerate(models):
            old = kept[i][j] if kept is not None else None
            position = worn_on(model, old) if old is not None else None
            if position is None:
                beyond_nominal = old.contact.stand.beyond_nominal if old is not None else _predicted(models, row, ahead)
                near = old or (ahead[j] if ahead else None) or (row[-1] if row else None)
                patch = near.patch if near is not None else None
                position = shared_position(model, float(angle), beyond_nominal, [0.0], patch, exact=True)
            row = *row, position
        ahead = row
        yield row


def _predicted(
    models: Sequence[GearModel], row: Sequence[SharedPosition], ahead: Sequence[SharedPosition]
) -> tuple[float, float]:
    """Rotations beyond the nominal ones [rad] under the torque that follows those of `row`: along the tangent stiffness
    of the last one, and as much beside it as at the last position. A flank is searched once where this is within the
    accuracy of a search. ahead: the last position under all torques; empty before the first one."""
    j = len(row)
    if j == 0:
        return equilibrium(models[0], ahead[0]).beyond_nominal if ahead else (0.0, 0.0)
    step = _step_along_tangent(models, row)
    if ahead and (before := _step_along_tangent(models, ahead[:j])) > 0.0:
        last, this = (equilibrium(model, each) for model, each in zip(models[j - 1 : j + 1], ahead[j - 1 : j + 1]))
        step *= (this.transmission_error - last.transmission_error) / before
    return equilibrium(models[j - 1], row[-1]).turned(models[j].load.on, step / models[j].base_radius).beyond_nominal


def _step_along_tangent(models: Sequence[GearModel], row: Sequence[SharedPosition]) -> float:
    """Growth of the transmission error [mm] up to the torque that follows those of `row`, at the last one's
    stiffness."""
    last, this = models[len(row) - 1 : len(row) + 1]
    return (this.load.torque - last.load.torque) / this.base_radius / row[-1].stiffness
