"""Reactions: forces and moments of a body's supports and of its rigid coupling on the body."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.contact.step.step_solution import Solution
from evolvent.fem.body import Body
from evolvent.fem.boundary import AXES
from evolvent.fem.rigid_modes import rigid_modes
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.input_checks import vector


@dataclass(frozen=True)
class Reaction:
    """Resultant of one support, or of the rigid coupling, on a body, in the body's frame.

    group: the facet group that is held.
    directions: of the support, such as "xy"; "rigid" for the coupling.
    force: (d,) [N; N/mm in 2D].
    moment: (3,) about a point [N·mm]; (1,) about the z axis in 2D [N].
    """

    group: str
    directions: str
    force: Floats
    moment: Floats


def reactions(solution: Solution, body: int | Body, about: tuple[float, ...] = (0.0, 0.0, 0.0)) -> tuple[Reaction, ...]:
    """The reactions of a body: one for each support in their order, then that of its rigid coupling.

    body: a body of the problem, or its index.
    about: the point, in the body's frame, about which moments are taken [mm].

    A node that two supports hold in the same direction counts for the first one. The coupling's force includes the
    loads of its freedoms. All reactions, the loads of the body and its contact forces add up to zero, to solver
    accuracy. Raises InputError.
    """
    condensed = solution.body(body)
    definition, d = condensed.assembled.body, condensed.assembled.d
    wanted = "a point of two or three finite coordinates [mm]"
    centre = np.array(vector("reactions, about", about, (2, 3) if d == 2 else (3,), wanted, "write (x, y, z)"))[:d]
    modes = rigid_modes(definition.mesh.points[:, :d] - centre)
    forces = _holding_forces(solution, solution.number(body))
    result = []
    for support in definition.supports:
        nodes = np.unique(definition.mesh.facets[support.group])
        axes = [AXES.index(letter) for letter in support.directions if letter in AXES[:d]]
        result.append(_resultant(support.group, support.directions, modes, _taken_out(forces, nodes, axes)))
    if definition.rigid:
        nodes = np.unique(definition.mesh.facets[definition.rigid.group])
        result.append(_resultant(definition.rigid.group, "rigid", modes, _taken_out(forces, nodes, list(range(d)))))
    return tuple(result)


def _holding_forces(solution: Solution, body: int) -> Floats:
    """Forces that hold the held nodes, K'u − loads − contact forces (N, d) [N]; zero at all other nodes."""
    condensed, forces = solution.condensed[body], solution.nodal_forces[body]
    a = condensed.assembled
    u = (solution.displacement(body) - a.motions.shapes @ solution.motions[body]).ravel()
    residual = a.stiffness @ u - solution.step.load * a.load - condensed.test_functionals.T @ forces
    for traction in condensed.tractions.values() if condensed.theta else ():
        residual -= condensed.theta * (traction.constant_term() @ u)
    return np.where(a.held, residual, 0.0).reshape(-1, a.d)


def _taken_out(forces: Floats, nodes: Ints, axes: list[int]) -> Floats:
    """The forces (N, d) at some nodes along some axes; sets them to zero in `forces`."""
    taken = np.zeros_like(forces)
    for axis in axes:
        taken[nodes, axis] = forces[nodes, axis]
        forces[nodes, axis] = 0.0
    return taken


def _resultant(group: str, directions: str, modes: Floats, forces: Floats) -> Reaction:
    """Reaction as resultant of nodal forces (N, d). modes (N, d, r): translations, then rotations about the point of
    the moment."""
    total = np.einsum("ndr,nd->r", modes, forces)
    d = forces.shape[1]
    return Reaction(group, directions, total[:d], total[d:])
