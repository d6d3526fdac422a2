"""`python -m evidence.benchmarks.line.face_ends [--small]`: the compliance near an end of the face that line contact
adds (`evolvent.gears.line.face_ends`) beside finite element bodies that end at an angle, for docs/line_contact.md.

A block carries a uniform load per length on a half-ellipse, up to an end whose face makes an angle of 90° − θ with the
loaded surface. The half-ellipse is once as wide as the contact, b, and once as wide as the meshes of a line contact
carry, w. The difference of both mean displacements is c ln(w/b) far from the end, c = 2/(π E*); near it there is more.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from evidence.benchmarks.measuring import keep_rows
from evidence.tables import Column, Table
from evolvent.fem.body import Body, assemble
from evolvent.fem.boundary import Fixed
from evolvent.fem.condensation.mumps import SparseCholesky
from evolvent.fem.material import Material
from evolvent.gears.line.face_ends import REACH, softness
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.shapes.blocks import graded_box

CARRIED, CONTACT, SIDE, CELLS = 1.0, 0.1, 5.0, 4
"""Half-widths w and b and side of the block [mm]; cells in b at the end."""
ACROSS, NEAR = 64, 1.0
"""Points across the half-ellipse; distance from the end up to which κ is fitted, over w."""
CASES = tuple((float(θ), 0.3) for θ in (-30, -20, -14, 0, 7, 14, 20, 30)) + tuple(
    (float(θ), ν) for ν in (0.2, 0.4) for θ in (-20, 0, 20)
)
"""Angles θ [°] and Poisson's ratios."""


@dataclass(frozen=True)
class EndRow:
    """An end of a face."""

    angle_deg: float
    """θ, positive at an acute edge."""
    poissons_ratio: float
    middle: float
    """Difference of the displacements far from the end over c; ln(w/b) is right."""
    softness: float
    """κ that fits the differences near the end best."""
    misfit: float
    """Largest deviation of the fitted law from a difference near the end, over the largest difference."""


TABLE = Table(EndRow, (
    Column("θ [°]", "angle_deg", ".0f"), Column("ν", "poissons_ratio", ".1f"),
    Column("far from the end", "middle", ".3f"), Column("κ, finite elements", "softness", ".3f"),
    Column("κ, formula", lambda row: f"{softness(math.radians(row.angle_deg), row.poissons_ratio):.3f}"),
    Column("misfit of the law", "misfit", ".2f"),
))


def end_row(angle_deg: float, poissons_ratio: float) -> EndRow:
    """Fits κ to the finite elements of an end."""
    distance, difference = differences(angle_deg, Material(1.0, poissons_ratio))
    middle = float(difference[-1])
    near = distance < NEAR * CARRIED
    d, extra = REACH * distance[near], difference[near] - middle
    law = np.log((d + np.hypot(d, CARRIED)) / (d + np.hypot(d, CONTACT)))
    κ = float(law @ extra / (law @ law))
    misfit = float(np.abs(extra - κ * law).max() / np.abs(extra).max())
    return EndRow(angle_deg, poissons_ratio, middle, κ, misfit)


def differences(angle_deg: float, material: Material) -> tuple[Floats, Floats]:
    """Distances (k,) of layers from the end [mm], and the difference (k,) of the mean displacements under both
    half-ellipses there, over c."""
    body = Body(_block(angle_deg), material, (Fixed("bottom"), Fixed("symmetry_x", "x"), Fixed("back", "y")))
    parts = assemble(body)
    upper = parts.stiffness[parts.free][:, parts.free]
    factor = SparseCholesky(upper)
    means = []
    for half_width in (CONTACT, CARRIED):
        nodes, layers = _loads(body.mesh, half_width)
        right = np.zeros((len(parts.held), layers.shape[1]))
        right[3 * nodes + 2] = layers
        down = right[parts.free]
        u = factor.solve(down.sum(axis=1, keepdims=True))
        means.append((down.T @ u).ravel() / layers.sum(axis=0))
    y = np.unique(np.round(body.mesh.points[nodes, 1], 9))[::2]
    c = 2.0 / (np.pi * material.plane_modulus)
    return 0.5 * (y[1:] + y[:-1]), (means[0] - means[1]) / c


def _block(angle_deg: float) -> MeshData:
    """Half of the block on one side of the line x = 0 that carries the load. It ends at y = 0 on its top, at 90° − θ
    below; planes across the line turn until they are upright at the other end, a plane of symmetry."""
    mesh = graded_box(SIDE, SIDE, CONTACT / CELLS, CONTACT, growth=1.35)
    points = mesh.points.copy()
    points[:, 1] -= math.tan(math.radians(angle_deg)) * points[:, 2] * (1.0 - points[:, 1] / SIDE)
    return replace(mesh, points=points)


def _loads(mesh: MeshData, half_width: float) -> tuple[Ints, Floats]:
    """Nodes (n,) of the top, and their forces (n, k) under half of a unit load per length on each of k layers."""
    nodes = np.unique(mesh.facets["top"])
    x, column = np.unique(np.round(mesh.points[nodes, 0], 9), return_inverse=True)
    y, row = np.unique(np.round(mesh.points[nodes, 1], 9), return_inverse=True)
    θ = np.arange(1, 2 * ACROSS, 2) * np.pi / (2 * ACROSS)
    inside = np.cos(θ) > 0.0
    place, share = half_width * np.cos(θ[inside]), 1.0 / ACROSS * 2.0 * np.sin(θ[inside]) ** 2
    across = _quadratic(x, place).T @ share
    layers = np.zeros((len(y), len(y) // 2))
    for k, step in enumerate(np.diff(y[::2])):
        layers[2 * k : 2 * k + 3, k] = step * np.array([1.0, 4.0, 1.0]) / 6.0
    return nodes, across[column.ravel(), None] * layers[row.ravel()]


def _quadratic(nodes: Floats, places: Floats) -> Floats:
    """Quadratic shape functions (places, nodes) of a line of cells with a node in the middle of each."""
    cell = np.clip(np.searchsorted(nodes[::2], places, side="right") - 1, 0, len(nodes) // 2 - 1)
    low, high = nodes[2 * cell], nodes[2 * cell + 2]
    s = (2.0 * places - low - high) / (high - low)
    shapes, rows = np.zeros((len(places), len(nodes))), np.arange(len(places))
    for offset, values in enumerate((0.5 * s * (s - 1.0), 1.0 - s**2, 0.5 * s * (s + 1.0))):
        shapes[rows, 2 * cell + offset] = values
    return shapes


def said(docs: Path) -> str:
    """The table of docs/line_contact.md."""
    return TABLE.markdown(TABLE.read(docs / "line_contact" / "face_ends.csv"))


def main() -> None:
    """Computes all ends."""
    small = "one end alone, to see that everything works"
    keep_rows(__doc__, small, "face_ends", lambda few: (end_row(*each) for each in (CASES[3:4] if few else CASES)))


if __name__ == "__main__":
    main()
