"""Limits of small-strain theory: solutions beyond them are refused.

Rotations are linearised: a body that rotates by θ gets longer by θ²/2, half a per cent at BODY_ROTATION. Small strains
ε differ from those of large deformation by the fraction ε/2, a tenth at STRAIN. Inside a body, where cells rotate
without strain (a bending beam), CELL_ROTATION causes a false strain of 2 %.
"""

from __future__ import annotations

import numpy as np

from evolvent.contact.problem.condensed_body import CondensedBody
from evolvent.contact.step.step_solution import DeformedSurfaces, Solution
from evolvent.contact.step.step_system import StepSystem
from evolvent.fem.lagrange import gmsh_permutation, node_points, tabulate
from evolvent.fem.reference_facets import area_vector, reference_cell
from evolvent.fem.rigid_modes import rigid_modes
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import ResultError
from evolvent_meshes.mesh.mesh_data import MeshData

BODY_ROTATION = 0.1  # rad, of a body as a whole
STRAIN = 0.2  # largest absolute principal strain at a cell's centre
CELL_ROTATION = 0.2  # rad, of a cell against its body
SUSPECT = 0.1  # of STRAIN: tractions and stretches of the contact surfaces from which on all cells are checked


class SmallStrainExceeded(ResultError):
    """The solution has rotations or strains beyond the limits of small-strain theory."""


def refuse_large_strain(system: StepSystem, solution: Solution, deformed: DeformedSurfaces) -> None:
    """Raises SmallStrainExceeded for a body's rotation beyond BODY_ROTATION, a cell's strain beyond STRAIN or a cell's
    rotation beyond CELL_ROTATION."""
    suspect = _surface_strain(system, solution, deformed) > SUSPECT * STRAIN
    for index, (body, motion) in enumerate(zip(solution.condensed, solution.motions)):
        name = f"body {index} ({body.assembled.body.name!r})"
        turn = float(np.linalg.norm(rotation(body, motion)))
        if not turn <= BODY_ROTATION:
            raise SmallStrainExceeded(
                f"{name}: wanted it to turn by at most {BODY_ROTATION:g} rad, as rotations are linearised, found "
                f"{turn:.3g} rad; turn it by a Placement and let the step do the rest, or support it, or lower the load"
            )
        if suspect or body.assembled.load.any() or body.assembled.prescribed.any():
            _refuse_cells(name, body, solution.displacement(index) - body.assembled.motions.shapes @ motion)


def _refuse_cells(name: str, body: CondensedBody, displacement: Floats) -> None:
    """Raises SmallStrainExceeded; displacement: (N, d) without the rigid motion [mm]."""
    gradient = gradients(body.assembled.body.mesh, displacement)
    transposed = np.swapaxes(gradient, 1, 2)
    strain = float(np.abs(np.linalg.eigvalsh(0.5 * (gradient + transposed))).max())
    turn = float(np.linalg.norm(0.5 * (gradient - transposed), axis=(1, 2)).max() / np.sqrt(2.0))
    for what, value, limit in (("strain", strain, STRAIN), ("rotation [rad]", turn, CELL_ROTATION)):
        if not value <= limit:
            raise SmallStrainExceeded(
                f"{name}: wanted a {what} of at most {limit:g} in every cell, as strains are taken for small, found "
                f"{value:.3g}; lower the load, prescribe less, or look for a mistake in units (mm, N, MPa)"
            )


def rotation(body: CondensedBody, motion: Floats) -> Floats:
    """Rotation of a body by its rigid motions (r,), (3,) or (1,) in 2D [rad]."""
    points, displacement = (np.concatenate(parts) for parts in zip(*_rigid_displacements(body, motion)))
    modes = rigid_modes(points - points.mean(axis=0)).reshape(points.size, -1)
    amplitudes = np.linalg.lstsq(modes, displacement.ravel(), rcond=None)[0]
    return np.asarray(amplitudes[points.shape[1] :])


def _rigid_displacements(body: CondensedBody, motion: Floats) -> list[tuple[Floats, Floats]]:
    """Per contact surface, nodes and their rigid displacement, both (n, d) [mm]."""
    shapes = body.assembled.motions.shapes
    return [(surface.points, shapes[surface.nodes] @ motion) for surface in body.surfaces.values()]


def gradients(mesh: MeshData, displacement: Floats) -> Floats:
    """Displacement gradient ∂u/∂x at the cells' centres, (n_cells, d, d); displacement: (N, d) [mm]."""
    nodes = mesh.cells[:, gmsh_permutation(mesh.shape, mesh.order)]
    centre = node_points(mesh.shape, 1).mean(axis=0)
    dN = tabulate(mesh.shape, mesh.order, centre[None])[1][0]
    jacobian = np.einsum("cka,tk->cat", mesh.points[nodes][..., : mesh.dimension], dN)
    return np.einsum("cka,tk,ctb->cab", displacement[nodes], dN, np.linalg.inv(jacobian), optimize=True)


def _surface_strain(system: StepSystem, solution: Solution, deformed: DeformedSurfaces) -> float:
    """Estimate of the strain on the contact surfaces: largest traction over modulus, or relative change of a facet's
    size."""
    largest = 0.0
    for contact, result, positions in zip(system.problem.contacts, solution.contacts, deformed.positions):
        softer = min(system.problem.bodies[b].material.plane_modulus for b, _ in (contact.first, contact.second))
        traction = np.linalg.norm(result.traction, axis=1).max(initial=0.0)
        stretch = [_stretch(surface, x) for surface, x in zip(result.paired.placed, positions)]
        largest = max(largest, float(traction) / softer, *stretch)
    return largest


def _stretch(surface: Surface, positions: Floats) -> float:
    """Largest relative change of a facet's size when the nodes move to `positions`."""
    every = np.arange(len(surface.facets))
    centre = reference_cell(surface.shape, surface.order).centre
    centres = np.broadcast_to(centre, (len(every), 1, len(centre)))
    before, now = (
        np.linalg.norm(area_vector(surface.evaluate(x, every, centres)[1]), axis=-1)
        for x in (surface.points, positions)
    )
    return float(np.abs(now / before - 1.0).max())
