"""Reactions: what the supports and the rigid coupling of a body press on it with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.contact.step.step_system import Solution
from evolvent.fem.boundary import AXES
from evolvent.fem.rigid_modes import rigid_modes
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.input_checks import vector


@dataclass(frozen=True)
class Reaction:
    """Resultant on a body of one support, or of its rigid coupling, in the body's frame.

    group: the facet group that is held.
    directions: those of the support, "rigid" of the coupling.
    force: (d,) [N; N/mm in 2D].
    moment: (3,) about a point [N·mm]; (1,) about z in 2D [N].
    """

    group: str
    directions: str
    force: Floats
    moment: Floats


def reactions(solution: Solution, body: int, about: tuple[float, ...] = (0.0, 0.0, 0.0)) -> tuple[Reaction, ...]:
    """Of the supports of a body in their order, then of its rigid coupling; moments about a point of its frame [mm].

    A node that two supports hold in the same direction counts to the first one. The coupling's force includes the
    loads of its freedoms. So all reactions, the loads of the body and its contact forces add up to zero, to solver
    accuracy. Raises InputError.
    """
    prepared = solution.body(body)
    stated, d = prepared.assembled.body, prepared.assembled.d
    wanted = "a point of two or three finite coordinates [mm]"
    centre = np.array(vector("reactions, about", about, (2, 3) if d == 2 else (3,), wanted, "write (x, y, z)"))[:d]
    modes = rigid_modes(stated.mesh.points[:, :d] - centre)
    left = _out_of_balance(solution, body)
    result = []
    for support in stated.supports:
        nodes = np.unique(stated.mesh.facets[support.group])
        axes = [AXES.index(letter) for letter in support.directions if letter in AXES[:d]]
        result.append(_resultant(support.group, support.directions, modes, _taken(left, nodes, axes)))
    if stated.rigid:
        nodes = np.unique(stated.mesh.facets[stated.rigid.group])
        result.append(_resultant(stated.rigid.group, "rigid", modes, _taken(left, nodes, list(range(d)))))
    return tuple(result)


def _out_of_balance(solution: Solution, body: int) -> Floats:
    """(N, d) K'u − loads − contact forces [N]: what holds the held nodes, and nothing at all others."""
    prepared, forces = solution.prepared[body], solution.nodal_forces[body]
    a, u = prepared.assembled, prepared.deformation(forces, solution.step.load)
    left = a.stiffness @ u - solution.step.load * a.load - prepared.forces.T @ forces
    for traction in prepared.tractions.values() if prepared.theta else ():
        left -= prepared.theta * (traction.constant_term() @ u)
    return np.where(a.held, left, 0.0).reshape(-1, a.d)


def _taken(left: Floats, nodes: Ints, axes: list[int]) -> Floats:
    """The forces (N, d) at these nodes along these axes, which are then no longer left."""
    taken = np.zeros_like(left)
    for axis in axes:
        taken[nodes, axis] = left[nodes, axis]
        left[nodes, axis] = 0.0
    return taken


def _resultant(group: str, directions: str, modes: Floats, forces: Floats) -> Reaction:
    total = np.einsum("ndr,nd->r", modes, forces)
    d = forces.shape[1]
    return Reaction(group, directions, total[:d], total[d:])
