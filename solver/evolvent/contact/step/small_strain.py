"""What small strain can answer for: solutions that leave its range are refused.

Rotations are linearised: a body that turns by θ gets longer by θ²/2, half a per cent at TURN. Strains ε stand for those
of large deformation, which differ by ε/2 of themselves, a tenth at STRAIN. Inside a body, where cells rotate without
straining (a beam that bends), ROTATION costs 2 % of strain.
"""

from __future__ import annotations

import numpy as np

from evolvent.contact.problem.condensed_body import PreparedBody
from evolvent.contact.step.step_system import History, Position, Solution
from evolvent.fem.lagrange import gmsh_permutation, node_points, tabulate
from evolvent.fem.reference_facets import area_vector, reference_cell
from evolvent.fem.rigid_modes import rigid_modes
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import ResultError
from evolvent_meshes.mesh.mesh_data import MeshData

TURN = 0.1  # rad, of a body as a whole
STRAIN = 0.2  # largest principal strain at a cell's centre, also compressive
ROTATION = 0.2  # rad, of a cell against its body
SUSPECT = 0.1  # of STRAIN: from such tractions and stretches of the contact surfaces on, the cells are looked at


class TooLarge(ResultError):
    """The solution has rotations or strains beyond what small strain can answer for."""


def refuse_large(position: Position, solution: Solution, after: History) -> None:
    """Raises TooLarge for a rigid rotation beyond TURN, or a cell's strain or rotation beyond STRAIN and ROTATION."""
    suspect = _surface_strain(position, solution, after) > SUSPECT * STRAIN
    for index, (body, motion) in enumerate(zip(solution.prepared, solution.motions)):
        name = f"body {index} ({body.assembled.body.name!r})"
        turn = float(np.linalg.norm(rotation(body, motion)))
        if not turn <= TURN:
            raise TooLarge(
                f"{name}: wanted it to turn by at most {TURN:g} rad, as rotations are linearised, found "
                f"{turn:.3g} rad; turn it by a Placement and let the step do the rest, or support it, or lower the load"
            )
        if suspect or body.assembled.load.any() or body.assembled.prescribed.any():
            _refuse_cells(name, body, solution.displacement(index) - body.assembled.motions.shapes @ motion)


def _refuse_cells(name: str, body: PreparedBody, displacement: Floats) -> None:
    """displacement: (N, d) without the rigid motion."""
    slope = gradients(body.assembled.body.mesh, displacement)
    turned = np.swapaxes(slope, 1, 2)
    strain = float(np.abs(np.linalg.eigvalsh(0.5 * (slope + turned))).max())
    rotated = float(np.linalg.norm(0.5 * (slope - turned), axis=(1, 2)).max() / np.sqrt(2.0))
    for what, found, limit in (("strain", strain, STRAIN), ("rotation [rad]", rotated, ROTATION)):
        if not found <= limit:
            raise TooLarge(
                f"{name}: wanted a {what} of at most {limit:g} in every cell, as strains are taken for small, found "
                f"{found:.3g}; lower the load, prescribe less, or look for a mistake in units (mm, N, MPa)"
            )


def rotation(body: PreparedBody, motion: Floats) -> Floats:
    """(1,) or (3,) [rad] by which a body's rigid motions (r,) turn it."""
    points, turned = (np.concatenate(parts) for parts in zip(*_moved(body, motion)))
    modes = rigid_modes(points - points.mean(axis=0)).reshape(points.size, -1)
    found = np.linalg.lstsq(modes, turned.ravel(), rcond=None)[0]
    return np.asarray(found[points.shape[1] :])


def _moved(body: PreparedBody, motion: Floats) -> list[tuple[Floats, Floats]]:
    """Points of the contact surfaces and their rigid displacement, both (n, d)."""
    shapes = body.assembled.motions.shapes
    return [(surface.points, shapes[surface.nodes] @ motion) for surface in body.surfaces.values()]


def gradients(mesh: MeshData, displacement: Floats) -> Floats:
    """∂u/∂x (n_cells, d, d) at the cells' centres; displacement: (N, d)."""
    nodes = mesh.cells[:, gmsh_permutation(mesh.shape, mesh.order)]
    centre = node_points(mesh.shape, 1).mean(axis=0)
    dN = tabulate(mesh.shape, mesh.order, centre[None])[1][0]
    jacobian = np.einsum("cka,tk->cat", mesh.points[nodes][..., : mesh.dimension], dN)
    return np.einsum("cka,tk,ctb->cab", displacement[nodes], dN, np.linalg.inv(jacobian), optimize=True)


def _surface_strain(position: Position, solution: Solution, after: History) -> float:
    """Largest traction over modulus, and largest change of a facet's size, on the contact surfaces."""
    largest = 0.0
    for contact, result, places in zip(position.problem.contacts, solution.contacts, after.points):
        softer = min(position.problem.bodies[b].material.plane_modulus for b, _ in (contact.first, contact.second))
        traction = np.linalg.norm(result.traction, axis=1).max(initial=0.0)
        stretch = [_stretch(surface, x) for surface, x in zip(result.meeting.placed, places)]
        largest = max(largest, float(traction) / softer, *stretch)
    return largest


def _stretch(surface: Surface, points: Floats) -> float:
    """Largest relative change of a facet's size when its nodes move to `points`."""
    every = np.arange(len(surface.facets))
    centre = reference_cell(surface.shape, surface.order).centre
    centres = np.broadcast_to(centre, (len(every), 1, len(centre)))
    before, now = (
        np.linalg.norm(area_vector(surface.evaluate(x, every, centres)[1]), axis=-1) for x in (surface.points, points)
    )
    return float(np.abs(now / before - 1.0).max())
